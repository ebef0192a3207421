# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A car: driven rear wheels on an axle through the body's origin, steered front wheels."""

from dataclasses import dataclass
import math
from typing import Annotated, ClassVar

from physsim_ros.model.checks import Within
from physsim_ros.model.robots.drives.drive import Drive, LENGTH, within
from physsim_ros.model.transform import Pose, Twist

# Greatest angle of the front wheels [rad]: 89 degrees.
_STEEPEST = 1.55


@dataclass(frozen=True, slots=True, kw_only=True)
class Car(Drive):
    """A car with Ackermann steering; it turns only as it moves, and no closer than it steers."""

    KIND: ClassVar = 'car'

    wheelbase: Annotated[float, LENGTH, 'distance of front and rear axle'] = 0.2
    steering: Annotated[
        float, Within(0.0, _STEEPEST, 'rad'), 'greatest angle of the front wheels'
    ] = 0.6

    @property
    def wheels(self) -> dict[str, Pose]:
        """Return the wheels that drive, by the name of their joint."""
        half = self.track / 2
        return {
            'rear_left_wheel_joint': (1.0, 0.0, -half),
            'rear_right_wheel_joint': (1.0, 0.0, half),
        }

    @property
    def lever(self) -> float:
        """Return the mean distance of its wheels from their middle [m]."""
        return math.hypot(self.track, self.wheelbase) / 2

    @property
    def most_curved(self) -> float:
        """Return the greatest curvature of its way [1/m]."""
        return math.tan(self.steering) / self.wheelbase

    def aim(self, command: Twist) -> Twist:
        """Return the velocity that it can have and that is nearest to a commanded one."""
        speed, turn = within(command[0], self.max_speed), within(command[2], self.max_turn)
        return speed, 0.0, within(turn, abs(speed) * self.most_curved)
