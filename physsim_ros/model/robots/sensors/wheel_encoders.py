# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Encoders of the wheels: how far and how fast they have turned (`sensor_msgs/JointState`)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from physsim_ros.model.robots.sensors.sensor import Sensor


@dataclass(frozen=True, slots=True, kw_only=True)
class WheelEncoders(Sensor):
    """Encoders: turns of all wheels of the drive; `at` has no effect."""

    KIND: ClassVar = 'joint_states'

    name: str = 'joint_states'
    rate: float = 30.0
