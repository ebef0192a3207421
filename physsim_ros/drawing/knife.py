# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The knife: bodies are cut along a straight stroke that passes right through them.

Discs, rectangles and polygons are cut, each as an outline: a chord between two points where the
stroke crosses an outline splits it in two. This works for outlines that are not convex, whose
pieces clipping by a half plane (Sutherland and Hodgman 1974) would leave connected by edges of no
width. A disc is cut as a regular polygon of its area. Robots, actors, chains, triangles and
compounds are not cut.

Laws: mass, momentum and angular momentum stay, those of discs to 1e-4. The largest piece is the
body of before, changed in place; joints and forces stay at their points.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
import math
from typing import Any

import numpy as np
from physsim_ros.drawing import body_requests
from physsim_ros.drawing.scene_query import DRAWN, SceneQuery
from physsim_ros.model.applied_forces import AppliedForce
from physsim_ros.model.arrays import Floats
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import BadOutline, BadSize, NothingThere
from physsim_ros.model.names import split_name, WORLD
from physsim_ros.model.requests import ChangeBody, Cut, Join, Spawn
from physsim_ros.model.scene import Body, Joint
from physsim_ros.model.shapes import Box, contains, Disc, Polygon
from physsim_ros.model.transform import cross, dots, Point, rotated
from physsim_ros.simulation.world.joint_requests import drawn_points

# Corners of the polygon that a disc is cut as: its rim is off by 0.3 % of the radius.
_CORNERS = 32
# Distance of a corner from the line below which it lies on the line [m]; `distinct_points` takes
# points as near as that for one.
_ON_LINE = 1e-6
# Share of the area of a body below which a piece is the rounding of a touch.
_ROUNDING = 1e-9


def cut(start: Point, end: Point, scene: SceneQuery) -> Cut:
    """
    Return the request that cuts all bodies which a stroke passes right through.

    :param start: of the stroke in the world [m]
    :param end: of it [m]
    :raises NothingThere: it passes right through no body that can be cut
    :raises BadSize: a piece would be too thin
    """
    pieces = {
        name: each for name in scene.names if len(each := _pieces(name, start, end, scene)) > 1
    }
    if not pieces:
        raise NothingThere(
            'the stroke passes right through no disc, rectangle or polygon', field='point'
        )
    _, number = split_name(scene.next_body())
    parts: list[ChangeBody | Spawn] = []
    names: dict[str, dict[str, Polygon]] = {}
    for name, shapes in pieces.items():
        new = [f'{DRAWN}/{number + each}' for each in range(len(shapes) - 1)]
        number += len(new)
        names[name] = dict(zip((name, *new), shapes, strict=True))
        parts += _requests_of(name, names[name], scene)
    moved = (_moved_joint(joint, names, scene) for joint in scene.joints)
    return Cut(pieces=tuple(parts), joints=tuple(join for join in moved if join is not None))


def split(outline: Floats, start: Floats, end: Floats) -> list[Floats]:
    """
    Return the pieces of a simple outline that is cut from one point to another.

    :param outline: (n, 2) float64: the vertices in order, either way round
    :param start: (2,) float64: of the cut, outside
    :param end: (2,) float64: of it, outside
    :return: (m, 2) float64 each; none where the cut does not pass through
    """
    length = math.dist(start, end)
    along = (end - start) / length
    across = cross(np.broadcast_to(along, outline.shape), outline - start)
    across[np.abs(across) < _ON_LINE] = 0.0
    points: list[Floats] = []
    # Crossings of the line and the edges: distances from the start, and numbers in `points`.
    crossings: list[tuple[float, int]] = []
    for corner, (here, after) in enumerate(zip(across, np.roll(across, -1), strict=True)):
        points.append(outline[corner])
        if (here >= 0.0) != (after >= 0.0):
            following = outline[(corner + 1) % len(outline)]
            point = outline[corner] + (following - outline[corner]) * (here / (here - after))
            crossings.append((float(dots(point - start, along)), len(points)))
            points.append(point)
    crossings.sort()
    partners: dict[int, int] = {}
    # From the first crossing to the second the line is within, and so on.
    for (first, a), (second, b) in zip(crossings[::2], crossings[1::2], strict=True):
        if first >= 0.0 and second <= length:
            partners |= {a: b, b: a}
    return [np.array([points[each] for each in walk]) for walk in _walks(len(points), partners)]


