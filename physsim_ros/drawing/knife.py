# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The knife: all that a straight stroke passes right through is cut, along it.

A body becomes the pieces of its shape (`cut_shape.py`). The largest is the body of before, changed
in place. Each piece has the frame of that body, in which joints and forces stay at their points. A
rope, rod or spring that the stroke crosses beside its bodies is removed. Robots, their parts and
actors are not cut.

Laws: mass and momentum stay, and so does the angular momentum about the common centre of mass.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
import math
from typing import Any

import numpy as np
from physsim_ros.drawing import copies
from physsim_ros.drawing.cut_shape import check_count, cut_shape
from physsim_ros.drawing.geometry import nearest_points, point_of
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.model.applied_forces import AppliedForce
from physsim_ros.model.arrays import Floats
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import BadOutline, BadSize, NothingThere
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import ChangeBody, Cut, Rejoin, Spawn, Unjoin
from physsim_ros.model.rope_path import spans
from physsim_ros.model.scene import Joint
from physsim_ros.model.shapes import contains, Shape
from physsim_ros.model.transform import cross, Point, rotated

# Difference of the areas of a body and of its pieces above which material was lost, in shares.
_SAME_AREA = 1e-9


def cut(start: Point, end: Point, scene: SceneQuery) -> Cut:
    """
    Return the request that cuts all that a stroke passes right through.

    :param start: of the stroke in the world [m]
    :param end: of it [m]
    :raises NothingThere: it passes right through nothing that can be cut
    :raises BadSize: a piece would be too thin
    :raises WorldFull: it cuts into more pieces, or severs more joints, than one cut may
    """
    near = scene.bodies_along(start, end)
    pieces: dict[str, list[Shape]] = {}
    count = 0
    for name in near:
        if _can_be_cut(name, scene) and (found := _pieces(name, start, end, scene)):
            pieces[name] = found
            count += len(found)
            check_count(count)
    severed = _severed(start, end, scene)
    if not pieces and not severed:
        for name in near:
            if _pieces(name, start, end, scene):
                template = '{body} is a robot, a part of one or an actor, which no knife cuts'
                raise NothingThere(template, field='point', body=name, concerns=name)
        raise NothingThere(
            'the stroke passes right through no body, rope, rod or spring', field='point'
        )
    new = scene.new_bodies()
    parts: list[ChangeBody | Spawn] = []
    names: dict[str, dict[str, Shape]] = {}
    for name, shapes in pieces.items():
        names[name] = {name: shapes[0]} | {next(new): shape for shape in shapes[1:]}
        parts += _requests_of(name, names[name], scene)
    moved = (
        _moved_joint(joint, names)
        for joint in scene.joints
        if not names.keys().isdisjoint((joint.a, joint.b)) and joint.name not in severed
    )
    return Cut(
        pieces=tuple(parts),
        joints=tuple(join for join in moved if join is not None),
        severed=tuple(Unjoin(name=name) for name in severed),
    )


def _can_be_cut(name: str, scene: SceneQuery) -> bool:
    """Return whether a body is neither an actor, nor a robot, nor a part of one."""
    whole = scene.body(scene.whole(name))
    return whole.robot is None and whole.actor is None


def _pieces(name: str, start: Point, end: Point, scene: SceneQuery) -> list[Shape]:
    """
    Return the shapes of the pieces of a body in its frame, the largest first; [] if it is whole.

    :raises BadSize: one would be too thin
    """
    shape = scene.body(name).shape
    try:
        pieces = cut_shape(shape, scene.local(name, start), scene.local(name, end))
    except (BadOutline, BadSize) as error:
        template = 'a piece of {body} would be too thin to be simulated'
        raise BadSize(template, field='point', body=name, concerns=name) from error
    return [] if pieces == [shape] else pieces


def _severed(start: Point, end: Point, scene: SceneQuery) -> list[str]:
    """
    Return the names of the ropes, rods and springs that a stroke crosses beside their bodies.

    :raises WorldFull: there are too many
    """
    lines = [
        (joint, line)
        for row, joint in enumerate(scene.joints)
        if joint.kind.schema.along_line
        for line in _lines(joint, scene.snapshot.ends[row], scene)
    ]
    a, b = np.moveaxis(np.reshape([line for _, line in lines], (-1, 2, 2)), 1, 0)
    along, stroke, away = b - a, np.subtract(end, start), start - a
    determinant = cross(along, stroke)
    with np.errstate(divide='ignore', invalid='ignore'):
        # The crossing of the two lines, in shares of the joint and of the stroke.
        of_joint, of_stroke = cross(away, stroke) / determinant, cross(away, along) / determinant
    crossed = (of_joint > 0.0) & (of_joint < 1.0) & (of_stroke > 0.0) & (of_stroke < 1.0)
    names: list[str] = []
    for number in np.flatnonzero(crossed).tolist():
        joint = lines[number][0]
        point = point_of(a[number] + of_joint[number] * along[number])
        is_part = joint.name in scene.joints_of_robot(scene.whole(joint.a))
        is_beside = {*joint.bodies}.isdisjoint(scene.bodies_at(point))
        if not is_part and is_beside and joint.name not in names:
            names.append(joint.name)
            check_count(len(names))
    return names


