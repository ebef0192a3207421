# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
An outline that is cut from one point to another.

A chord between two points where the cut crosses the outline splits it in two. This works for
outlines that are not convex, whose pieces clipping by a half plane (Sutherland and Hodgman, 1974)
would leave connected by edges of no width.
"""

from __future__ import annotations

from collections.abc import Iterator
import math

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.transform import cross, dots

# Distance of a corner from the line below which it lies on the line [m]; `distinct_points` takes
# points as near as that for one.
ON_LINE = 1e-6


def cut_outline(outline: Floats, start: Floats, end: Floats) -> list[Floats]:
    """
    Return the pieces of a simple outline that is cut from one point to another.

    :param outline: (n, 2) float64: the vertices in order, in either orientation
    :param start: (2,) float64: of the cut, outside
    :param end: (2,) float64: of it, outside
    :return: (m, 2) float64 each; none where the cut does not pass through
    """
    sides, length = across(outline, start, end), math.dist(start, end)
    points: list[Floats] = []
    # Crossings of the line and the edges: distances from the start, and numbers in `points`.
    crossings: list[tuple[float, int]] = []
    for corner, (here, after) in enumerate(zip(sides, np.roll(sides, -1), strict=True)):
        points.append(outline[corner])
        if (here >= 0.0) != (after >= 0.0):
            following = outline[(corner + 1) % len(outline)]
            point = outline[corner] + (following - outline[corner]) * (here / (here - after))
            crossings.append((float(dots(point - start, end - start)) / length, len(points)))
            points.append(point)
    crossings.sort()
    partners: dict[int, int] = {}
    # From the first crossing to the second the line is within, and so on.
    for (first, a), (second, b) in zip(crossings[::2], crossings[1::2], strict=True):
        if first >= 0.0 and second <= length:
            partners |= {a: b, b: a}
    return [np.array([points[each] for each in walk]) for walk in _walks(len(points), partners)]


def _walks(count: int, partners: dict[int, int]) -> Iterator[list[int]]:
    """
    Yield the numbers of the points of each piece: along the outline, and over each chord met.

    :param count: of the points of the outline
    :param partners: the two ends of each chord
    """
    left = set(partners)
    while left:
        first = at = min(left)
        walk = []
        while True:
            left.discard(at)
            walk.append(at)
            at = (at + 1) % count
            while at not in partners:
                walk.append(at)
                at = (at + 1) % count
            walk.append(at)
            at = partners[at]
            if at == first:
                break
        yield walk


def across(points: Floats, start: Floats, end: Floats) -> Floats:
    """Return the distances of points to the left of a line [m]; 0 for those on it."""
    along = (end - start) / math.dist(start, end)
    away = cross(np.broadcast_to(along, points.shape), points - start)
    away[np.abs(away) < ON_LINE] = 0.0
    return away
