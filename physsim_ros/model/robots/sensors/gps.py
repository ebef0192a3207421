# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The receiver of satellite navigation."""

from dataclasses import dataclass
from typing import Annotated, ClassVar

from physsim_ros.model.checks import OneOf
from physsim_ros.model.robots.sensors.sensor import DISTANCE, Sensor
from physsim_ros.model.texts import Words


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
