# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Commands of the motors of joints: a position, a velocity, an effort, or a trajectory."""

from collections.abc import Iterable
from dataclasses import dataclass
import itertools
import math
from typing import Annotated, NamedTuple

from physsim_ros.model.checks import check_finite, HEAVIEST, LONGEST, must_be, OneOf, text
from physsim_ros.model.declarations import Checked
from physsim_ros.model.errors import BadProperty, Malformed
from physsim_ros.model.names import JOINT

# In the order of `COMMAND_POSITION` ... of `engine/core/core.h`.
MODES = ('position', 'velocity', 'effort')
# Greatest number of points of a trajectory.
MOST_POINTS = 1000


class CommandPoint(NamedTuple):
    """
    A point of a trajectory.

    :ivar time: since the command [s]
    :ivar value: position [rad, m], velocity [rad/s, m/s] or effort [N m, N] then
    :ivar rate: of a position, its velocity there; NaN is none: the path up to the next point, and
        from the one before, is straight
    """

    time: float
    value: float
    rate: float = math.nan


def points_from(value: object, name: str) -> tuple[CommandPoint, ...]:
    """
    Return the points of a list of times, values and, where there are three numbers, rates.

    :param name: of the field, for the refusal
    :raises Malformed: it is no such list, or a number is not finite
    :raises BadProperty: there are too many points, a number is out of range, or times fall
    """
    if not isinstance(value, Iterable):
        raise must_be('a list of points', value, name, Malformed)
    points = tuple(_point(each, name) for each in value)
    if not 1 <= len(points) <= MOST_POINTS:
        raise BadProperty('{field} must be 1 to {most} points', field=name, most=MOST_POINTS)
    if any(b.time <= a.time for a, b in itertools.pairwise(points)):
        raise BadProperty('the times of {field} must increase', field=name)
    return points


def _point(value: object, name: str) -> CommandPoint:
    if not isinstance(value, list | tuple) or len(value) not in (2, 3):
        raise must_be('[time, value] or [time, value, rate]', value, name, Malformed)
    time, number = check_finite(value[:2], 2, name)
    rate = value[2] if len(value) == 3 and value[2] is not None else math.nan
    if not (isinstance(rate, float) and math.isnan(rate)):
        (rate,) = check_finite((rate,), 1, name)
    if not 0.0 <= time <= LONGEST:
        raise BadProperty(
            'a time of {field} must lie between 0 and {most:g} s', field=name, most=LONGEST
        )
    if abs(number) > HEAVIEST or abs(rate) > HEAVIEST:
        raise BadProperty('a value or rate of {field} exceeds {most:g}', field=name, most=HEAVIEST)
    return CommandPoint(time, number, rate)


@dataclass(frozen=True, slots=True, kw_only=True)
class MotorCommand(Checked):
    """
    A command of the motor of a joint, until the next one.

    :raises Malformed: a number is not finite
    :raises BadProperty: there is no such mode, or a value or time is out of range
    """

    joint: Annotated[str, text, 'name of the joint', JOINT]
    mode: Annotated[str, OneOf(MODES), 'of the values']
    points: Annotated[
        tuple[CommandPoint, ...], points_from, 'time [s], value, rate; the last value stays'
    ]


class TimedCommand(NamedTuple):
    """
    A command of a motor, and the step at which it begins: of one on its way, a later one.

    :ivar command: of the motor
    :ivar begun: the step, in a saved state counted from the moment of saving
    """

    command: MotorCommand
    begun: int
