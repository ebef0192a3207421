# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Requests of hands: which body is grabbed, and where it is drawn or placed.

Law: a hand whose body is gone does nothing, and is not refused.
"""

from __future__ import annotations

from dataclasses import replace

from physsim_ros.engine.space import Space
from physsim_ros.model.errors import NothingThere
from physsim_ros.model.grips import Grip
from physsim_ros.model.requests import (
    Grab,
    GrabToPlace,
    HandRequest,
    KeepHand,
    LetGo,
    MoveHand,
    PlaceHand,
)
from physsim_ros.model.transform import Point, Pose, rotated
from physsim_ros.simulation.world.capacity import Capacity
from physsim_ros.simulation.world.lookup import points_in_world, pose_in_world


def apply_hand_request(space: Space, request: HandRequest, capacity: Capacity) -> tuple[str, str]:
    """
    Carry out a request of a hand.

    :return: the body concerned, or '', and a sentence that says what was done
    :raises Refusal: and nothing is changed
    """
    match request:
        case Grab(point=point, frame=frame):
            (point,) = points_in_world(space, (point,), frame)
            return grab_body(space, request, point, capacity)
        case MoveHand(point=point, yaw=yaw, frame=frame):
            x, y, turned = pose_in_world(space, (*point, yaw or 0.0), frame)
            moved = replace(request, point=(x, y), yaw=None if yaw is None else turned)
            return move_hand(space, moved, capacity)
        case KeepHand(hand=hand):
            return '', f'{hand} is there'
        case LetGo(hand=hand):
            return let_go(space, hand)


def grab_body(space: Space, request: Grab, point: Point, capacity: Capacity) -> tuple[str, str]:
    """
    Add the grip of a hand on the topmost body under a point.

    :param point: in the world [m]
    :return: name of the body, and a sentence that says what was done
    :raises NothingThere: there is no body that can be grabbed
    :raises WorldFull: too many hands drag a body
    """
    under = space.bodies.at(point)
    movable = [name for name in under if not space.bodies.by_name[name].body.fixed]
    names = movable or (under if isinstance(request, GrabToPlace) else [])
    if not names:
        x, y = point
        why = 'the body there cannot be moved' if under else 'there is no body'
        message = f'{why} at ({x:g}, {y:g})'
        raise NothingThere(message, field='mouse_point', body=under[0] if under else '')
    capacity.check_hand(space, request.hand)
    name = names[0]
    x, y, yaw = space.bodies.by_name[name].pose
    anchor = rotated((point[0] - x, point[1] - y), -yaw)
    space.set_grip(Grip(request.hand, name, anchor, point))
    return name, f'grabbed {name}'


def move_hand(space: Space, request: MoveHand, capacity: Capacity) -> tuple[str, str]:
    """
    Move a hand, and put its body there if the request is that of a paused world.

    :param request: with point and yaw in the world
    :return: name of the body, and a sentence that says what was done
    :raises WorldFull: too much would overlap; nothing is changed
    """
    grip = space.pipeline.mouse_joints.grip_of(request.hand)
    if grip is None:
        return '', f'{request.hand} holds no body'
    moved = grip._replace(target=request.point)
    if not isinstance(request, PlaceHand):
        space.set_grip(moved)
        return grip.body, f'draws {grip.body}'
    rigid = space.bodies.by_name[grip.body]
    pose = _placed_pose(rigid.pose, grip, request)
    if pose != rigid.pose:
        capacity.check_poses(space, [rigid], [pose])
        space.set_pose(rigid, pose)
    space.set_grip(moved)
    return grip.body, f'placed {grip.body}'


def _placed_pose(pose: Pose, grip: Grip, request: PlaceHand) -> Pose:
    """Return the pose of a body, now at `pose`, whose grip is where a hand places it."""
    point, yaw = request.point, pose[2] if request.yaw is None else request.yaw
    arm_x, arm_y = rotated(grip.anchor, yaw)
    return point[0] - arm_x, point[1] - arm_y, yaw


def let_go(space: Space, hand: str) -> tuple[str, str]:
    """
    Remove the grip of a hand.

    :return: name of the body, and a sentence that says what was done
    """
    grip = space.pipeline.mouse_joints.grip_of(hand)
    if grip is None:
        return '', f'{hand} holds no body'
    space.remove_grip(hand)
    return grip.body, f'let go of {grip.body}'
