# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Readings of distances, by the conventions of REP 117: laser scans, and range finders.

The beams start at the sensor; pieces of its own body are not seen, sensors neither.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.robots.sensors import Laser, RangeFinder
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import rotated_each
from physsim_ros.sensing.mounting import noise_of, placed
from physsim_ros.sensing.surroundings import Surroundings


def read_laser(surroundings: Surroundings, row: int, laser: Laser) -> Floats:
    """
    Return (beams,) float64: the range of each beam [m].

    Minus infinity is nearer than the least range, or inside another body; infinity is nothing
    within the greatest range.

    :param surroundings: of the frame
    :param row: of the robot's body in the scene
    :param laser: on it
    """
    snapshot = surroundings.snapshot
    *origin, yaw = placed(snapshot, row, laser)
    directions = rotated_each(_beams(laser.beams, laser.angle[0], laser.increment), yaw)
    least, greatest = laser.range
    ranges = surroundings.nearest((origin[0], origin[1]), directions, greatest, row)
    noise = noise_of(snapshot, row, laser, laser.beams) if laser.noise else None
    return within_range(ranges, least, greatest, laser.noise, noise)


def scan_points(snapshot: Snapshot, row: int, laser: Laser, ranges: Floats) -> Floats:
    """
    Return (beams + 1, 2) float64: the laser, then where each beam ends, in the world [m].

    That is at the greatest range for nothing, and at the laser for what is too close.

    :param snapshot: of the world
    :param row: of the robot's body in the scene
    :param laser: on it
    :param ranges: (beams,) float64: that it reads [m]
    """
    x, y, yaw = placed(snapshot, row, laser)
    points = np.zeros((laser.beams + 1, 2))
    points[1:] = rotated_each(_beams(laser.beams, laser.angle[0], laser.increment), yaw)
    points[1:] *= np.clip(ranges, 0.0, laser.range[1])[:, None]
    points += np.array((x, y))
    return points


def within_range(
    distances: Floats, least: float, greatest: float, deviation: float, noise: Floats | None
) -> Floats:
    """
    Return distances with noise, and with infinities out of range (REP 117).

    :param distances: (k,) float64 [m]
    :param deviation: standard deviation of the noise [m]
    :param noise: (k,) float64: of mean 0 and variance 1; None is no noise
    """
    measured = distances if noise is None else distances + deviation * noise
    measured = np.where((distances > greatest) | (measured > greatest), np.inf, measured)
    return np.where((distances < least) | (measured < least), -np.inf, measured)


@lru_cache(maxsize=256)
def _beams(count: int, first: float, increment: float) -> Floats:
    """Return (count, 2) float64: unit vectors of beams at equal angles, in the sensor's frame."""
    angles = first + increment * np.arange(count)
    return np.column_stack((np.cos(angles), np.sin(angles)))


def read_range(surroundings: Surroundings, row: int, finder: RangeFinder) -> float:
    """
    Return the nearest distance that a ray of the cone meets [m].

    Minus infinity is nearer than the least range, or inside another body; infinity is nothing
    within the greatest range (REP 117).

    :param surroundings: of the frame
    :param row: of the robot's body in the scene
    :param finder: on it
    """
    snapshot = surroundings.snapshot
    x, y, yaw = placed(snapshot, row, finder)
    count = finder.rays if finder.cone else 1
    half = finder.cone / 2 if count > 1 else 0.0
    angles = np.linspace(yaw - half, yaw + half, count)
    directions = np.column_stack((np.cos(angles), np.sin(angles)))
    least, greatest = finder.range
    nearest = surroundings.nearest((x, y), directions, greatest, row).min(keepdims=True)
    noise = noise_of(snapshot, row, finder, 1) if finder.noise else None
    return float(within_range(nearest, least, greatest, finder.noise, noise)[0])
