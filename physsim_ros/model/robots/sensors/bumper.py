# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A bumper: whether the front is touched (`std_msgs/Bool`)."""

from dataclasses import dataclass
import math
from typing import Annotated, ClassVar

from physsim_ros.model.robots.sensors.sensor import FULL_TURN, Sensor


@dataclass(frozen=True, slots=True, kw_only=True)
class Bumper(Sensor):
    """A bumper: whether another body or a wall touches a sector of its body, seen from `at`."""

    KIND: ClassVar = 'bumper'

    name: str = 'bumper'
    rate: float = 30.0
    sector: Annotated[
        float, FULL_TURN, "angle about the sensor's axis; a full turn is the whole body"
    ] = math.pi
