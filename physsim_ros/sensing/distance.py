# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Readings of distances, by the conventions of REP 117: scans, range finders; and of landmarks.

The beams start at the sensor; pieces of its own body are not seen, sensors neither.
"""

from __future__ import annotations

from functools import lru_cache
import math

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats
from physsim_ros.model.robots.sensors import Landmarks, Laser, RangeFinder
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import Point, rotated_each
from physsim_ros.sensing.mounting import placed
from physsim_ros.sensing.sampling import noise_of
from physsim_ros.sensing.surroundings import Surroundings

# Tolerance within which an angle at the end of a sector lies in it [rad]: more than rounding.
_ROUNDING = 1e-9


def read_laser(surroundings: Surroundings, row: int, laser: Laser) -> Floats:
    """
    Return (beams,) float64: the range of each beam [m].

    Minus infinity is nearer than the least range, or inside another body; infinity is nothing
    within the greatest range; NaN is a beam of a blind sector.

    :param surroundings: of the frame
    :param row: of the robot's body in the scene
    :param laser: on it
    """
    snapshot = surroundings.snapshot
    *origin, yaw = placed(snapshot, row, laser)
    directions = rotated_each(_beams(laser.beams, laser.angle[0], laser.increment), yaw)
    least, greatest = laser.range
    ranges = surroundings.nearest((origin[0], origin[1]), directions, greatest, row)
    errors = _errors(snapshot, row, laser, laser.beams)
    measured = within_range(ranges, least, greatest, errors)
    if laser.blind:
        measured[_blind(laser.beams, laser.angle[0], laser.increment, laser.blind)] = np.nan
    return measured


def scan_points(snapshot: Snapshot, row: int, laser: Laser, ranges: Floats) -> Floats:
    """
    Return (beams + 1, 2) float64: the laser, then where each beam ends, in the world [m].

    That is at the greatest range for nothing, and at the laser for what is too close or hidden.

    :param snapshot: of the world
    :param row: of the robot's body in the scene
    :param laser: on it
    :param ranges: (beams,) float64: that it reads [m]
    """
    x, y, yaw = placed(snapshot, row, laser)
    points = np.zeros((laser.beams + 1, 2))
    points[1:] = rotated_each(_beams(laser.beams, laser.angle[0], laser.increment), yaw)
    shown = np.where(np.isnan(ranges), 0.0, ranges)
    points[1:] *= np.clip(shown, 0.0, laser.range[1])[:, None]
    points += np.array((x, y))
    return points


def _errors(snapshot: Snapshot, row: int, sensor: Laser | RangeFinder, count: int) -> Floats:
    """Return (count,) float64: the errors of distances [m]."""
    if not sensor.noise:
        return np.zeros(count)
    return sensor.noise * noise_of(snapshot, row, sensor, count)


def within_range(distances: Floats, least: float, greatest: float, errors: Floats) -> Floats:
    """
    Return distances with errors, and with infinities out of range (REP 117).

    :param distances: (k,) float64 [m]
    :param errors: (k,) float64 [m]
    """
    measured = distances + errors
    nearest, farthest = np.minimum(distances, measured), np.maximum(distances, measured)
    measured = np.where(farthest > greatest, np.inf, measured)
    return np.where(nearest < least, -np.inf, measured)


@lru_cache(maxsize=256)
def _beams(count: int, first: float, increment: float) -> Floats:
    """Return (count, 2) float64: unit vectors of beams at equal angles, in the sensor's frame."""
    angles = first + increment * np.arange(count)
    return np.column_stack((np.cos(angles), np.sin(angles)))


@lru_cache(maxsize=256)
def _blind(
    count: int, first: float, increment: float, sectors: tuple[Point, ...]
) -> NDArray[np.bool_]:
    """Return (count,) bool: whether a beam is in one of the sectors."""
    beams = first + increment * np.arange(count, dtype=np.float64)
    hidden = np.zeros(count, np.bool_)
    for sector in sectors:
        hidden |= _is_between(beams, sector)
    return hidden


def _is_between(angles: Floats, ends: Point) -> NDArray[np.bool_]:
    """
    Return (k,) bool: whether angles are in a sector, whole turns aside.

    :param angles: (k,) float64 [rad]
    :param ends: least and greatest angle of the sector, at most a turn apart [rad]
    """
    low, high = ends
    within: NDArray[np.bool_] = np.mod(angles - low + _ROUNDING, math.tau) <= (
        high - low + 2 * _ROUNDING
    )
    return within


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
    errors = _errors(snapshot, row, finder, 1)
    return float(within_range(nearest, least, greatest, errors)[0])


def read_landmarks(surroundings: Surroundings, row: int, finder: Landmarks) -> Floats:
    """
    Return (k, 2) float64: range [m] and bearing [rad] of each landmark; NaN of one that is unseen.

    The bearing is counter-clockwise from the axis of the sensor, -π .. π.

    :param surroundings: of the frame
    :param row: of the robot's body in the scene
    :param finder: on it
    """
    snapshot = surroundings.snapshot
    scene = snapshot.scene
    readings = np.full((len(finder.bodies), 2), np.nan)
    known = [place for place, name in enumerate(finder.bodies) if scene.row_of.get(name, -1) >= 0]
    if not known:
        return readings
    rows = np.array([scene.row_of[finder.bodies[place]] for place in known])
    x, y, yaw = placed(snapshot, row, finder)
    away = snapshot.poses[rows, :2] - (x, y)
    ranges = np.hypot(*away.T)
    # NumPy's `arctan2` has other bits with AVX-512.
    headings = np.array([math.atan2(dy, dx) for dx, dy in away.tolist()])
    bearings = np.remainder(headings - yaw + math.pi, math.tau) - math.pi
    # The core casts rays counter-clockwise.
    order = np.argsort(bearings)
    sight = yaw + bearings[order]
    met = np.empty(len(rows))
    met[order] = surroundings.nearest(
        (x, y), np.column_stack((np.cos(sight), np.sin(sight))), finder.range[1], row
    )
    # Within this distance of its origin is all of a body.
    extents = scene.outer_radii[rows] + np.hypot(
        *(snapshot.poses[rows, :2] - snapshot.centers[rows]).T
    )
    seen = (met >= ranges - extents - _ROUNDING) & _is_between(bearings, finder.angle)
    seen &= (ranges >= finder.range[0]) & (ranges <= finder.range[1])
    measured = np.column_stack((ranges, bearings))
    if any(finder.noise):
        noise = noise_of(snapshot, row, finder, 2 * len(finder.bodies)).reshape(-1, 2)
        measured += noise[known] * finder.noise
    readings[np.array(known)[seen]] = measured[seen]
    return readings
