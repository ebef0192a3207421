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
What fits points best: a straight line, a rectangle, a curve of few points.

Law: a fit says nothing about whether it is a good one; whoever asks measures that.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
from physsim_ros.drawing.strokes.polyline import COUNT, smoothed, spaced
from physsim_ros.model.arrays import Floats

# How far straight sides may be from an open way, root mean square, before it counts as a curve;
# and how far the points of a curve are. Both in shares of its size.
CURVED, FINE = 0.013, 0.006
# Smoothing of what is traced [points].
SMOOTHING = 1.2


def line(points: Floats) -> tuple[Floats, Floats, float]:
    """Return the straight line nearest to points: its middle, its direction, how far off [m]."""
    middle = points.mean(axis=0)
    away = points - middle
    (xx, xy), (_, yy) = (away.T @ away).tolist()
    angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
    least = (xx + yy) / 2 - math.hypot((xx - yy) / 2, xy)
    direction = np.array((math.cos(angle), math.sin(angle)))
    return middle, direction, math.sqrt(max(least, 0.0) / len(points))


def rectangle(corners: Floats) -> Floats:
    """Return the rectangle that is nearest to four corners, in their order."""
    middle = corners.mean(axis=0)
    sides = np.roll(corners, -1, axis=0) - corners
    # Four times its angle is the same for all sides of a rectangle; the long ones count most.
    quadruple = (sides[:, 0] + 1j * sides[:, 1]) ** 4
    quadruple /= np.maximum(np.abs(quadruple), 1e-300) ** 0.5
    angle = float(np.angle(quadruple.sum())) / 4
    axes = np.array(((math.cos(angle), math.sin(angle)), (-math.sin(angle), math.cos(angle))))
    local = (corners - middle) @ axes.T
    signs = np.where(local >= 0, 1.0, -1.0)
    nearest: Floats = middle + (signs * np.abs(local).mean(axis=0)) @ axes
    return nearest


def simplified(points: Floats, bends: Floats) -> Floats | None:
    """
    Return a curve as few enough points, or None where straight sides explain it.

    :param points: (n, 2) float64: of an open way, evenly spaced
    :param bends: (n, 2) float64: ends and bends of the sides
    """
    size = float(np.hypot(*np.ptp(points, axis=0)))
    way = smoothed(points, SMOOTHING, closed=False)
    off = np.min([_off(way, *side) for side in itertools.pairwise(bends)], axis=0)
    if math.sqrt(float((off**2).mean())) <= CURVED * size:
        return None
    return _traced(way, FINE * size)


def traced(outline: Floats) -> Floats:
    """Return a closed way as few enough points."""
    way = spaced(np.vstack((outline, outline[:1])), COUNT + 1)[:-1]
    way = smoothed(way, SMOOTHING, closed=True)
    size = float(np.hypot(*np.ptp(way, axis=0)))
    # From one of the points that lie farthest out.
    way = np.roll(way, -int(((way - way.mean(axis=0)) ** 2).sum(axis=1).argmax()), axis=0)
    return _traced(np.vstack((way, way[:1])), FINE * size)[:-1]


def _traced(way: Floats, tolerance: float) -> Floats:
    """Keep the points without which a way would be too far off: Ramer, Douglas and Peucker."""
    kept, parts = {0, len(way) - 1}, [(0, len(way) - 1)]
    while parts:
        first, last = parts.pop()
        off = _off(way[slice(first, last + 1)], way[first], way[last])
        furthest = first + int(off.argmax())
        if off.max() > tolerance:
            kept.add(furthest)
            parts += [(first, furthest), (furthest, last)]
    return way[sorted(kept)]


def _off(points: Floats, start: Floats, end: Floats) -> Floats:
    """Return how far points lie from a segment [m]."""
    along = end - start
    share = np.clip((points - start) @ along / max(float(along @ along), 1e-300), 0.0, 1.0)
    away = points - start - share[:, None] * along
    result: Floats = np.hypot(away[:, 0], away[:, 1])
    return result
