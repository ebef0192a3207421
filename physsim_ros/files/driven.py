# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The state of a robot in world files, under the key `driven` of its body."""

from __future__ import annotations

from physsim_ros.model.checks import (
    check_finite,
    known_mapping,
    LONGEST,
    number,
    pair,
    shown,
    Within,
)
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.robot_states import NEVER, RobotState
from physsim_ros.model.scene import Body
from physsim_ros.model.transform import Pose

_POSES = ('aim', 'wheels', 'travel', 'odometry')
# Greatest number in them, as of a motion [m, rad, m/s, rad/s].
_GREATEST = 1e12
_LENGTH = Within(0.0, _GREATEST)


def driven_entry(driven: RobotState, physics_rate: float) -> dict[str, object]:
    """Return the entry of the state of a robot."""
    entry: dict[str, object] = {key: list(getattr(driven, key)) for key in _POSES}
    seconds = None if driven.until == NEVER else driven.until / physics_rate
    return {**entry, 'path': list(driven.path), 'seconds': seconds}


def driven_from(entry: object, body: Body, physics_rate: float) -> RobotState:
    """
    Return the state of a robot from its entry.

    :param body: of the robot
    :param physics_rate: of the world [Hz]
    :raises Refusal: the body is no robot, or the entry is not what `driven_entry` has returned
    """
    values = known_mapping(entry, 'driven', [*_POSES, 'path', 'seconds'])
    if body.robot is None:
        raise BadProperty(f'{body.name} is not a robot; nothing has driven it', field='driven')
    seconds = values.get('seconds')
    until = NEVER
    if seconds is not None:
        until = round(Within(0.0, LONGEST, 's')(seconds, 'seconds') * physics_rate)
    poses = [_three(values.get(key, [0.0, 0.0, 0.0]), key) for key in _POSES]
    aim, wheels, travel, odometry = poses
    way, turned = pair(values.get('path', [0.0, 0.0]), 'path')
    path = _LENGTH(way, 'path'), _LENGTH(turned, 'path')
    return RobotState(aim, until, wheels, travel, odometry, path)


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
