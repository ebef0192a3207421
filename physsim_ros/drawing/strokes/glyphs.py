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
Signs: zigzag, scribble, x and arrow, told by how a stroke goes to and fro and crosses itself.

Law: a sign is known by what it is made of, not by a picture of it, so that turned, stretched and
backwards it is the same.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
import itertools
import math

import numpy as np
from physsim_ros.drawing.strokes.fitting import line
from physsim_ros.drawing.strokes.hypothesis import Candidate, falls, LEAST, Primitive, rises
from physsim_ros.drawing.strokes.polyline import COUNT
from physsim_ros.drawing.strokes.stroke import Stroke
from physsim_ros.model.arrays import Floats
from physsim_ros.model.transform import cross

# Directions in which swings to and fro are looked for.
_ANGLES = np.arange(12) * math.pi / 12
_DIRECTIONS = np.column_stack((np.cos(_ANGLES), np.sin(_ANGLES)))
# Points that do not count where it is asked how far a stroke reaches.
FRINGE = 4
# Fewer swings are not measured.
FEWEST = 3
# Every so manieth point is looked at for crossings.
_EVERY = 3
# Which pairs of steps between them may cross, the earlier first: not neighbours, nor their
# neighbours.
_STEPS = len(range(0, COUNT, _EVERY)) - 1
_PAIRS = np.triu(np.ones((_STEPS, _STEPS), np.bool_), 3)
# Crossings as near as that are one [points].
_ONE = 12
# No arrow's ends come so near to each other, in shares of its length.
CLOSED = 0.1

# Where a way crosses itself [m], and after how many points it is there, first and last.
Crossing = tuple[Floats, float, float]


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Swings:
    """
    How a stroke goes to and fro.

    :param count: of swings
    :param height: of a swing, across the advance, mean [m]; 0 where they are few, as what follows
    :param advance: over all swings, in heights of one
    :param steady: how straight the advance is, 0 .. 1
    """

    count: int
    height: float
    advance: float
    steady: float


def swings_of(points: Floats) -> Swings:
    """Return how a way goes to and fro, in the direction in which it does so most often."""
    # A row for each direction: numpy sorts and sums those twice as fast as columns.
    across = _DIRECTIONS @ points.T
    ordered = np.partition(across, (FRINGE, len(points) - 1 - FRINGE), axis=1)
    # The outermost points may be slips.
    low, high = ordered[:, FRINGE, None], ordered[:, -1 - FRINGE, None]
    extent = np.maximum(high - low, 1e-12)
    place = (across - low) / extent
    side = np.where(place > 0.64, 1, np.where(place < 0.36, -1, 0))
    # Between the sides it belongs to the one that it was on last.
    since = np.maximum.accumulate(np.where(side != 0, np.arange(len(points)), 0), axis=1)
    side = np.take_along_axis(side, since, axis=1)
    changes = side[:, 1:] * side[:, :-1] < 0
    counts = changes.sum(axis=1)
    # Of directions in which it swings as often, that in which it does so least far.
    best = int((counts - extent[:, 0] / extent.max() / 2).argmax())
    if counts[best] < FEWEST:
        return Swings(count=int(counts[best]), height=0.0, advance=0.0, steady=0.0)
    bounds = [0, *(np.flatnonzero(changes[best]) + 1).tolist(), len(points)]
    out = place[best] * side[best]
    peaks = [a + int(out[a:b].argmax()) for a, b in itertools.pairwise(bounds)]
    strides = np.diff(points[peaks], axis=0)
    # Two swings are one to and one fro; what remains of them is advance.
    advances = strides[1:] + strides[:-1]
    way = advances.sum(axis=0)
    whole, steps = float(np.hypot(*way)), float(np.hypot(*advances.T).sum())
    height = float(np.abs(cross(strides, way / max(whole, 1e-12))).mean())
    return Swings(
        count=len(strides),
        height=height,
        advance=whole / 2 / len(advances) * len(strides) / max(height, 1e-12),
        steady=whole / max(steps, 1e-12),
    )


def crossings_of(points: Floats) -> list[Crossing]:
    """Return where a way crosses itself; crossings next to one another are one."""
    x, y = points[::_EVERY].T
    start_x, start_y, step_x, step_y = x[:-1, None], y[:-1, None], np.diff(x), np.diff(y)
    # Of every pair of steps, how far along each they meet: the first down, the second across.
    away_x, away_y = start_x.T - start_x, start_y.T - start_y
    sine = step_x[:, None] * step_y - step_y[:, None] * step_x
    # Steps along one line do not cross, whatever their rounding says.
    lengths = np.hypot(step_x, step_y)
    near = _PAIRS & (np.abs(sine) > 1e-6 * lengths[:, None] * lengths)
    sine = np.where(near, sine, 1.0)
    one = (away_x * step_y - away_y * step_x) / sine
    other = (away_x * step_y[:, None] - away_y * step_x[:, None]) / sine
    meet = np.argwhere(near & (one >= 0) & (one < 1) & (other >= 0) & (other < 1))
    found: list[Crossing] = []
    for i, j in meet.tolist():
        first, last = i + float(one[i, j]), j + float(other[i, j])
        place = np.array((x[i] + one[i, j] * step_x[i], y[i] + one[i, j] * step_y[i]))
        if all(abs(_EVERY * first - a) + abs(_EVERY * last - b) > _ONE for _, a, b in found):
            found.append((place, _EVERY * first, _EVERY * last))
    return found


