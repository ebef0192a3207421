# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Requests for drawn bodies, from their geometry in the world, for copies, and for waiting joints.

A request leaves density, friction and elasticity to the defaults of the world. The origin of a
body lies at its centre of mass. A joint that is drawn before its second body is fixed to the
background until then.

Law: a movable body that is drawn over the background end of a drawn joint becomes the second body
of that joint. Otherwise the two bodies of one machine would collide. An axle whose body another
axle joins at the same place holds both on the background, and stays.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
import math
from typing import Any

import numpy as np
from physsim_ros.drawing.scene_query import DRAWN, SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import Malformed, no_body
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import split_name, WORLD
from physsim_ros.model.requests import Command, Join, Request, Spawn
from physsim_ros.model.scene import Body, Joint
from physsim_ros.model.shapes import Box, Chain, contains, Disc, Polygon, Shape
from physsim_ros.model.transform import Point, Pose, world_to_local

# Kinds of joints whose end on the background is a point that a body can cover, as is that of those
# along a line.
_AT_POINT = {JointKind.AXLE, JointKind.PIN}


def disc(name: str, center: Point, radius: float, settings: DrawingSettings) -> Spawn:
    """
    Return the request for a disc.

    :raises BadSize: the radius [m] is out of range
    """
    return _dynamic_body(name, Disc(radius=radius), (*center, 0.0), settings)


def rectangle(
    name: str, center: Pose, width: float, height: float, settings: DrawingSettings
) -> Spawn:
    """
    Return the request for a rectangle.

    :param center: x, y [m] and the yaw of its width [rad]
    :raises BadSize: a side [m] is out of range
    """
    return _dynamic_body(name, Box(width=width, height=height), center, settings)


def polygon(name: str, corners: Sequence[Point], settings: DrawingSettings) -> Spawn:
    """
    Return the request for a polygon.

    :param corners: in either orientation, the first not repeated [m]
    :raises BadOutline: they are not the outline of a simple polygon
    :raises BadSize: it is too large or too thin
    """
    x, y = Polygon(outline=tuple(corners)).form.centroid
    outline = tuple((corner[0] - x, corner[1] - y) for corner in corners)
    return _dynamic_body(name, Polygon(outline=outline), (x, y, 0.0), settings)


def wall(name: str, points: Sequence[Point], settings: DrawingSettings) -> Spawn:
    """
    Return the request for a wall of anchored segments; the x axis of a single one is along it.

    :param points: at least two, in order [m]
    :raises BadOutline: all are the same point
    """
    thickness = settings.wall_thickness
    x, y = Chain(points=tuple(points), thickness=thickness).form.centroid
    yaw = 0.0
    line = tuple((point[0] - x, point[1] - y) for point in points)
    if len(points) == 2:
        (start, end), half = points, math.dist(*points) / 2
        yaw = math.atan2(end[1] - start[1], end[0] - start[0])
        line = (-half, 0.0), (half, 0.0)
    return Spawn(
        name=name,
        shape=Chain(points=line, thickness=thickness),
        pose=(x, y, yaw),
        color=settings.draw_color,
        properties=Properties(anchored=True),
    )


def copy(name: str, position: Point, scene: SceneQuery) -> tuple[Request, ...]:
    """
    Return the requests for a copy of a body, or of the robot of which it is a part, at rest.

    :param name: of the body
    :param position: of its copy [m]
    :raises UnknownBody: there is no such body
    """
    (name,) = _known((name,), scene, 'name')
    x, y, _ = scene.pose(name)
    requests, _ = _copies((name,), (position[0] - x, position[1] - y), scene)
    return tuple(requests)


def copy_machine(names: Sequence[str], by: Point, scene: SceneQuery) -> tuple[Request, ...]:
    """
    Return the requests for copies of bodies, at rest, and of the joints among them.

    Of a robot that has parts, one of which is named, the whole is copied. A joint to the
    background is copied with its body. Limits of a copied joint count from where its bodies are
    now.

    :param names: of the bodies
    :param by: vector from each body to its copy [m]
    :raises UnknownBody: there is no such body
    :raises Malformed: one is named twice
    """
    requests, copies = _copies(_known(names, scene, 'names'), by, scene)
    poses = {name: scene.pose(name) for name in copies}
    # A robot is spawned with its joints.
    own = {joint for name in copies for joint in scene.joints_of_robot(name)}
    copies[WORLD] = WORLD
    among = [
        joint
        for joint in scene.joints
        if joint.a in copies and joint.b in copies and joint.name not in own
    ]
    for copied, joint in zip(scene.new_joints(), among, strict=False):
        points, lengths = joint.drawn_points(poses), joint.drawn_values()
        join = Join(
            name=copied,
            kind=joint.kind,
            points=tuple((x + by[0], y + by[1]) for x, y in points),
            a=copies[joint.a],
            b=copies[joint.b],
            # Lengths that were measured when it was drawn are those of the copy, too.
            properties=replace(joint.properties, **dict[str, Any](lengths)),
        )
        requests.append(join)
    return tuple(requests)


