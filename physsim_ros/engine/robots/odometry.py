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

import numpy as np
from physsim_ros.engine.robots.robot_columns import RobotColumns
from physsim_ros.engine.step_context import StepContext
from physsim_ros.model.arrays import Floats
from physsim_ros.model.noise import normals
from physsim_ros.model.transform import rotated_each

# Steps whose noise is made at once: a call of `normals` takes as long as 300 of its numbers.
_BLOCK = 64


def reckon(
    poses: Floats, ways: Floats, turns: Floats, columns: RobotColumns, context: StepContext
) -> None:
    """
    Add a step to reckoned poses.

    :param poses: (r, 3) float64: changed in place [m, rad]
    :param ways: (r, 3) float64: of the wheels in this step, as seen from the robot [m, rad]
    :param turns: (r,) float64: of the bodies in this step [rad]
    """
    ways = ways[:, :2]
    noisy = np.flatnonzero(columns.slip.any(axis=1))
    if len(noisy):
        ways, turns = ways.copy(), turns.copy()
        length = np.hypot(ways[noisy, 0], ways[noisy, 1])
        moved = (length > 0.0) | (turns[noisy] != 0.0)
        noisy, length = noisy[moved], length[moved]
    if len(noisy):
        block, place = divmod(context.step, _BLOCK)
        seed = context.settings.seed
        noise = np.array([_noise(seed, columns.names[row], block)[place] for row in noisy])
        error = noise[:, 0] * columns.slip[noisy, 0] / np.sqrt(np.where(length > 0.0, length, 1.0))
        ways[noisy] *= 1.0 + error[:, None]
        root = np.sqrt(length + np.abs(turns[noisy]))
        turns[noisy] += noise[:, 1] * columns.slip[noisy, 1] * root
    poses[:, :2] += rotated_each(ways * chord_by_arc(turns)[:, None], poses[:, 2] + turns / 2)
    poses[:, 2] += turns


def chord_by_arc(turns: Floats) -> Floats:
    """Return (r,) float64: chords of arcs by their lengths, for the turns along them [rad]."""
    half = turns / 2
    straight = half == 0.0
    result: Floats = np.where(straight, 1.0, np.sin(half) / np.where(straight, 1.0, half))
    return result


@lru_cache(maxsize=1024)
def _noise(seed: int, name: str, block: int) -> Floats:
    """Return (64, 2) float64: normal numbers for the way and the heading of as many steps."""
    return normals(seed, f'odometry of {name}', block, 2 * _BLOCK).reshape(-1, 2)
