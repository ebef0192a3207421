# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sensors of how a robot moves and where: inertial, of the wheels, by satellites."""

from dataclasses import dataclass, field
from typing import Annotated, ClassVar

from physsim_ros.model.checks import FASTEST, pair, Within
from physsim_ros.model.robots.sensors.sensor import LENGTH, Sensor
from physsim_ros.model.transform import Point

_DEVIATION = Within(0.0, FASTEST)


def _deviations(value: object, name: str) -> Point:
    acceleration, turn_rate = pair(value, name)
    return _DEVIATION(acceleration, name), _DEVIATION(turn_rate, name)


@dataclass(frozen=True, slots=True, kw_only=True)
class Imu(Sensor):
    """An inertial measurement unit: turn rate, and acceleration as felt at `at`."""

    KIND: ClassVar = 'imu'

    name: str = 'imu'
    rate: float = 100.0
    noise: Annotated[
        Point, _deviations, 'standard deviations of acceleration [m/s²] and turn rate [rad/s]'
    ] = (0.0, 0.0)
    # Not part of the text, so that digests of worlds are those of ever; it moves nothing.
    gravity: Annotated[
        float,
        Within(0.0, 100.0, 'm/s²'),
        'z of its acceleration: 9.81 where the world is seen from above and a node expects it',
    ] = field(default=0.0, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelEncoders(Sensor):
    """Encoders: turns of all wheels of the drive; `at` has no effect."""

    KIND: ClassVar = 'joint_states'

    name: str = 'joint_states'
    rate: float = 30.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Gps(Sensor):
    """A receiver of satellite navigation, on WGS 84; without a `datum` it has no fix."""

    KIND: ClassVar = 'gps'

    name: str = 'fix'
    rate: float = 5.0
    noise: Annotated[float, LENGTH, 'standard deviation to the east, and to the north'] = 0.0
