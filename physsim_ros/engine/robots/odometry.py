# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Odometry: the pose of a robot as its wheels and its gyroscope tell it.

Method: the way of the wheels in a step is an arc whose turn the gyroscope measures (exact
integration of a constant twist; Siegwart, Nourbakhsh, Autonomous Mobile Robots). Errors are random
walks: those of the way grow with its root, those of the heading with the root of way and turn
(Thrun, Burgard, Fox, Probabilistic Robotics, section 5.4, in the limit of short moves).
Law: noise is a function of seed, name and step; without slip there is none.
"""

from __future__ import annotations

from functools import lru_cache
import math

from physsim_ros.model.noise import normals
from physsim_ros.model.transform import Point, Pose, rotated

# Steps whose noise is made at once: a call of `normals` takes as long as 300 of its numbers.
_BLOCK = 64


def reckoned(pose: Pose, move: Pose) -> Pose:
    """
    Return a reckoned pose after a step.

    :param pose: before it [m, rad]
    :param move: way of the wheels in this step, as seen from the robot [m], and turn of the body
        [rad]
    """
    x, y, yaw = pose
    ahead, aside, turn = move
    chord = chord_by_arc(turn)
    ahead, aside = rotated((ahead * chord, aside * chord), yaw + turn / 2)
    return x + ahead, y + aside, yaw + turn


def slips(length: float, turn: float, slip: Point, noise: Point) -> Point:
    """
    Return the errors of a step: the told way by the true one, and the error of the turn [rad].

    :param length: of the way of the wheels in this step [m]
    :param turn: of the body in this step [rad]
    :param slip: drift of the odometry (`model.robots.Odometry`)
    :param noise: two normal numbers of mean 0 and variance 1
    """
    share = 1.0 + noise[0] * slip[0] / math.sqrt(length) if length > 0.0 else 1.0
    return share, noise[1] * slip[1] * math.sqrt(length + abs(turn))


def noise_of_step(seed: int, name: str, step: int) -> Point:
    """
    Return two normal numbers of mean 0 and variance 1.

    :param seed: of all noise of the world
    :param name: of the robot
    :param step: number of the step
    """
    block, place = divmod(step, _BLOCK)
    return _noise(seed, name, block)[place]


def chord_by_arc(turn: float) -> float:
    """Return the chord of an arc by its length, for the turn along it [rad]."""
    half = turn / 2
    return math.sin(half) / half if half else 1.0


@lru_cache(maxsize=1024)
def _noise(seed: int, name: str, block: int) -> list[Point]:
    """Return normal numbers for the way and the heading of 64 steps."""
    numbers = normals(seed, f'odometry of {name}', block, 2 * _BLOCK).tolist()
    return list(zip(numbers[::2], numbers[1::2], strict=True))
