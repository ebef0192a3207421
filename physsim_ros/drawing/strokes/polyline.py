# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Polylines, (n, 2) float64 [m]: resampling, smoothing, stretching, turning angles.

Law: every function returns a fresh array; none changes its arguments.
"""

from __future__ import annotations

import math

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.transform import cross, Point

# Number of points of a resampled stroke: a dozen for each side of a five-pointed star.
COUNT = 128
# The least width of an outline after stretching, in shares of its length, and the greatest factor.
WIDE, WIDEST = 0.3, 10.0


def spaced(path: Floats, count: int) -> Floats:
    """Return points along a polyline at equal distances."""
    x, y = path.T
    length = np.zeros(len(path))
    np.hypot(np.diff(x), np.diff(y)).cumsum(out=length[1:])
    at = np.arange(count) * (length[-1] / (count - 1))
    points = np.empty((count, 2))
    points[:, 0], points[:, 1] = np.interp(at, length, x), np.interp(at, length, y)
    return points


def path_length(path: Floats) -> float:
    """Return the length of a polyline [m]."""
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


def smoothed(points: Floats, width: float, *, closed: bool) -> Floats:
    """Return points smoothed by a Gaussian whose standard deviation is `width` [points]."""
    reach = math.ceil(3 * width)
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / width) ** 2)
    kernel /= kernel.sum()
    if closed:
        first, last = points[-reach:], points[:reach]
    else:
        # Reflected at the ends, so that these do not move.
        first = 2 * points[0] - points[reach:0:-1]
        last = 2 * points[-1] - points[::-1][slice(1, reach + 1)]
    padded = np.vstack((first, points, last))
    return np.column_stack([np.convolve(axis, kernel, 'valid') for axis in padded.T])


def widened(outline: Floats) -> tuple[Floats, Floats]:
    """
    Return a closed polyline stretched across, so that corners at its narrow ends are distinct.

    :return: the polyline, evenly spaced; and the (2, 2) matrix that undoes the stretching
    """
    away = outline - outline.mean(axis=0)
    squares, axes = np.linalg.eigh(away.T @ away)
    aspect = math.sqrt(max(float(squares[0]), 0.0) / float(squares[1]))
    stretch = min(max(WIDE / max(aspect, 1e-6), 1.0), WIDEST)
    # A linear map: straight lines stay straight.
    wide = axes @ np.diag((stretch, 1.0)) @ axes.T
    narrow: Floats = axes @ np.diag((1.0 / stretch, 1.0)) @ axes.T
    path = outline @ wide
    return spaced(np.vstack((path, path[:1])), COUNT + 1)[:-1], narrow


def turns(points: Floats, arm: int, *, closed: bool) -> Floats:
    """
    Return the turning angle of a polyline at each point [rad], over arms of `arm` points.

    Near the ends of an open polyline the arms are shorter; at the ends the angle is 0.
    """
    count = len(points)
    at = np.arange(count)
    reach = np.full(count, arm) if closed else np.minimum(arm, np.minimum(at, count - 1 - at))
    a = points - points[at - reach]
    b = points[(at + reach) % count] - points
    return angles(a, b)


def angles(a: Floats, b: Floats) -> Floats:
    """Return the angles from directions a to directions b [rad], counter-clockwise."""
    result: Floats = np.arctan2(cross(a, b), a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1])
    return result


def point_of(row: Floats) -> Point:
    """Return a row of an array as a point."""
    x, y = row.tolist()
    return x, y
