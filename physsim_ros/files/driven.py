# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The states of robots and actors in world files, under the keys `driven` and `acting` of a body.

Only the node writes them.
"""

from __future__ import annotations

from physsim_ros.model.actors import ActorState, WAITING
from physsim_ros.model.checks import (
    check_finite,
    known_mapping,
    LONGEST,
    number,
    pair,
    shown,
    Whole,
    Within,
)
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.robot_states import Covariance, NEVER, RobotState, SPAWNED
from physsim_ros.model.robots import Robot
from physsim_ros.model.scene import Body
from physsim_ros.model.transform import Pose

_POSES = ('aim', 'wheels', 'travel', 'odometry')
# Greatest number in them, as of a motion [m, rad, m/s, rad/s].
_GREATEST = 1e12
_MOST_REACHED = 2**53
_LENGTH = Within(0.0, _GREATEST)
# Squares and products of them.
_VARIANCE = Within(-(_GREATEST**2), _GREATEST**2)


def driven_entry(driven: RobotState, physics_rate: float) -> dict[str, object]:
    """Return the entry of the state of a robot."""
    entry: dict[str, object] = {key: list(getattr(driven, key)) for key in _POSES}
    seconds = None if driven.until == NEVER else driven.until / physics_rate
    return {**entry, 'covariance': list(driven.covariance), 'seconds': seconds}


def driven_from(entry: object, body: Body, physics_rate: float) -> RobotState:
    """
    Return the state of a robot from its entry.

    :param body: of the robot
    :param physics_rate: of the world [Hz]
    :raises Refusal: the body is no robot, or the entry is not what `driven_entry` has returned
    """
    values = known_mapping(entry, 'driven', [*_POSES, 'covariance', 'path', 'seconds'])
    if body.robot is None:
        raise BadProperty(f'{body.name} is not a robot; nothing has driven it', field='driven')
    seconds = values.get('seconds')
    until = NEVER
    if seconds is not None:
        until = round(Within(0.0, LONGEST, 's')(seconds, 'seconds') * physics_rate)
    poses = [_three(values.get(key, [0.0, 0.0, 0.0]), key) for key in _POSES]
    aim, wheels, travel, odometry = poses
    if 'covariance' in values:
        covariance = _covariance(values['covariance'])
    else:
        covariance = _covariance_of_path(values.get('path', [0.0, 0.0]), body.robot)
    return RobotState(aim, until, wheels, travel, odometry, covariance)


def acting_entry(acting: ActorState, physics_rate: float) -> dict[str, object]:
    """Return the entry of the state of an actor: for how long it has moved [s], points reached."""
    seconds = None if acting.begun == NEVER else -acting.begun / physics_rate
    return {'seconds': seconds, 'reached': acting.reached}


def acting_from(entry: object, body: Body, physics_rate: float) -> ActorState:
    """
    Return the state of an actor from its entry.

    :param body: of the actor
    :param physics_rate: of the world [Hz]
    :raises Refusal: the body is no actor, or the entry is not what `acting_entry` has returned
    """
    values = known_mapping(entry, 'acting', ['seconds', 'reached'])
    if body.actor is None:
        raise BadProperty(f'{body.name} is not an actor', field='acting')
    reached = Whole(0, _MOST_REACHED)(values.get('reached', 0), 'reached')
    seconds = values.get('seconds')
    if seconds is None:
        return WAITING._replace(reached=reached)
    moved = Within(-LONGEST, LONGEST, 's')(seconds, 'seconds')
    return ActorState(-round(moved * physics_rate), reached)


def _covariance(value: object) -> Covariance:
    if not isinstance(value, list) or len(value) != len(SPAWNED.covariance):
        raise BadProperty(
            f'covariance must be a list of six numbers, not {shown(value)}', field='covariance'
        )
    xx, xy, yy, x_yaw, y_yaw, yaw_yaw = (_VARIANCE(each, 'covariance') for each in value)
    if min(xx, yy, yaw_yaw) < 0.0:
        raise BadProperty('a variance is not negative', field='covariance')
    return xx, xy, yy, x_yaw, y_yaw, yaw_yaw


def _covariance_of_path(value: object, robot: Robot) -> Covariance:
    """Return the covariance by the way and the turns in a file that has no covariance."""
    way, turned = (_LENGTH(each, 'path') for each in pair(value, 'path'))
    ahead, heading = (deviation**2 for deviation in robot.odometry.slip)
    return ahead * way, 0.0, ahead * way, 0.0, 0.0, heading * (way + turned)


def _three(value: object, name: str) -> Pose:
    if not isinstance(value, list):
        raise BadProperty(
            f'{name} must be a list of three numbers, not {shown(value)}', field=name
        )
    numbers = tuple(number(each, name) for each in value)
    check_finite(numbers, 3, name)
    if max(map(abs, numbers)) > _GREATEST:
        raise BadProperty(f'{name} is out of range', field=name)
    x, y, turn = numbers
    return x, y, turn
