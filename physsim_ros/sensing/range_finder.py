# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The reading of a range finder: the nearest distance within its cone."""

from __future__ import annotations

import numpy as np
from physsim_ros.model.robots.sensors import RangeFinder
from physsim_ros.sensing.fan import Rays
from physsim_ros.sensing.laser import within_range
from physsim_ros.sensing.mounting import noise_of, placed
from physsim_ros.sensing.surroundings import Surroundings


def read_range(surroundings: Surroundings, row: int, finder: RangeFinder, seed: int) -> float:
    """
    Return the nearest distance that a ray of the cone meets [m].

    Minus infinity is nearer than the least range, or inside another body; infinity is nothing
    within the greatest range (REP 117).

    :param surroundings: of the frame
    :param row: of the robot's body in the scene
    :param finder: on it
    :param seed: of all noise of the world
    """
    snapshot = surroundings.snapshot
    x, y, yaw = placed(snapshot, row, finder)
    count = finder.rays if finder.cone else 1
    half = finder.cone / 2 if count > 1 else 0.0
    angles = np.linspace(yaw - half, yaw + half, count)
    least, greatest = finder.range
    rays = Rays((x, y), np.cos(angles), np.sin(angles))
    nearest = surroundings.nearest(rays, greatest, row).min(keepdims=True)
    noise = noise_of(snapshot, row, finder, seed, 1) if finder.noise else None
    return float(within_range(nearest, least, greatest, finder.noise, noise)[0])
