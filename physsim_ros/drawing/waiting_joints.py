# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Waiting joints: a joint that is drawn before its second body is fixed to the background until then.

Law: a movable body that is drawn over the background end of a drawn joint becomes the second body
of that joint. Otherwise the two bodies of one machine would collide.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from physsim_ros.drawing.scene_query import DRAWN, SceneQuery
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import split_name, WORLD
from physsim_ros.model.requests import Join, Request, Spawn
from physsim_ros.model.scene import Joint
from physsim_ros.model.shapes import contains_each
from physsim_ros.model.transform import Point, rotated_each

# Kinds of joints whose end on the background is a point that a body can cover.
_KINDS = {JointKind.AXLE, JointKind.PIN, JointKind.ROD, JointKind.ROPE, JointKind.SPRING}


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
