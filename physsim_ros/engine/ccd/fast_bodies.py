# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Fast bodies: those that concern continuous collision, and those that concern tight boxes.

Most worlds are slow. One comparison of all velocities with their slow bounds says so; the exact
criteria are computed as soon as one body exceeds its bound.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.engine.scene_columns import SceneColumns
from physsim_ros.model.arrays import Flags, Floats

# The engine extends a box by the displacement in this time [s].
EXTENSION = 0.1
# Count of pairs of a body's pieces with pieces nearby, beyond which its box is kept tight: the
# engine goes through 1,000 pairs in 3 to 5 us, and stores 56 kB for them.
MOST_PAIRS = 1000.0
# Shares of the greatest displacement that each coordinate and the turning may take within slow
# bounds: together less than 1, by more than rounding.
_COORDINATE, _TURNING = 0.6, 0.15


def fast_bodies(columns: SceneColumns, moves: Floats) -> Flags:
    """
    Return (n,) bool: bodies that could meet others in a step unseen by the engine.

    :param moves: (n, 3) float64: of all bodies in the step [m, rad]
    """
    lengths = np.hypot(moves[:, 0], moves[:, 1]) + np.abs(moves[:, 2]) * columns.turning_radii
    fast: Flags = columns.solid & (lengths > columns.safe_depths.min(initial=np.inf))
    return fast


def fast_in_crowd(columns: SceneColumns, ways: Floats) -> Flags:
    """
    Return (n,) bool: bodies whose extended boxes may overlap more than `MOST_PAIRS` pieces.

    :param ways: (n, 2) float64: by which their boxes are extended, in `EXTENSION` [m]
    """
    # A box of k half widths overlaps k² / 2 others at most, where bodies of a size fill the plane.
    most = (ways**2).sum(axis=1) / (2.0 * columns.half_widths**2)
    fast: Flags = columns.pieces * np.minimum(most, columns.pieces.sum()) > MOST_PAIRS
    return fast


def slow_bounds(columns: SceneColumns, dt: float) -> Floats:
    """
    Return (n, 3) float64: absolute velocities [m/s, rad/s] within which no body is fast.

    :param dt: of a step [s]
    """
    bounds = np.full((len(columns.solid), 3), np.inf)
    # Of `fast_bodies`.
    speed = columns.safe_depths.min(initial=np.inf) / dt
    bounds[columns.solid, :2] = _COORDINATE * speed
    turning = columns.solid & (columns.turning_radii > 0.0)
    bounds[turning, 2] = _TURNING * speed / columns.turning_radii[turning]
    # Of `fast_in_crowd`, where there is a crowd.
    crowd = columns.pieces * columns.pieces.sum() > MOST_PAIRS
    ways = columns.half_widths[crowd] * np.sqrt(2.0 * MOST_PAIRS / columns.pieces[crowd])
    crowd_speeds = _COORDINATE * ways[:, None] / EXTENSION
    bounds[crowd, :2] = np.minimum(bounds[crowd, :2], crowd_speeds)
    return bounds
