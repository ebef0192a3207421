# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Waiting joints: a joint that is drawn before its second body is fixed to the background until then.

Law: a movable body that is drawn over the background end of a drawn joint becomes the second body
of that joint. Otherwise the two bodies of one machine would collide. An axle whose body another
axle joins at the same place holds both on the background, and stays.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from physsim_ros.drawing.scene_query import DRAWN, SceneQuery
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import split_name, WORLD
from physsim_ros.model.requests import Join, Request, Spawn
from physsim_ros.model.scene import Joint
from physsim_ros.model.shapes import contains
from physsim_ros.model.transform import Point, world_to_local

# Kinds of joints whose end on the background is a point that a body can cover, as is that of those
# along a line.
_AT_POINT = {JointKind.AXLE, JointKind.PIN}


def requests_with_waiting_joints(
    requests: tuple[Request, ...], scene: SceneQuery, snap: float
) -> tuple[Request, ...]:
    """
    Return requests, followed by those that join each spawned body to its waiting joints.

    :param snap: the greatest distance of axles that are at one place [m]
    """
    waiting = [
        joint
        for joint in scene.joints
        if joint.b == WORLD
        and (joint.kind.schema.along_line or joint.kind in _AT_POINT)
        and split_name(joint.name)[0] == DRAWN
    ]
    spawned = [each for each in requests if isinstance(each, Spawn) and _moves(each)]
    joins = (join for body in spawned for join in _joins_of(body, waiting, scene, snap))
    return (*requests, *joins)


def _joins_of(
    body: Spawn, waiting: Sequence[Joint], scene: SceneQuery, snap: float
) -> Iterator[Join]:
    """Yield the requests that join a body to those of some joints that it covers the end of."""
    for joint in waiting:
        end = joint.seat.bx, joint.seat.by
        # The wheel of an axle may stand half below its chassis.
        slack = snap if joint.kind is JointKind.AXLE else 0.0
        covers = contains(body.shape.form.pieces, *world_to_local(end, body.pose), slack)
        if not covers or _holds_two(joint, scene, snap):
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
