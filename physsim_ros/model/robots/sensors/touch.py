# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Sensors of what touches a robot, and of the floor below it.

Their messages are `std_msgs/Bool` and `sensor_msgs/Image`.
"""

from __future__ import annotations

from dataclasses import dataclass
import math
from typing import ClassVar

from physsim_ros.model.checks import Checks, Whole, Within
from physsim_ros.model.robots.sensors.sensor import FULL_TURN, LENGTH, Sensor


@dataclass(frozen=True, slots=True, kw_only=True)
class Bumper(Sensor):
    """
    A bumper: a sector of the body, as seen from `at`.

    :param sector: its angle about the sensor's axis [rad]; a full turn is the whole body
    """

    KIND: ClassVar = 'bumper'
    CHECKS: ClassVar[Checks] = {**Sensor.CHECKS, 'sector': FULL_TURN}

    name: str = 'bumper'
    rate: float = 30.0
    sector: float = math.pi


# Greatest number of photodiodes in a row.
_MOST_PIXELS = 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class FloorEye(Sensor):
    """
    A row of photodiodes, across the sensor's axis.

    :param pixels: their number
    :param width: from the first, on the left, to the last [m]
    :param noise: standard deviation of a channel, of 0 .. 1
    """

    KIND: ClassVar = 'floor'
    CHECKS: ClassVar[Checks] = {
        **Sensor.CHECKS,
        'pixels': Whole(1, _MOST_PIXELS),
        'width': LENGTH,
        'noise': Within(0.0, 1.0),
    }

    name: str = 'floor'
    rate: float = 30.0
    pixels: int = 8
    width: float = 0.1
    noise: float = 0.0
