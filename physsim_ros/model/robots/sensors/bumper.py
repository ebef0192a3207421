# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A bumper: whether the front is touched (`std_msgs/Bool`)."""

from __future__ import annotations

from dataclasses import dataclass
import math
from typing import ClassVar

from physsim_ros.model.checks import Checks
from physsim_ros.model.robots.sensors.sensor import FULL_TURN, Sensor


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
