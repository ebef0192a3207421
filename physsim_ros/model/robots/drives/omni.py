# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""An omnidirectional drive: three omniwheels on a circle, at 60, 180 and 300 degrees."""

from __future__ import annotations

from dataclasses import dataclass
import math
from typing import ClassVar

from physsim_ros.model.robots.drives.drive import Drive, within
from physsim_ros.model.transform import Pose, Twist

_ANGLES = {
    'wheel_1_joint': math.radians(60.0),
    'wheel_2_joint': math.radians(180.0),
    'wheel_3_joint': math.radians(300.0),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Omni(Drive):
    """An omnidirectional drive; `track` is the diameter of the circle that its wheels are on."""

    KIND: ClassVar = 'omni'

    @property
    def wheels(self) -> dict[str, Pose]:
        """Return the wheels that drive, by the name of their joint."""
        # A wheel rolls along the tangent of the circle, its rollers along the radius.
        return {
            joint: (-math.sin(angle), math.cos(angle), self.track / 2)
            for joint, angle in _ANGLES.items()
        }

    @property
    def holonomic(self) -> bool:
        """Whether it moves sideways, too."""
        return True

    @property
    def lever(self) -> float:
        """Return the mean distance of its wheels from their middle [m]."""
        return self.track / 2

    def aim(self, command: Twist) -> Twist:
        """Return the velocity that it can have and that is nearest to a commanded one."""
        vx, vy, turn = command
        speed = math.hypot(vx, vy)
        if speed > self.max_speed:
            vx, vy = vx * (self.max_speed / speed), vy * (self.max_speed / speed)
        return vx, vy, within(turn, self.max_turn)
