# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Overlap of a stroke with bodies: those that a scribble covers, and those that it only crosses.

Law: a body that the stroke only crosses is not covered.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.strokes.snapping import End
from physsim_ros.model.arrays import Floats
from physsim_ros.model.transform import norms

# Stride of the points that are tested: 43 of a stroke, 8 to 10 of each swing of a scribble.
_STRIDE = 3
# Name of a body -> which of these points lie on it, (43,) bool.
Crossed = dict[str, NDArray[np.bool_]]
# The least share of the stroke on a body that is covered.
COVERING = 0.3
# Of a body with a smaller share, whose centroid lies in the bounding box of the stroke: its
# greatest outer radius, in diagonals of that box, and the least number of entries of the stroke.
AS_LARGE, LEAST_ENTRIES = 0.75, 2


def covered_bodies(points: Floats, crossed: Crossed, scene: SceneQuery) -> tuple[str, ...]:
    """
    Return the names of the bodies that a stroke covers, in spawn order.

    :param points: (n, 2) float64: of the stroke [m]
    :param crossed: the bodies that it crosses, by `crossed_bodies`
    """
    low, high = points.min(axis=0), points.max(axis=0)
    reach = AS_LARGE * float(norms(high - low))
    covered = set()
    for name, hits in crossed.items():
        form = scene.body(name).shape.form
        middle = scene.in_world(name, form.centroid)
        within = bool(((middle >= low) & (middle <= high)).all()) and form.outer <= reach
        if hits.mean() >= COVERING or (within and _entries(hits) >= LEAST_ENTRIES):
            covered.add(name)
    if not covered and crossed:
        # Of a scribble across a long wall, only little of either lies on the other.
        most = max(crossed, key=lambda name: _entries(crossed[name]))
        if _entries(crossed[most]) >= LEAST_ENTRIES:
            covered.add(most)
    return tuple(name for name in scene.names if name in covered)


def _entries(hits: NDArray[np.bool_]) -> int:
    """Return how many times a stroke enters a body."""
    return int(np.count_nonzero(hits[1:] & ~hits[:-1]) + hits[0])


def share_on(crossed: Crossed, ends: Iterable[End]) -> float:
    """Return the share of a stroke that lies on the bodies at its ends, 0 .. 1."""
    hits = [crossed[end.body] for end in ends if end.body in crossed]
    return float(np.any(hits, axis=0).mean()) if hits else 0.0


def middle_share_on(crossed: Crossed, ends: Iterable[End]) -> float:
    """Return the share of the middle half of a stroke on the bodies at its ends, 0 .. 1."""
    middle = {
        name: hits[slice(len(hits) // 4, len(hits) - len(hits) // 4)]
        for name, hits in crossed.items()
    }
    return share_on(middle, ends)


def crossed_bodies(points: Floats, scene: SceneQuery) -> Crossed:
    """Return the bodies that a stroke crosses, each with the points that lie on it."""
    low, high = points.min(axis=0), points.max(axis=0)
    x, y = ((low + high) / 2).tolist()
    reach = float(norms(high - low)) / 2
    crossed: Crossed = {}
    for name in scene.bodies_at((x, y), reach):
        hits = scene.covers(name, points[::_STRIDE])
        if hits.any():
            crossed[name] = hits
    return crossed
