# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A differential drive: two wheels on one axle through the body's origin, and casters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from physsim_ros.model.robots.drives.drive import Drive, within
from physsim_ros.model.transform import Pose, Twist


@dataclass(frozen=True, slots=True, kw_only=True)
class Differential(Drive):
    """A differential drive; it resists every lateral velocity, and turns in place."""

    KIND: ClassVar = 'differential'

    @property
    def wheels(self) -> dict[str, Pose]:
        """Return the wheels that drive, by the name of their joint."""
        half = self.track / 2
        return {'wheel_left_joint': (1.0, 0.0, -half), 'wheel_right_joint': (1.0, 0.0, half)}

    @property
    def lever(self) -> float:
        """Return the mean distance of its wheels from their middle [m]."""
        return self.track / 2

    def aim(self, command: Twist) -> Twist:
        """Return the velocity that it can have and that is nearest to a commanded one."""
        vx, _, turn = command
        return within(vx, self.max_speed), 0.0, within(turn, self.max_turn)
