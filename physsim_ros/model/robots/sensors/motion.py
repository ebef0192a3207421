# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sensors of how a robot moves and where: inertial, of the wheels, by satellites."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from physsim_ros.model.checks import Checks, FASTEST, pair, Within
from physsim_ros.model.robots.sensors.sensor import LENGTH, Sensor
from physsim_ros.model.transform import Point

_DEVIATION = Within(0.0, FASTEST)


def _deviations(value: object, name: str) -> Point:
    acceleration, turn_rate = pair(value, name)
    return _DEVIATION(acceleration, name), _DEVIATION(turn_rate, name)


@dataclass(frozen=True, slots=True, kw_only=True)
class Imu(Sensor):
    """
    An inertial measurement unit.

    :param noise: standard deviations of acceleration [m/s²] and turn rate [rad/s]
    :param gravity: upwards, out of the plane [m/s²]: 9.81 of one that feels the earth's in a world
        that is seen from above
    """

    KIND: ClassVar = 'imu'
    CHECKS: ClassVar[Checks] = {
        **Sensor.CHECKS,
        'noise': _deviations,
        'gravity': Within(0.0, 100.0, 'm/s²'),
    }

    name: str = 'imu'
    rate: float = 100.0
    noise: Point = (0.0, 0.0)
    # Not part of the text, so that digests of worlds are those of ever; it moves nothing.
    gravity: float = field(default=0.0, repr=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelEncoders(Sensor):
    """The encoders of all wheels of the drive; `at` has no effect."""

    KIND: ClassVar = 'joint_states'

    name: str = 'joint_states'
    rate: float = 30.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Gps(Sensor):
    """
    A receiver of satellite navigation; without a `datum` of the world it has no fix.

    :param noise: standard deviation to the east, and to the north [m]
    """

    KIND: ClassVar = 'gps'
    CHECKS: ClassVar[Checks] = {**Sensor.CHECKS, 'noise': LENGTH}

    name: str = 'fix'
    rate: float = 5.0
    noise: float = 0.0