def _walks(count: int, partners: dict[int, int]) -> Iterator[list[int]]:
    """
    Yield the numbers of the points of each piece: along the outline, and over each chord met.

    :param count: of the points of the outline
    :param partners: the two ends of each chord
    """
    left = set(partners)
    while left:
        first = at = min(left)
        walk = []
        while True:
            left.discard(at)
            walk.append(at)
            at = (at + 1) % count
            while at not in partners:
                walk.append(at)
                at = (at + 1) % count
            walk.append(at)
            at = partners[at]
            if at == first:
                break
        yield walk


def _pieces(name: str, start: Point, end: Point, scene: SceneQuery) -> list[Polygon]:
    """
    Return the shapes of the pieces of a body in its frame, the largest first.

    :raises BadSize: one would be too thin
    """
    body = scene.body(name)
    outline = _outline(body)
    if outline is None:
        return []
    ends = (np.array(scene.local(name, point)) for point in (start, end))
    parts = split(outline, *ends)
    least = _ROUNDING * body.shape.form.area
    try:
        shapes = [
            Polygon(outline=tuple(map(tuple, part))) for part in parts if _area(part) > least
        ]
    except (BadOutline, BadSize) as error:
        raise BadSize(
            f'a piece of {name} would be too thin to be simulated', field='point', body=name
        ) from error
    return sorted(shapes, key=lambda shape: -shape.form.area)


def _area(part: Floats) -> float:
    return abs(float(cross(part, np.roll(part, -1, axis=0)).sum())) / 2


def _outline(body: Body) -> Floats | None:
    """Return the outline that a body is cut as, (n, 2) float64; None where it is not cut."""
    if body.robot is not None or body.actor is not None:
        return None
    match body.shape:
        case Disc(radius=radius):
            angles = np.arange(_CORNERS) * math.tau / _CORNERS
            share = math.tau / _CORNERS
            circumradius = radius * math.sqrt(share / math.sin(share))
            return circumradius * np.column_stack((np.cos(angles), np.sin(angles)))
        case Box():
            return np.array(body.shape.corners())
        case Polygon(outline=outline):
            return np.array(outline)
    return None


def _requests_of(
    name: str, shapes: dict[str, Polygon], scene: SceneQuery
) -> Iterator[ChangeBody | Spawn]:
    """Yield the requests for the pieces of a body, by name: itself, and new ones."""
    body, pose = scene.body(name), scene.pose(name)
    vx, vy, spin = scene.twist(name)
    center = body.shape.form.centroid
    for each, shape in shapes.items():
        x, y = shape.form.centroid
        arm_x, arm_y = rotated((x - center[0], y - center[1]), pose[2])
        said: dict[str, Any] = {}
        if body.mass is not None:
            said['mass'] = body.mass * shape.form.area / body.shape.form.area
        if not body.anchored:
            said |= {'velocity': (vx - spin * arm_y, vy + spin * arm_x), 'spin': spin}
        said['forces'] = tuple(
            force for force in body.forces if _holder(force, shapes, name) == each
        )
        if each == name:
            # Without the body of before there is nothing to cut.
            yield ChangeBody(name=name, shape=shape, properties=Properties(**said))
            continue
        piece = body_requests.copy_of(each, body, pose)
        properties = replace(piece.properties, label='', **said)
        yield replace(piece, shape=shape, properties=properties)


def _holder(force: AppliedForce, shapes: dict[str, Polygon], name: str) -> str:
    """Return the piece on which a force acts; one at the centre of mass stays on the largest."""
    return name if force.at is None else _piece_at(force.at, shapes)


def _piece_at(point: Point, shapes: dict[str, Polygon]) -> str:
    """Return the name of the piece with a point of the body's frame, else of the nearest one."""

    def distance(name: str) -> float:
        form = shapes[name].form
        if contains(form.pieces, *point):
            return 0.0
        return min(math.dist(point, corner) for corner in shapes[name].outline)

    return min(shapes, key=distance)


def _moved_joint(
    joint: Joint, names: dict[str, dict[str, Polygon]], scene: SceneQuery
) -> Join | None:
    """Return the request that puts a joint on the pieces with its points; None if it is there."""
    seat = joint.seat
    ends = ((joint.a, (seat.ax, seat.ay)), (joint.b, (seat.bx, seat.by)))
    a, b = (_piece_at(point, names[name]) if name in names else name for name, point in ends)
    if (a, b) == (joint.a, joint.b):
        return None
    poses = {name: scene.pose(name) for name in (joint.a, joint.b) if name != WORLD}
    return Join(
        name=joint.name,
        kind=joint.kind,
        points=drawn_points(joint, poses),
        a=a,
        b=b,
        # Lengths that were measured when it was drawn stay.
        properties=replace(joint.properties, **dict[str, Any](joint.drawn_values())),
    )
