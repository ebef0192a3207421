# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The base of all sensors: a topic, a place on the body, a rate."""

from abc import ABC
from dataclasses import dataclass
import math
import re
from typing import Annotated

from physsim_ros.model.checks import AT_WORDS, must_be, Numbers, shown, text, Within
from physsim_ros.model.declarations import Checked
from physsim_ros.model.errors import BadProperty, Malformed
from physsim_ros.model.latency import delays, LATENCY_WORDS, MESSAGE_RATE
from physsim_ros.model.robots.part_names import BASE, check_part
from physsim_ros.model.shapes import LARGEST
from physsim_ros.model.transform import ORIGIN, Point, Pose

# Tokens of ROS (https://design.ros2.org/articles/topic_and_service_names.html).
_TOPIC = re.compile(r'[A-Za-z_][A-Za-z0-9_]*(/[A-Za-z_][A-Za-z0-9_]*)*')
# Characters of the name of a topic below its namespace: topics of ROS have 255 in all.
_LONGEST = 80
# A full turn as people write it, 6.2832, is this much more than one at most [rad].
_TURN_ROUNDING = 1e-4
# Greatest angle of a beam from the sensor's axis [rad].
_FARTHEST_ROUND = 2 * math.tau

# Least angle between two beams [rad]: far above the rounding of angles.
LEAST_INCREMENT = 1e-6
FULL_TURN = Within(0.0, math.tau + _TURN_ROUNDING, 'rad')
DISTANCE = Within(0.0, LARGEST, 'm')
_COORDINATE = Within(-LARGEST, LARGEST, 'm')
_ANGLE = Within(-_FARTHEST_ROUND, _FARTHEST_ROUND, 'rad')


def topic_name(value: object, name: str) -> str:
    """
    Return the name of a topic below the namespace of a robot.

    :param name: of the field, for the refusal
    :raises BadProperty: ROS does not allow it
    """
    word = text(value, name, BadProperty)
    if len(word) > _LONGEST or not _TOPIC.fullmatch(word):
        raise BadProperty(
            '{field} {value} is not a ROS topic: letters, digits and _, not a digit first, at '
            'most {most} characters',
            field=name,
            value=shown(value),
            most=_LONGEST,
        )
    return word


def mounting(value: object, name: str) -> Pose:
    """
    Return a pose in the frame of a body: x, y [m] and, where there are three numbers, yaw [rad].

    :param name: of the field, for the refusal
    :raises Malformed: there are neither two nor three
    :raises BadProperty: it is no list of numbers, or one is out of range
    """
    if not isinstance(value, list | tuple):
        raise must_be('a list of numbers', value, name)
    if len(value) not in (2, 3):
        raise Malformed('{field} must be [x, y] or [x, y, yaw]', field=name)
    x, y = (_COORDINATE(each, name) for each in value[:2])
    return x, y, _ANGLE(value[2], name) if len(value) == 3 else 0.0


def span(value: object, name: str, limits: Within) -> Point:
    """
    Return the lesser and the greater end of a range.

    :param name: of the field, for the refusal
    :param limits: of both
    :raises Malformed: there are not two of them, or one is not finite
    :raises BadProperty: they are out of range or out of order
    """
    low, high = Numbers((limits, limits))(value, name)
    if low > high:
        raise must_be('[min, max]', value, name)
    return low, high


def distances(value: object, name: str) -> Point:
    """Return the least and the greatest distance that a sensor measures [m]."""
    low, high = span(value, name, DISTANCE)
    if low == high:
        raise BadProperty('{field} must be [min, max], min below max', field=name)
    return low, high


def angles(value: object, name: str) -> Point:
    """Return the first and the last angle of a sensor [rad], at most a full turn apart."""
    low, high = span(value, name, _ANGLE)
    if high - low > FULL_TURN.high:
        raise BadProperty(
            '{field} spans more than a full turn: {angle:g} rad', field=name, angle=high - low
        )
    return low, high


@dataclass(frozen=True, slots=True, kw_only=True)
class Sensor(Checked, ABC):
    """
    A sensor of a robot.

    :raises Malformed: a number is not finite, or a list has the wrong length
    :raises BadProperty: a value is of the wrong kind or out of range
    """

    name: Annotated[str, topic_name, 'of its topic, below the namespace of the robot']
    at: Annotated[Pose, mounting, 'x, y [m], yaw [rad] in the frame of its link', AT_WORDS] = (
        ORIGIN
    )
    rate: Annotated[float, MESSAGE_RATE, 'readings a second of simulation time'] = 10.0
    link: Annotated[str, check_part, 'that it is mounted on; `base` is the body of the robot'] = (
        BASE
    )
    latency: Annotated[
        Point,
        delays,
        'least and greatest time from a reading to its message, which has the stamp of the '
        'reading, drawn by `seed`; one number is both [s]',
        LATENCY_WORDS,
    ] = (0.0, 0.0)
