# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The lines of ropes past rings and around wheels, of many and at many times at once."""

import math

import numpy as np
from physsim_ros.model.arrays import Floats

# Corners of the line that a rope on a wheel is drawn as.
_ARC = 12


def corner_count(guides: int) -> int:
    """
    Return the count of corners of the line that a rope is drawn as.

    :param guides: count of what it passes between its ends
    """
    return 2 + _ARC * guides


def path_corners(centers: Floats, radii: Floats) -> Floats:
    """
    Return the corners of the lines of ropes, (..., c, 2) float64 [m].

    :param centers: (..., k, 2) float64: as those of `model.rope_path.spans` [m]
    :param radii: (k,) float64, or of ropes that pass as many (r, k) [m]
    """
    apart = np.diff(centers, axis=-2)
    distance = np.maximum(np.hypot(apart[..., 0], apart[..., 1]), 1e-9)
    slant = np.arcsin(np.clip(-np.diff(radii) / distance, -1.0, 1.0))
    heading = np.arctan2(apart[..., 1], apart[..., 0]) + slant
    turn = np.diff(heading, axis=-1)
    turn -= math.tau * np.round(turn / math.tau)
    wheel = radii[..., 1:-1]
    turn += math.tau * np.sign(wheel) * (wheel * turn < 0.0)
    shares = np.linspace(0.0, 1.0, _ARC)
    angles = heading[..., :-1, None] + turn[..., None] * shares
    outward = np.stack((np.sin(angles), -np.cos(angles)), axis=-1)
    arcs = centers[..., 1:-1, None, :] + wheel[..., None, None] * outward
    arcs = arcs.reshape(*centers.shape[:-2], -1, 2)
    path: Floats = np.concatenate((centers[..., :1, :], arcs, centers[..., -1:, :]), axis=-2)
    return path
