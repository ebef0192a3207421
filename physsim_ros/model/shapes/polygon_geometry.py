# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Tests and measures of polygons: area, convexity, self-intersection.

A polygon is its vertices in order, (n, 2) float64 [m]; the last one is joined to the first.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.transform import cross, next_vertices


def signed_area(polygon: Floats) -> float:
    """Return the area of a polygon [m²], positive where it runs counter-clockwise."""
    # Relative to one of its vertices, so that coordinates far from the origin lose no digits.
    vertices = polygon - polygon[0]
    return float(cross(vertices, next_vertices(vertices)).sum()) / 2


def unsigned_fan_area(polygon: Floats) -> float:
    """Return the sum of the unsigned areas of the triangles of a fan at the first vertex [m²]."""
    vertices = polygon - polygon[0]
    return float(np.abs(cross(vertices, next_vertices(vertices))).sum()) / 2


def is_convex(polygon: Floats) -> bool:
    """Tell whether a simple polygon that runs counter-clockwise has no reflex vertex."""
    edges = next_vertices(polygon) - polygon
    return bool((cross(edges, next_vertices(edges)) >= 0).all())


def crosses_itself(polygon: Floats) -> bool:
    """Tell whether a polygon is not simple: two edges meet elsewhere than in a common vertex."""
    start, end = polygon, next_vertices(polygon)
    edge = end - start
    following = next_vertices(edge)
    folded = (cross(edge, following) == 0) & ((edge * following).sum(axis=1) < 0)
    if folded.any():
        return True
    # The bounding boxes of most pairs of edges are disjoint.
    low, high = np.minimum(start, end), np.maximum(start, end)
    near = np.triu(np.ones((len(polygon), len(polygon)), dtype=np.bool_), 2)
    near[0, -1] = False
    for axis in (0, 1):
        near &= low[:, None, axis] <= high[None, :, axis]
        near &= low[None, :, axis] <= high[:, None, axis]
    first, second = np.nonzero(near)
    a, b, c, d = start[first], end[first], start[second], end[second]
    side_c, side_d = cross(b - a, c - a), cross(b - a, d - a)
    side_a, side_b = cross(d - c, a - c), cross(d - c, b - c)
    return bool(((side_c * side_d <= 0) & (side_a * side_b <= 0)).any())
