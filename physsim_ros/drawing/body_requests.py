# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Requests for drawn bodies, from their geometry in the world, and for the joints that wait for them.

A request leaves density, friction and elasticity to the defaults of the world. The origin of a
body lies at its centre of mass. A joint that is drawn before its second body is fixed to the
background until then.

Law: a movable body that is drawn over the background end of a drawn joint becomes the second body
of that joint. Otherwise the two bodies of one machine would collide.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
import math

import numpy as np
from physsim_ros.drawing.scene_query import DRAWN, SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import split_name, WORLD
from physsim_ros.model.requests import Join, Request, Spawn
from physsim_ros.model.scene import Body, Joint
from physsim_ros.model.shapes import Box, Chain, contains_each, Disc, Polygon, Shape
from physsim_ros.model.transform import Point, Pose, rotated_each

# Kinds of joints whose end on the background is a point that a body can cover.
_KINDS = {JointKind.AXLE, JointKind.PIN, JointKind.ROD, JointKind.ROPE, JointKind.SPRING}


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


def copy(name: str, body: Body, pose: Pose) -> Spawn:
    """
    Return the request for a copy of a body, at rest and without a lifetime.

    :param name: of the new body
    :param body: that is copied
    :param pose: of the new body's origin [m, rad]
    """
    return Spawn(
        name=name,
        shape=body.shape,
        pose=pose,
        color=body.color,
        properties=Properties(
            mass=body.mass,
            density=body.density if body.mass is None else None,
            friction=body.friction,
            elasticity=body.elasticity,
            anchored=body.anchored,
            kinematic=body.kinematic,
            group=body.group,
            sensor=body.sensor,
            surface_velocity=body.surface_velocity,
            forces=body.forces,
            label=body.label,
        ),
    )


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
    requests: tuple[Request, ...], scene: SceneQuery
) -> tuple[Request, ...]:
    """Return requests, followed by those that join each spawned body to its waiting joints."""
    spawned = [each for each in requests if isinstance(each, Spawn) and _moves(each)]
    return (*requests, *(join for body in spawned for join in _joins_of(body, scene)))


def _joins_of(body: Spawn, scene: SceneQuery) -> Iterator[Join]:
    waiting = [
        joint
        for joint in scene.joints
        if joint.b == WORLD and joint.kind in _KINDS and split_name(joint.name)[0] == DRAWN
    ]
    if not waiting:
        return
    x, y, yaw = body.pose
    ends = np.array([(joint.seat.bx, joint.seat.by) for joint in waiting])
    local = rotated_each(ends - (x, y), -yaw)
    covered = contains_each(body.shape.form, local[:, 0], local[:, 1])
    for number in np.flatnonzero(covered):
        joint = waiting[number]
        yield Join(
            name=joint.name,
            kind=joint.kind,
            points=_points(joint, (joint.seat.bx, joint.seat.by), scene),
            a=joint.a,
            b=body.name,
        )


def _points(joint: Joint, end: Point, scene: SceneQuery) -> tuple[Point, ...]:
    if joint.kind.points == 1:
        return (end,)
    return scene.in_world(joint.a, (joint.seat.ax, joint.seat.ay)), end


def _moves(body: Spawn) -> bool:
    return not body.properties.anchored and not body.properties.kinematic
