# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Fields of messages, checked: texts, names, points, poses and colours."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from physsim_ros.model.checks import check_point, number, pair, shown
from physsim_ros.model.colors import Color, color_from
from physsim_ros.model.errors import BadProperty, Malformed
from physsim_ros.model.transform import Point, Pose

# Of one message, not checked yet, by name.
Fields = Mapping[str, Any]
# By type of message: the names of its fields, and the reader that makes a checked value of them.
Readers = Mapping[str, tuple[list[str], Callable[[Fields], Any]]]

# Length of a name of a body, a joint or a world [characters], as in `model.names`.
LONGEST_NAME = 1000
# Names in one message.
MOST_NAMES = 1000


def text_of(value: object, name: str) -> str:
    """
    Return a text that is not too long.

    :raises BadProperty: it is none, or longer
    """
    if not isinstance(value, str) or len(value) > LONGEST_NAME:
        raise BadProperty(f'{name} must be a text, not {shown(value)}', field=name)
    return value


def names_of(value: object, name: str) -> tuple[str, ...]:
    """
    Return the names of a list.

    :raises BadProperty: it is no list, or has no name, or too many
    """
    if not isinstance(value, list) or not 0 < len(value) <= MOST_NAMES:
        raise BadProperty(f'{name} must be a list of 1 to {MOST_NAMES} names', field=name)
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