def _lines(joint: Joint, ends: Floats, scene: SceneQuery) -> Iterator[Floats]:
    """
    Yield the straight lines along which a joint reaches, (2, 2) float64 [m].

    A rope past rings and wheels has those between them; what lies on a wheel is not cut.

    :param ends: (2, 2) float64: its anchor points in the world [m]
    """
    if not joint.guides:
        yield ends
        return
    poses = {name: scene.pose(name) for name in joint.bodies if name != WORLD}
    radii = (0.0, *(guide.radius for guide in joint.guides), 0.0)
    for span in spans(joint.drawn_points(poses), radii):
        yield np.array((span.start, span.end))


def _requests_of(
    name: str, shapes: dict[str, Shape], scene: SceneQuery
) -> Iterator[ChangeBody | Spawn]:
    """Yield the requests for the pieces of a body, by name: itself, and new ones."""
    body, pose = scene.body(name), scene.pose(name)
    area = sum(shape.form.area for shape in shapes.values())
    for each, shape in shapes.items():
        said: dict[str, Any] = {}
        if body.mass is not None:
            said['mass'] = body.mass * shape.form.area / area
        elif not math.isclose(area, body.shape.form.area, rel_tol=_SAME_AREA):
            said['density'] = body.density * body.shape.form.area / area
        if not body.anchored:
            said['velocity'], said['spin'] = _motion(name, shape, list(shapes.values()), scene)
        said['forces'] = tuple(
            force for force in body.forces if _holder(force, shapes, name) == each
        )
        if each == name:
            # Without the body of before there is nothing to cut.
            yield ChangeBody(name=name, shape=shape, properties=Properties(**said))
            continue
        piece = copies.copy_of(each, body, pose)
        properties = replace(piece.properties, label='', **said)
        yield replace(piece, shape=shape, properties=properties)


def _motion(
    name: str, shape: Shape, shapes: list[Shape], scene: SceneQuery
) -> tuple[Point, float]:
    """
    Return the velocity of the centre of mass of a piece [m/s], and its angular velocity [rad/s].

    All pieces together turn as one body about their common centre of mass. Its inertia differs
    from that of the body where material was lost: angular momentum is kept, not its rate.
    """
    vx, vy, spin = scene.twist(name)
    form = scene.body(name).shape.form
    area = sum(each.form.area for each in shapes)
    x, y = (
        sum(each.form.area * each.form.centroid[axis] for each in shapes) / area for axis in (0, 1)
    )
    gyration = sum(
        each.form.area * (each.form.gyration + math.dist(each.form.centroid, (x, y)) ** 2)
        for each in shapes
    )
    spin *= form.gyration * area / gyration
    away = shape.form.centroid[0] - x, shape.form.centroid[1] - y
    arm_x, arm_y = rotated(away, scene.pose(name)[2])
    return (vx - spin * arm_y, vy + spin * arm_x), spin


def _holder(force: AppliedForce, shapes: dict[str, Shape], name: str) -> str:
    """Return the piece on which a force acts; one at the centre of mass stays on the largest."""
    return name if force.at is None else _piece_at(force.at, shapes)


def _piece_at(point: Point, shapes: dict[str, Shape]) -> str:
    """Return the name of the piece with a point of the body's frame, else of the nearest one."""

    def distance(name: str) -> float:
        pieces = shapes[name].form.pieces
        if contains(pieces, *point):
            return 0.0
        near = (each for piece in pieces for each in nearest_points(piece, point))
        return min(math.dist(point, each) for each in near)

    forms = {name: shape.form for name, shape in shapes.items()}
    least = {name: math.dist(point, form.centroid) - form.outer for name, form in forms.items()}
    nearest, least_distance = '', math.inf
    # By the distance of their circles, up to those that are farther than a piece.
    for name in sorted(shapes, key=least.__getitem__):
        if least[name] > least_distance:
            break
        if (found := distance(name)) < least_distance:
            nearest, least_distance = name, found
    return nearest


def _moved_joint(joint: Joint, names: Mapping[str, dict[str, Shape]]) -> Rejoin | None:
    """Return the request that puts a joint on the pieces with its points, if it is not there."""
    seat = joint.seat
    ends = ((joint.a, (seat.ax, seat.ay)), (joint.b, (seat.bx, seat.by)))
    a, b = (_piece_at(point, names[name]) if name in names else name for name, point in ends)
    return None if (a, b) == (joint.a, joint.b) else Rejoin(name=joint.name, a=a, b=b)