def _copies(
    names: Sequence[str], by: Point, scene: SceneQuery
) -> tuple[list[Request], dict[str, str]]:
    """
    Return the requests for copies of bodies and whole robots, and the copy of each name.

    The parts of a robot are spawned with it, and then set to where those of the original are.
    """
    requests: list[Request] = []
    copies: dict[str, str] = {}
    wholes = dict.fromkeys(scene.whole(name) for name in names)
    for copied, name in zip(scene.new_bodies(), wholes, strict=False):
        members = name, *scene.parts(name)
        copies |= {each: copied + each.removeprefix(name) for each in members}
        moved = [(x + by[0], y + by[1], yaw) for x, y, yaw in map(scene.pose, members)]
        requests.append(copy_of(copied, scene.body(name), moved[0]))
        if len(members) > 1:
            placed = tuple(copies[each] for each in members)
            requests.append(Command(names=placed, poses=np.array(moved)))
    return requests, copies


def _known(names: Sequence[str], scene: SceneQuery, field: str) -> Sequence[str]:
    """
    Return names of bodies.

    :param field: of the message that has them
    :raises UnknownBody: there is no such body
    :raises Malformed: one is named twice
    """
    known = set(scene.names)
    for name in names:
        if name not in known:
            raise no_body(name, scene.names, field)
    if len(set(names)) < len(names):
        raise Malformed('a body is named twice', field=field)
    return names


def copy_of(name: str, body: Body, pose: Pose) -> Spawn:
    """
    Return the request for a copy of a body, at rest and without a lifetime.

    The namespace of a robot is that of its new name.

    :param name: of the new body
    :param pose: of the new body's origin [m, rad]
    """
    properties = Properties.from_mapping(body.entry())
    if properties.robot is not None:
        properties = replace(properties, robot=replace(properties.robot, namespace=None))
    return Spawn(name=name, shape=body.shape, pose=pose, color=body.color, properties=properties)


def _dynamic_body(name: str, shape: Shape, pose: Pose, settings: DrawingSettings) -> Spawn:
    velocity = settings.draw_velocity
    return Spawn(
        name=name,
        shape=shape,
        pose=pose,
        color=settings.draw_color,
        properties=Properties(velocity=None if velocity == (0.0, 0.0) else velocity),
    )


def requests_with_waiting_joints(
    requests: tuple[Request, ...], scene: SceneQuery, snap: float
) -> tuple[Request, ...]:
    """
    Return requests, followed by those that join each spawned body to its waiting joints.

    :param snap: the greatest distance of axles that are at one place [m]
    """
    spawned = [each for each in requests if isinstance(each, Spawn) and _moves(each)]
    return (*requests, *(join for body in spawned for join in _joins_of(body, scene, snap)))


def _joins_of(body: Spawn, scene: SceneQuery, snap: float) -> Iterator[Join]:
    waiting = [
        joint
        for joint in scene.joints
        if joint.b == WORLD
        and (joint.kind.schema.along_line or joint.kind in _AT_POINT)
        and split_name(joint.name)[0] == DRAWN
        and not _holds_two(joint, scene, snap)
    ]
    for joint in waiting:
        end = joint.seat.bx, joint.seat.by
        # The wheel of an axle may stand half below its chassis.
        slack = snap if joint.kind is JointKind.AXLE else 0.0
        if not contains(body.shape.form.pieces, *world_to_local(end, body.pose), slack):
            continue
        yield Join(
            name=joint.name,
            kind=joint.kind,
            points=_points(joint, end, scene),
            a=joint.a,
            b=body.name,
        )


def _holds_two(joint: Joint, scene: SceneQuery, snap: float) -> bool:
    """Return whether another axle at the place of an axle joins its body to a second one."""
    if joint.kind is not JointKind.AXLE:
        return False
    others = scene.axles_at(scene.pivot(joint), snap)
    return any(joint.a in (each.a, each.b) and WORLD not in (each.a, each.b) for each in others)


def _points(joint: Joint, end: Point, scene: SceneQuery) -> tuple[Point, ...]:
    if joint.kind.points == 1:
        return (end,)
    return scene.in_world(joint.a, (joint.seat.ax, joint.seat.ay)), end


def _moves(body: Spawn) -> bool:
    return not body.properties.anchored and not body.properties.kinematic
