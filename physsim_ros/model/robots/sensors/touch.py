# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Sensors of what touches a robot, and of the floor below it.

Their messages are `std_msgs/Bool` and `sensor_msgs/Image`.
"""

from dataclasses import dataclass
import math
from typing import Annotated, ClassVar

from physsim_ros.model.checks import Whole, Within
from physsim_ros.model.robots.sensors.sensor import DISTANCE, FULL_TURN, Sensor
from physsim_ros.model.texts import Words

# Greatest number of photodiodes in a row.
_MOST_PIXELS = 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class Bumper(Sensor):
    """A bumper: whether another body or a wall touches a sector of its body, seen from `at`."""

    KIND: ClassVar = 'bumper'
    KIND_WORDS: ClassVar = Words('contact', 'touch', 'switch')

    name: str = 'bumper'
    rate: float = 30.0
    sector: Annotated[
        float, FULL_TURN, "angle about the sensor's axis; a full turn is the whole body"
    ] = math.pi


@dataclass(frozen=True, slots=True, kw_only=True)
class FloorEye(Sensor):
    """
    A row of photodiodes, across the axis of the sensor: colours of sensor bodies below it.

    The bare floor is white; of several bodies, the one spawned last is on top.
    """

    KIND: ClassVar = 'floor'
    KIND_WORDS: ClassVar = Words('line', 'line_sensor', 'camera', 'color', 'photodiodes')

    name: str = 'floor'
    rate: float = 30.0
    pixels: Annotated[int, Whole(1, _MOST_PIXELS), 'number of photodiodes'] = 8
    width: Annotated[
        float, DISTANCE, 'distance from the first photodiode, on the left, to the last'
    ] = 0.1
    noise: Annotated[float, Within(0.0, 1.0), 'standard deviation of a channel, of 0 .. 1'] = 0.0
