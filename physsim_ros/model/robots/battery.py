# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A battery: the drive of a robot stops where it is empty; docks charge it.

Its voltage is constant. Currents are those that leave it: idle, and while the wheels turn.
"""

from dataclasses import dataclass
from typing import Annotated

from physsim_ros.model.checks import ListOf, text, Within
from physsim_ros.model.declarations import Checked
from physsim_ros.model.latency import MESSAGE_RATE

# Greatest capacity [A h], current [A] and voltage [V]: those of a truck.
_LARGEST = 1e4
_CURRENT = Within(0.0, _LARGEST, 'A')
# Greatest number of docks of a robot: `engine/core/core.h` has room for as many.
MOST_DOCKS = 16


@dataclass(frozen=True, slots=True, kw_only=True)
class Battery(Checked):
    """
    A battery.

    :raises Malformed: a number is not finite
    :raises BadProperty: a value is of the wrong kind or out of range
    """

    capacity: Annotated[float, Within(1e-4, _LARGEST, 'A h'), 'charge when it is full'] = 2.0
    level: Annotated[
        float, Within(0.0, 1.0), 'share of its capacity with which the robot is spawned'
    ] = 1.0
    voltage: Annotated[float, Within(0.0, _LARGEST, 'V'), 'voltage, full or empty'] = 12.0
    idle: Annotated[float, _CURRENT, 'current that drains it all the time'] = 0.2
    moving: Annotated[float, _CURRENT, 'further current while a wheel turns'] = 1.0
    charging: Annotated[float, _CURRENT, 'current that a dock gives to it, until it is full'] = 2.0
    docks: Annotated[
        tuple[str, ...],
        ListOf(text, 'names', MOST_DOCKS),
        f"names of at most {MOST_DOCKS} bodies that charge it while the robot's centre of mass "
        'is on them, such as sensors on the floor',
    ] = ()
    rate: Annotated[float, MESSAGE_RATE, 'messages a second'] = 1.0
