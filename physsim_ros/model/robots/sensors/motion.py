# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sensors of the motion of a robot, by a gyroscope or by its wheels and joints."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

from physsim_ros.model.checks import FASTEST, Numbers, Within
from physsim_ros.model.robots.sensors.sensor import Sensor
from physsim_ros.model.texts import Words
from physsim_ros.model.transform import Point


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
