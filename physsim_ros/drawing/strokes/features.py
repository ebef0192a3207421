# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Features of a stroke that several forms are recognised by: its bends, swings and self-crossings.

Law: a sign is recognised by its structure, not by a template; rotated, stretched and drawn
backwards it is the same sign.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
import itertools
import math

import numpy as np
from physsim_ros.drawing.geometry import Crossing, intersections, path_length
from physsim_ros.drawing.strokes.corner_detection import bends_of
from physsim_ros.drawing.strokes.evidence import Limit
from physsim_ros.drawing.strokes.resampled import ARM, COUNT, smoothed, turns
from physsim_ros.drawing.strokes.stroke import Stroke
from physsim_ros.model.arrays import Floats
from physsim_ros.model.transform import cross, norms

# Directions in which swings are counted.
_ANGLES = np.arange(12) * math.pi / 12
_DIRECTIONS = np.column_stack((np.cos(_ANGLES), np.sin(_ANGLES)))
# Number of outermost points at either side that the extent of a stroke leaves out.
_FRINGE = 4
# The least count of swings whose height and advance are measured.
FEWEST_SWINGS = 3
# The height of swings that are those of a trembling hand, or of a mouse that moves by pixels, in
# shares of the size; what swings higher is drawn so.
TREMOR = Limit(0.08)
# The advance of all swings, and of one, between those of scribbles and zigzags, in mean heights.
_FAR_APART, _WIDE_TOOTH = 1.75, 0.23
# Stride of the points between which crossings are searched.
_STRIDE = 3
# Pairs of segments between those points that may cross, the earlier first: not a segment and its
# neighbours, nor theirs.
_SEGMENTS = len(range(0, COUNT, _STRIDE)) - 1
_PAIRS = np.triu(np.ones((_SEGMENTS, _SEGMENTS), np.bool_), 3)
# Crossings at most this far from one another along the stroke are merged [points].
_MERGED = 12


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Swings:
    """
    The oscillation of a stroke in the direction in which it turns back most often.

    :param count: of swings
    :param height: mean height of a swing, across the advance [m]; 0 where they are fewer than
        `FEWEST_SWINGS`, as are the other figures
    :param spread: how far apart they lie: above 1 those of a zigzag, below those of a scribble
    :param steady: straightness of the advance, 0 .. 1
    """

    count: int
    height: float
    spread: float
    steady: float


@dataclass(frozen=True, kw_only=True, eq=False)
class Features:
    """
    A stroke with its features.

    :param stroke: the stroke
    :param path: (COUNT, 2) float64: the stroke without the tremor of the hand [m]
    :param swings: its oscillation
    :param crossings: the places at which it crosses itself
    :param measures: of the whole stroke, by name: evidence for and against every sign
    """

    stroke: Stroke
    path: Floats
    swings: Swings
    crossings: list[Crossing]
    measures: Mapping[str, float]

    @cached_property
    def bends(self) -> Floats:
        """Return ends and bends of the stroke as an open line, (k, 2) float64 [m]."""
        return bends_of(self.stroke.points, self.path)

    @property
    def has_teeth(self) -> bool:
        """Return whether its swings are higher than a hand trembles."""
        return self.swings.height > TREMOR.at * self.stroke.size


def features_of(stroke: Stroke) -> Features:
    """Return the features of a stroke."""
    points = stroke.points
    swings, crossings = swings_of(points), crossings_of(points)
    path = smoothed(points, closed=False)
    turn = np.abs(turns(path, ARM, closed=False))
    measures = {
        'gap': stroke.gap,
        'chord': float(norms(points[-1] - points[0])) / stroke.size,
        'length': path_length(path) / stroke.size,
        'swings': float(swings.count),
        'spread': swings.spread,
        'height': swings.height / stroke.size,
        'steady': swings.steady,
        'crossings': float(len(crossings)),
        'sharpest': float(turn.max()),
        'turning': float(turn.mean()),
    }
    return Features(
        stroke=stroke, path=path, swings=swings, crossings=crossings, measures=measures
    )


def swings_of(points: Floats) -> Swings:
    """Return the oscillation of a polyline, in the direction in which it turns back most often."""
    # A row for each direction: numpy sorts and sums those twice as fast as columns.
    x, y = points.T
    across = _DIRECTIONS[:, :1] * x + _DIRECTIONS[:, 1:] * y
    ordered = np.partition(across, (_FRINGE, len(points) - 1 - _FRINGE), axis=1)
    # The outermost points may be drawn by mistake.
    low, high = ordered[:, _FRINGE, None], ordered[:, -1 - _FRINGE, None]
    extent = np.maximum(high - low, 1e-12)
    place = (across - low) / extent
    side = np.where(place > 0.64, 1, np.where(place < 0.36, -1, 0))
    # A point between the sides counts to the side of the point before it (hysteresis).
    since = np.maximum.accumulate(np.where(side != 0, np.arange(len(points)), 0), axis=1)
    side = np.take_along_axis(side, since, axis=1)
    changes = side[:, 1:] * side[:, :-1] < 0
    counts = changes.sum(axis=1)
    # Among directions with as many swings, the one with the smallest extent.
    best = int((counts - extent[:, 0] / extent.max() / 2).argmax())
    if counts[best] < FEWEST_SWINGS:
        return Swings(count=int(counts[best]), height=0.0, spread=0.0, steady=0.0)
    bounds = [0, *(np.flatnonzero(changes[best]) + 1).tolist(), len(points)]
    out = place[best] * side[best]
    peaks = [a + int(out[a:b].argmax()) for a, b in itertools.pairwise(bounds)]
    strides = np.diff(points[peaks], axis=0)
    # The sum of two swings in opposite directions is advance.
    advances = strides[1:] + strides[:-1]
    total = advances.sum(axis=0)
    whole, steps = float(norms(total)), float(norms(advances).sum())
    height = float(np.abs(cross(strides, total / max(whole, 1e-12))).mean())
    # In mean heights. A scribble of many swings may go far, if each lies close to the one before.
    advance = whole / 2 / len(advances) * len(strides) / max(height, 1e-12)
    return Swings(
        count=len(strides),
        height=height,
        spread=min(advance / _FAR_APART, advance / len(strides) / _WIDE_TOOTH),
        steady=whole / max(steps, 1e-12),
    )


def crossings_of(points: Floats) -> list[Crossing]:
    """Return the self-crossings of a polyline; neighbouring ones are merged."""
    few = points[::_STRIDE]
    found: list[Crossing] = []
    for place, i, j in intersections(few, few, pairs=_PAIRS):
        first, last = _STRIDE * i, _STRIDE * j
        if all(abs(first - a) + abs(last - b) > _MERGED for _, a, b in found):
            found.append((place, first, last))
    return found
