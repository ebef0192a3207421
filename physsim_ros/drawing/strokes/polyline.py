# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
Ways of a pen as rows of points: how they are spaced, smoothed, and where they turn.

Law: every function returns a way of its own; none changes what it is given.
"""

from __future__ import annotations

import math

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.transform import cross

# Points of an evenly spaced way: a dozen for each side of a star of five points.
COUNT = 128
# Narrow outlines are made at least that wide, in shares of their length, but at most so many
# times wider.
WIDE, WIDEST = 0.3, 10.0


def spaced(way: Floats, count: int) -> Floats:
    """Return points along a way, the same distance apart."""
    x, y = way.T
    length = np.zeros(len(way))
    np.hypot(np.diff(x), np.diff(y)).cumsum(out=length[1:])
    at = np.arange(count) * (length[-1] / (count - 1))
    points = np.empty((count, 2))
    points[:, 0], points[:, 1] = np.interp(at, length, x), np.interp(at, length, y)
    return points


def smoothed(points: Floats, width: float, *, closed: bool) -> Floats:
    """Return points with what is shorter than a few of them taken out."""
    reach = math.ceil(3 * width)
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / width) ** 2)
    kernel /= kernel.sum()
    if closed:
        first, last = points[-reach:], points[:reach]
    else:
        # Mirrored about the ends, which so stay where they are.
        first = 2 * points[0] - points[reach:0:-1]
        last = 2 * points[-1] - points[::-1][slice(1, reach + 1)]
    padded = np.vstack((first, points, last))
    return np.column_stack([np.convolve(axis, kernel, 'valid') for axis in padded.T])


def widened(outline: Floats) -> tuple[Floats, Floats]:
    """
    Return a closed way, made so wide that corners at its narrow ends can be told apart.

    :return: the way, evenly spaced; and the (2, 2) matrix that makes points of it narrow again
    """
    away = outline - outline.mean(axis=0)
    squares, axes = np.linalg.eigh(away.T @ away)
    aspect = math.sqrt(max(float(squares[0]), 0.0) / float(squares[1]))
    stretch = min(max(WIDE / max(aspect, 1e-6), 1.0), WIDEST)
    # Straight lines stay straight.
    wide = axes @ np.diag((stretch, 1.0)) @ axes.T
    narrow: Floats = axes @ np.diag((1.0 / stretch, 1.0)) @ axes.T
    way = outline @ wide
    return spaced(np.vstack((way, way[:1])), COUNT + 1)[:-1], narrow


def turns(points: Floats, arm: int, *, closed: bool) -> Floats:
    """
    Return by how much the way turns at each point, seen over arms of some points [rad].

    Towards the ends of an open way the arms get shorter; the ends themselves do not turn.
    """
    count = len(points)
    at = np.arange(count)
    reach = np.full(count, arm) if closed else np.minimum(arm, np.minimum(at, count - 1 - at))
    a = points - points[at - reach]
    b = points[(at + reach) % count] - points
    return angles(a, b)


def angles(a: Floats, b: Floats) -> Floats:
    """Return by how much one direction turns into another [rad], counter-clockwise."""
    result: Floats = np.arctan2(cross(a, b), a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1])
    return result
