# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
What all drives have in common: limits of motion, and their wheels.

Velocities of a drive are those of the floor under its wheels, as seen from the robot: vx forward,
vy to the left [m/s], turn counter-clockwise [rad/s], at the origin of the body (REP 103).
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
import math
from typing import Annotated, ClassVar

from physsim_ros.model.checks import FASTEST, Within
from physsim_ros.model.declarations import Checked
from physsim_ros.model.shapes import LARGEST, SMALLEST
from physsim_ros.model.transform import Pose, Twist

# Greatest acceleration of wheels [m/s²]: 0.4 m/s in a step.
_STRONGEST = 1e2
# Longest time for which a command counts [s].
_LONGEST = 1e6

LENGTH = Within(SMALLEST, LARGEST, 'm')


@dataclass(frozen=True, slots=True, kw_only=True)
class Drive(Checked, ABC):
    """
    A drive of a robot.

    :raises Malformed: a number is not finite
    :raises BadProperty: a value is of the wrong kind or out of range
    """

    KIND: ClassVar[str]
    max_speed: Annotated[float, Within(0.0, FASTEST, 'm/s'), 'a command beyond it is cut off'] = (
        0.5
    )
    max_turn: Annotated[float, Within(0.0, FASTEST, 'rad/s'), 'a command beyond it is cut off'] = (
        2.0
    )
    acceleration: Annotated[
        float, Within(0.0, _STRONGEST, 'm/s²'), 'greatest one of the rim of a wheel'
    ] = 2.0
    traction: Annotated[
        float, Within(0.0, 10.0), 'coefficient of friction between wheels and floor'
    ] = 0.8
    timeout: Annotated[
        float,
        Within(0.0, _LONGEST, 's'),
        'simulation time after which it stops without another command; 0 is no limit',
    ] = 0.5
    track: Annotated[
        float,
        LENGTH,
        'from left to right wheel; of `omni` the diameter of the circle that its three wheels are '
        'on',
    ] = 0.2
    wheel_radius: Annotated[float, LENGTH, 'of its wheels'] = 0.03

    def entry(self) -> dict[str, object]:
        """Return the mapping that it is made from."""
        return {'kind': self.KIND, **self.explicit()}

    @property
    @abstractmethod
    def wheels(self) -> dict[str, Pose]:
        """
        Return the wheels that drive, by the name of their joint.

        The speed of a rim is a sum of the velocity's vx, vy and turn, by these factors.
        """

    @property
    @abstractmethod
    def lever(self) -> float:
        """Return the mean distance of its wheels from their middle [m]."""

    @property
    def holonomic(self) -> bool:
        """Whether it moves sideways, too."""
        return False

    @property
    def most_curved(self) -> float:
        """Return the greatest curvature of its way [1/m]."""
        return math.inf

    @abstractmethod
    def aim(self, command: Twist) -> Twist:
        """
        Return the velocity that it can have and that is nearest to a commanded one.

        :param command: finite vx, vy [m/s], turn [rad/s]
        """


def within(value: float, most: float) -> float:
    """Return a number cut off at -most and most."""
    return max(-most, min(most, value))
