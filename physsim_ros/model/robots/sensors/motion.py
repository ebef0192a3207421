# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Sensors of the robot itself: of its motion, of what touches it, and of the floor below it.

Bumpers and floors have messages of `std_msgs/Bool` and `sensor_msgs/Image`.
"""

from dataclasses import dataclass
import math
from typing import Annotated, ClassVar

from physsim_ros.model.checks import FASTEST, Numbers, OneOf, Whole, Within
from physsim_ros.model.robots.sensors.sensor import DISTANCE, FULL_TURN, Sensor
from physsim_ros.model.texts import Words
from physsim_ros.model.transform import Point

# Greatest number of photodiodes in a row.
_MOST_PIXELS = 1000


@dataclass(frozen=True, slots=True, kw_only=True)
class Imu(Sensor):
    """An inertial measurement unit: turn rate, and proper acceleration at `at`."""

    KIND: ClassVar = 'imu'
    KIND_WORDS: ClassVar = Words('gyro', 'gyroscope', 'accelerometer')

    name: str = 'imu'
    rate: float = 100.0
    noise: Annotated[
        Point,
        Numbers((Within(0.0, FASTEST),) * 2),
        'standard deviations of acceleration [m/s²] and turn rate [rad/s]',
    ] = (0.0, 0.0)
    gravity: Annotated[
        float,
        Within(0.0, 100.0, 'm/s²'),
        'z of its acceleration: 9.81 where the world is seen from above and a node expects it',
    ] = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelEncoders(Sensor):
    """Encoders: of all wheels of the drive, and of all joints; `at` and `link` have no effect."""

    KIND: ClassVar = 'joint_states'
    KIND_WORDS: ClassVar = Words('encoder', 'encoders', 'wheel_encoders', 'wheels')

    name: str = 'joint_states'
    rate: float = 30.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Gps(Sensor):
    """A receiver of satellite navigation, on WGS 84; without a `datum` it has no fix."""

    KIND: ClassVar = 'gps'
    KIND_WORDS: ClassVar = Words('gnss', 'navsat', 'fix')

    name: str = 'fix'
    rate: float = 5.0
    noise: Annotated[float, DISTANCE, 'standard deviation to the east, and to the north'] = 0.0
    status: Annotated[
        str,
        OneOf(('none', 'fix', 'sbas', 'gbas')),
        'augmentation of its fixes: `fix` none, `sbas` by satellites, `gbas` from the ground '
        '(RTK); `none` has no position',
    ] = 'fix'


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
