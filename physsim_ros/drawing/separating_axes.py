# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Convex polygons that overlap or touch, by the theorem of separating axes.

Of two convex polygons that lie apart, a side of one has all of the other beyond it (Gottschalk,
Lin and Manocha, 1996).
"""

from __future__ import annotations

import numpy as np
from physsim_ros.model.arrays import Flags, Floats, Ints
from physsim_ros.model.shapes import signed_area
from physsim_ros.model.transform import next_vertices, norms

# The greatest gap between parts that touch, in shares of the smaller one's size: discs that touch
# do so as polygons.
_TOUCHING = 0.02
# Pairs of parts that are compared at once.
_AT_ONCE = 1000


def touching(polygons: list[Floats]) -> Flags:
    """Return which convex polygons overlap or touch, by separating axes, (n, n) bool."""
    low, high = (np.array([f(each, axis=0) for each in polygons]) for f in (np.min, np.max))
    size = norms(high - low)
    slack = _TOUCHING * np.minimum(size[:, None], size)
    gap = np.maximum(low[:, None] - high[None], low[None] - high[:, None]).max(axis=2)
    found: Flags = gap <= slack
    outward = [_outward(each) for each in polygons]
    most = max(map(len, polygons))
    # Of those with fewer, the last corner is repeated.
    corners, normals = (
        np.array([np.pad(each, ((0, most - len(each)), (0, 0)), 'edge') for each in rows])
        for rows in (polygons, outward)
    )
    one, other = np.nonzero(np.triu(found, 1))
    for at in range(0, len(one), _AT_ONCE):
        part = slice(at, at + _AT_ONCE)
        a, b = one[part], other[part]
        apart = np.maximum(_gaps(corners, normals, a, b), _gaps(corners, normals, b, a))
        found[a, b] = found[b, a] = apart <= slack[a, b]
    return found


def _outward(polygon: Floats) -> Floats:
    """Return the normals of the sides of a convex polygon, (n, 2) float64."""
    edges = next_vertices(polygon) - polygon
    outward = np.column_stack((edges[:, 1], -edges[:, 0])) * np.sign(signed_area(polygon))
    normals: Floats = outward / np.maximum(norms(edges), 1e-300)[:, None]
    return normals


def _gaps(corners: Floats, normals: Floats, a: Ints, b: Ints) -> Floats:
    """Return the greatest distance of each polygon b from a side of its a, (p,) float64 [m]."""
    (nx, ny), (x, y) = (np.moveaxis(each[a], 2, 0) for each in (normals, corners))
    of_b = np.moveaxis(corners[b], 2, 0)[:, :, None, :]
    away = (nx[:, :, None] * of_b[0] + ny[:, :, None] * of_b[1]).min(axis=2)
    gaps: Floats = (away - (nx * x + ny * y)).max(axis=1)
    return gaps
