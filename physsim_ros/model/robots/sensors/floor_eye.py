# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A line follower's eye: a row of photodiodes over the floor (`sensor_msgs/Image`, 1 x n)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from physsim_ros.model.checks import Checks, Whole, Within
from physsim_ros.model.robots.sensors.sensor import LENGTH, Sensor

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
