# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Resampled strokes: polylines of evenly spaced points, (n, 2) float64 [m], smoothed and measured.

Laws: those of `geometry`: the same bits on every processor, and arguments stay as they are.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
import math
from typing import TypeVar

import numpy as np
from physsim_ros.drawing.geometry import (
    angles,
    Crossing,
    path_length,
    principal_axis,
    spaced,
    stretched,
    unit_vector,
)
from physsim_ros.model.arrays import Flags, Floats
from physsim_ros.model.transform import cross

# Rows of an array: points, or flags of points.
_Rows = TypeVar('_Rows', Floats, Flags)
# Number of points of a resampled stroke: a dozen for each side of a five-pointed star.
COUNT = 128
# Number of points that give the direction of a stroke at a place, and the arms of a turn there.
ARM = 5
# Stride of the points between which strokes are compared: 1.6 % of the length.
_FEW = 2
# Standard deviation of the Gaussian that smooths a resampled stroke [points]: the steps of a mouse
# that draws a figure of 25 pixels are two points long.
_SMOOTHING = 1.5
# The least width of an outline after stretching, in shares of its length.
_WIDE = 0.3


def few_points(stroke: Floats) -> Floats:
    """Return the points of a resampled stroke between which distances are taken."""
    return stroke[::_FEW]


def middle_half(points: _Rows) -> _Rows:
    """Return the rows from the first to the last quarter."""
    return points[slice(len(points) // 4, len(points) - len(points) // 4)]


def smoothed(points: Floats, *, closed: bool) -> Floats:
    """Return the points of a resampled stroke smoothed by a Gaussian."""
    reach = len(_GAUSSIAN) - 1
    if closed:
        first, last = points[-reach:], points[:reach]
    else:
        # Reflected at the ends, so that these do not move.
        first = 2 * points[0] - points[reach:0:-1]
        last = 2 * points[-1] - points[::-1][slice(1, reach + 1)]
    x, y = np.vstack((first, points, last)).T.copy()
    result = np.empty_like(points)
    result[:, 0], result[:, 1] = _convolved(x, _GAUSSIAN), _convolved(y, _GAUSSIAN)
    return result


def straightness(points: Floats) -> float:
    """Return the distance of the ends of a resampled stroke by its length without tremor."""
    return math.dist(points[0], points[-1]) / path_length(smoothed(points, closed=False))


def _gaussian(width: float) -> tuple[float, ...]:
    """Return the right half of a Gaussian from its middle on; the sum of both halves is 1."""
    half = [math.exp(-0.5 * (at / width) ** 2) for at in range(math.ceil(3 * width) + 1)]
    total = 2.0 * sum(half) - half[0]
    return tuple(each / total for each in half)


_GAUSSIAN = _gaussian(_SMOOTHING)


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
    factor = max(_WIDE / max(math.sqrt(across / along), 1e-6), 1.0)
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


def loop_roundness(points: Floats, crossing: Crossing) -> float:
    """Return the area within the loop from a self-crossing to itself, by its length squared."""
    at, first, last = crossing
    loop = np.vstack((at, points[slice(int(first) + 1, int(last) + 1)], at))
    area = abs(float(cross(loop[:-1] - at, loop[1:] - at).sum())) / 2
    return area / path_length(loop) ** 2
