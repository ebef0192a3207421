# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Fields of messages, checked: texts, names, points, poses and colours."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from physsim_ros.model.checks import check_point, number, pair, shown
from physsim_ros.model.colors import Color, color_from
from physsim_ros.model.errors import BadProperty, Malformed
from physsim_ros.model.names import LONGEST_NAME
from physsim_ros.model.transform import Point, Pose

# Of one message, not checked yet, by name.
Fields = Mapping[str, Any]
# By type of message: the names of its fields, and the reader that makes a checked value of them.
Readers = Mapping[str, tuple[list[str], Callable[[Fields], Any]]]


def text_of(value: object, name: str) -> str:
    """
    Return a text that is no longer than a name.

    :raises BadProperty: it is none, or longer
    """
    if not isinstance(value, str):
        raise BadProperty(f'{name} must be a text, not {shown(value)}', field=name)
    if len(value) > LONGEST_NAME:
        raise BadProperty(f'{name} has more than {LONGEST_NAME} characters', field=name)
    return value


def names_of(value: object, name: str) -> tuple[str, ...]:
    """
    Return the names of a list, as many as a message holds.

    :raises BadProperty: it is no list, or has no name
    """
    if not isinstance(value, list) or not value:
        raise BadProperty(f'{name} must be a list of at least one name', field=name)
    return tuple(text_of(each, name) for each in value)


def point_of(value: object, name: str) -> Point:
    """
    Return a point of the world [m].

    :raises Refusal: it is no pair of finite numbers, or too far away
    """
    point = pair(value, name)
    check_point(point, name)
    return point


def pose_of(value: object) -> Pose:
    """
    Return x, y [m] and yaw [rad].

    :raises Refusal: it is no list of three finite numbers
    """
    if not isinstance(value, list) or len(value) != 3:
        raise Malformed('at must be [x, y, yaw]', field='at')
    x, y, yaw = (number(each, 'at') for each in value)
    return x, y, yaw


def color_of(value: object) -> Color:
    """
    Return the colour of a text, as in world files.

    :raises Refusal: it is none
    """
    return color_from(text_of(value, 'color'))
