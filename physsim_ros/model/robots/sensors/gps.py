# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A receiver of satellite navigation: latitude and longitude (`sensor_msgs/NavSatFix`)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from physsim_ros.model.checks import Checks
from physsim_ros.model.robots.sensors.sensor import LENGTH, Sensor


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
