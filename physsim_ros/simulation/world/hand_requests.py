# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Requests of hands: which body is grabbed, and where it is drawn or placed.

Law: a hand whose body is gone does nothing, and is not refused.
"""

from __future__ import annotations

from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import nothing_at, NothingThere
from physsim_ros.model.requests import (
    Grab,
    HandRequest,
    KeepHand,
    LetGo,
    MoveHand,
)
from physsim_ros.model.snapshot import Grip
from physsim_ros.model.transform import rotated, world_to_local
from physsim_ros.model.translation import Text
from physsim_ros.simulation.world.body_requests import set_poses
from physsim_ros.simulation.world.live_space import LiveSpace
from physsim_ros.simulation.world.lookup import points_in_world, pose_in_world


def grab(live: LiveSpace, request: Grab) -> Answer:
    """
    Add the grip of a hand on the topmost body at a point.

    :raises NothingThere: there is no body that can be grabbed
    :raises WorldFull: too many hands drag a body
    """
    space = live.space
    (point,) = points_in_world(space, (request.point,), request.frame)
    under = space.bodies.at(point)
    dynamic = [name for name in under if space.bodies.by_name[name].body.dynamic]
    names = dynamic or (under if request.paused else [])
    if not under:
        raise nothing_at(point, 'mouse_point')
    if not names:
        x, y = point
        template = 'the body there cannot be moved at ({x:g}, {y:g})'
        raise NothingThere(template, field='mouse_point', x=x, y=y, concerns=under[0])
    live.capacity.check_hand(request.hand)
    name = names[0]
    anchor = world_to_local(point, space.bodies.by_name[name].pose)
    space.set_grip(Grip(request.hand, name, anchor, point))
    return Answer(subject=name, message=Text('grabbed {body}', body=name))


def move_hand(live: LiveSpace, request: MoveHand) -> Answer:
    """
    Move a hand, which draws its body after it; in a paused world, the body is placed.

    :raises WorldFull: too much would overlap; nothing is changed
    """
    space = live.space
    x, y, yaw = pose_in_world(space, (*request.point, request.yaw or 0.0), request.frame)
    grip = space.grips.of(request.hand)
    if grip is None:
        return holds_nothing(request)
    if request.paused:
        rigid = space.bodies.by_name[grip.body]
        if request.yaw is None:
            yaw = rigid.pose[2]
        arm_x, arm_y = rotated(grip.anchor, yaw)
        pose = (x - arm_x, y - arm_y, yaw)
        if pose != rigid.pose:
            set_poses(live, {grip.body: pose})
    space.set_grip(grip._replace(target=(x, y)))
    message = Text('placed {body}' if request.paused else 'draws {body}', body=grip.body)
    return Answer(subject=grip.body, message=message)


def keep_hand(_: LiveSpace, request: KeepHand) -> Answer:
    """Change nothing: the request says that the hand is still there."""
    return Answer(message=Text('{hand} is there', hand=request.hand))


def let_go(live: LiveSpace, request: LetGo) -> Answer:
    """Remove the grip of a hand."""
    grip = live.space.grips.of(request.hand)
    if grip is None:
        return holds_nothing(request)
    live.space.remove_grip(request.hand)
    return Answer(subject=grip.body, message=Text('let go of {body}', body=grip.body))


def holds_nothing(request: HandRequest) -> Answer:
    """Return the answer to a hand that holds no body."""
    return Answer(message=Text('{hand} holds no body', hand=request.hand))