def zigzag(stroke: Stroke, swings: Swings) -> Candidate:
    """Return teeth in a row, sharp or round: it advances by more than it is high."""
    weight = (
        rises(swings.count, 4.4, 0.2)
        * rises(swings.advance, 1.75, 0.1)
        * rises(swings.height / stroke.size, 0.06, 0.006)
        * rises(swings.steady, 0.75, 0.05)
    )
    return Candidate(primitive=Primitive.ZIGZAG, weight=weight, points=stroke.points[[0, -1]])


def scribble(stroke: Stroke, swings: Swings) -> Candidate:
    """Return a going to and fro, or round and round, that stays where it is."""
    weight = (
        rises(swings.count, 4.3, 0.25)
        * falls(swings.advance, 1.75, 0.1)
        * rises(stroke.length / stroke.size, 2.5, 0.1)
    )
    return Candidate(primitive=Primitive.SCRIBBLE, weight=weight, points=stroke.points)


def crossed(stroke: Stroke, crossings: list[Crossing]) -> Candidate:
    """Return two straight lines that cross, the way between them along one side."""
    best = Candidate(primitive=Primitive.CROSS, weight=0.0, points=stroke.points[:1])
    count = len(stroke.points) - 1
    for at, first, last in crossings:
        before, loop, after = first / count, (last - first) / count, 1.0 - last / count
        # Each line half as far beyond the crossing as its end lies before it.
        until, since = int(1.5 * first) + 1, int(1.5 * last - 0.5 * count)
        one, other = stroke.points[:until], stroke.points[since:]
        if min(len(one), len(other)) < 5:
            continue
        (_, along, bent), (_, beside, curved) = line(one), line(other)
        weight = (
            rises(min(before, after) / max(before, after), 0.4, 0.05)
            * rises(min(before, after), 0.08, 0.015)
            * rises(loop, 0.4, 0.04)
            * falls(loop, 0.82, 0.02)
            * falls(max(bent, curved) / stroke.size, 0.06, 0.008)
            * rises(abs(float(cross(along, beside))), 0.5, 0.06)
            * falls(len(crossings), 2.5, 0.3)
        )
        if weight > best.weight:
            best = Candidate(primitive=Primitive.CROSS, weight=weight, points=at[None])
    return best


def arrow(stroke: Stroke, swings: Swings) -> Candidate:
    """Return a shaft and a head, whichever was drawn first."""
    calm = falls(swings.count, 4.5, 0.25)
    if calm < LEAST or stroke.gap < CLOSED:
        return Candidate(primitive=Primitive.ARROW, weight=0.0, points=stroke.points[[0, -1]])
    ways = stroke.points, stroke.points[::-1]
    best = max((_arrow_from(way) for way in ways), key=lambda each: each.weight)
    return replace(best, weight=best.weight * calm)


def _arrow_from(points: Floats) -> Candidate:
    """Return an arrow whose tail is the first point."""
    tail = points[0]
    tip = points[int(((points - tail) ** 2).sum(axis=1).argmax())]
    along = tip - tail
    # In shares of its length; the tip lies at (1, 0).
    frame = (points - tail) @ np.column_stack((along, (-along[1], along[0]))) / (along @ along)
    x, y = frame.T
    # The shaft goes on until the pen turns back or aside.
    ahead = x[4:] - x[:-4]
    over = (ahead < 0.55 * np.median(ahead[:40])) & (x[:-4] > 0.4)
    end = int(over.argmax()) if over.any() else len(points) - 1
    head = frame[end:]
    left, right = int(head[:, 1].argmax()), int(head[:, 1].argmin())
    up, down = float(head[left, 1]), -float(head[right, 1])
    path = float(np.hypot(*np.diff(head, axis=0).T).sum())
    weight = (
        falls(float(np.abs(y[:end]).max(initial=0.0)), 0.12, 0.01)
        * rises(min(up, down) / max(up, down, 1e-12), 0.25, 0.03)
        * rises(up + down, 0.09, 0.012)
        * falls(up + down, 0.85, 0.04)
        * rises(float(head[:, 0].min()), 0.47, 0.025)
        * falls(float(max(head[left, 0], head[right, 0])), 0.985, 0.012)
        * falls(float(head[[left, right], 0].max() - head[:, 0].min()), 0.22, 0.02)
        * rises(path, 0.22, 0.02)
        * falls(path, 2.6, 0.12)
    )
    return Candidate(primitive=Primitive.ARROW, weight=weight, points=np.array((tail, tip)))
