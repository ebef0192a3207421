# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Drives: by which wheels a robot moves.

A drive says where it aims at for a command, and how fast the rims of its wheels are. The engine
needs no more, so that a new drive is a class here and a member of `DRIVES`.

Velocities of a drive are those of the floor under its wheels, as seen from the robot: vx forward,
vy to the left [m/s], turn counter-clockwise [rad/s], at the origin of the body (REP 103).
"""

from abc import ABC, abstractmethod
from dataclasses import dataclass
import math
from typing import Annotated, ClassVar

from physsim_ros.model.checks import FASTEST, FRICTION, MOST_SPEED_WORDS, Within
from physsim_ros.model.declarations import Checked, OfKind
from physsim_ros.model.latency import COMMAND_RATE, COMMAND_RATE_WORDS, delays, LATENCY_WORDS
from physsim_ros.model.shapes import LARGEST, SMALLEST
from physsim_ros.model.texts import Words
from physsim_ros.model.transform import Point, Pose, Twist

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

    max_speed: Annotated[
        float, Within(0.0, FASTEST, 'm/s'), 'a command beyond it is cut off', MOST_SPEED_WORDS
    ] = 0.5
    max_turn: Annotated[float, Within(0.0, FASTEST, 'rad/s'), 'a command beyond it is cut off'] = (
        2.0
    )
    acceleration: Annotated[
        float, Within(0.0, _STRONGEST, 'm/s²'), 'greatest acceleration of the rim of a wheel'
    ] = 2.0
    traction: Annotated[float, FRICTION, 'coefficient of friction between wheels and floor'] = 0.8
    timeout: Annotated[
        float,
        Within(0.0, _LONGEST, 's'),
        'simulation time after which it stops without another command; 0 is no limit',
    ] = 0.5
    latency: Annotated[
        Point,
        delays,
        'least and greatest time from a command to the wheels, drawn by `seed`; one number is '
        'both [s]',
        LATENCY_WORDS,
    ] = (0.0, 0.0)
    command_rate: Annotated[
        float,
        COMMAND_RATE,
        'times a second at which it looks for a new command; 0 is each step',
        COMMAND_RATE_WORDS,
    ] = 0.0
    track: Annotated[
        float,
        LENGTH,
        'distance of left and right wheel; of `omni` the diameter of the circle of its three '
        'wheels',
    ] = 0.2
    wheel_radius: Annotated[float, LENGTH, 'radius of its wheels'] = 0.03

    @property
    @abstractmethod
    def wheels(self) -> dict[str, Pose]:
        """
        Return the wheels that drive, by the name of their joint.

        The speed of a rim is a sum of the velocity's vx, vy and turn, by these factors.
        """

    @property
    def lever(self) -> float:
        """Return the mean distance of its wheels from their middle [m]."""
        return self.track / 2

    @property
    def holonomic(self) -> bool:
        """Whether it moves sideways, too."""
        return False

    @property
    def most_curved(self) -> float:
        """Return the greatest curvature of its path [1/m]."""
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


@dataclass(frozen=True, slots=True, kw_only=True)
class Differential(Drive):
    """A differential drive; it resists every lateral velocity, and turns in place."""

    KIND: ClassVar = 'differential'
    KIND_WORDS: ClassVar = Words('diff', 'diff_drive', 'differential_drive', 'two_wheels', 'tank')

    @property
    def wheels(self) -> dict[str, Pose]:
        """Return the wheels that drive, by the name of their joint."""
        half = self.track / 2
        return {'wheel_left_joint': (1.0, 0.0, -half), 'wheel_right_joint': (1.0, 0.0, half)}

    def aim(self, command: Twist) -> Twist:
        """Return the velocity that it can have and that is nearest to a commanded one."""
        vx, _, turn = command
        return within(vx, self.max_speed), 0.0, within(turn, self.max_turn)


_ANGLES = {
    'wheel_1_joint': math.radians(60.0),
    'wheel_2_joint': math.radians(180.0),
    'wheel_3_joint': math.radians(300.0),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Omni(Drive):
    """An omnidirectional drive; `track` is the diameter of the circle that its wheels are on."""

    KIND: ClassVar = 'omni'
    KIND_WORDS: ClassVar = Words('omnidirectional', 'holonomic', 'mecanum', 'kiwi')

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

    def aim(self, command: Twist) -> Twist:
        """Return the velocity that it can have and that is nearest to a commanded one."""
        vx, vy, turn = command
        speed = math.hypot(vx, vy)
        if speed > self.max_speed:
            vx, vy = vx * (self.max_speed / speed), vy * (self.max_speed / speed)
        return vx, vy, within(turn, self.max_turn)


# Greatest angle of the front wheels [rad]: 89 degrees.
_STEEPEST = 1.55


@dataclass(frozen=True, slots=True, kw_only=True)
class Car(Drive):
    """A car with Ackermann steering; it turns only as it moves, and no closer than it steers."""

    KIND: ClassVar = 'car'
    KIND_WORDS: ClassVar = Words('ackermann', 'bicycle', 'steering', 'vehicle')

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
        """Return the greatest curvature of its path [1/m]."""
        return math.tan(self.steering) / self.wheelbase

    def aim(self, command: Twist) -> Twist:
        """Return the velocity that it can have and that is nearest to a commanded one."""
        speed, turn = within(command[0], self.max_speed), within(command[2], self.max_turn)
        return speed, 0.0, within(turn, abs(speed) * self.most_curved)


# By the word for it.
DRIVES: dict[str, type[Drive]] = {each.KIND: each for each in (Differential, Omni, Car)}


# The check of a drive.
drive_from = OfKind('drive', DRIVES)
