# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A receiver of satellite navigation: latitude and longitude (`sensor_msgs/NavSatFix`)."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

from physsim_ros.model.robots.sensors.sensor import LENGTH, Sensor


@dataclass(frozen=True, slots=True, kw_only=True)
class Gps(Sensor):
    """A receiver of satellite navigation, on WGS 84; without a `datum` it has no fix."""

    KIND: ClassVar = 'gps'

    name: str = 'fix'
    rate: float = 5.0
    noise: Annotated[float, LENGTH, 'standard deviation to the east, and to the north'] = 0.0
