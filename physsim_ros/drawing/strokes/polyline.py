# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Polylines, (n, 2) float64 [m]: resampling, smoothing, stretching, turning angles.

Law: every function returns a fresh array, and leaves its arguments as they are.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, partial
import math

import numpy as np
from physsim_ros.drawing.strokes.plane import angles, principal_axis, stretched, unit_vector
from physsim_ros.model.arrays import Floats
from physsim_ros.model.transform import norms, Point

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


def size_of(points: Floats) -> float:
    """Return the diagonal of the bounding box of points [m]."""
    return float(norms(np.ptp(points, axis=0)))


def path_length(path: Floats) -> float:
    """Return the length of a polyline [m]."""
    return float(norms(np.diff(path, axis=0)).sum())


def smoothed(points: Floats, width: float, *, closed: bool) -> Floats:
    """Return points smoothed by a Gaussian whose standard deviation is `width` [points]."""
    kernel = _gaussian(width)
    reach = len(kernel) - 1
    if closed:
        first, last = points[-reach:], points[:reach]
    else:
        # Reflected at the ends, so that these do not move.
        first = 2 * points[0] - points[reach:0:-1]
        last = 2 * points[-1] - points[::-1][slice(1, reach + 1)]
    x, y = np.vstack((first, points, last)).T.copy()
    result = np.empty_like(points)
    result[:, 0], result[:, 1] = _convolved(x, kernel), _convolved(y, kernel)
    return result


@lru_cache(maxsize=8)
def _gaussian(width: float) -> tuple[float, ...]:
    """Return the right half of a Gaussian from its middle on; the sum of both halves is 1."""
    half = [math.exp(-0.5 * (at / width) ** 2) for at in range(math.ceil(3 * width) + 1)]
    total = 2.0 * sum(half) - half[0]
    return tuple(each / total for each in half)


def _convolved(values: Floats, kernel: tuple[float, ...]) -> Floats:
    """Return the convolution of values with a symmetric kernel, where that lies within them."""
    reach = len(kernel) - 1
    count = len(values) - 2 * reach
    result = kernel[0] * values[slice(reach, reach + count)]
    for at in range(1, reach + 1):
        before, after = (
            slice(reach - at, reach - at + count),
            slice(reach + at, reach + at + count),
        )
        result += kernel[at] * (values[before] + values[after])
    return result


def widened(outline: Floats) -> tuple[Floats, Callable[[Floats], Floats]]:
    """
    Return a closed polyline stretched across, so that corners at its narrow ends are distinct.

    :return: the polyline, evenly spaced; and the function that undoes the stretching
    """
    angle, along, across = principal_axis(outline - outline.mean(axis=0))
    factor = min(max(WIDE / max(math.sqrt(across / along), 1e-6), 1.0), WIDEST)
    side = unit_vector(angle + math.pi / 2)
    path = stretched(outline, side, factor)
    narrowed = partial(stretched, along=side, factor=1.0 / factor)
    return spaced(np.vstack((path, path[:1])), COUNT + 1)[:-1], narrowed


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


def point_of(row: Floats) -> Point:
    """Return a row of an array as a point."""
    x, y = row.tolist()
    return x, y
