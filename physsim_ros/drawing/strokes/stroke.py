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
A stroke as geometry: evenly spaced, without hooks, closed or open.

Law: the samples' own spacing and number have no say. A click has no speed, and a mouse that is
read 200 times a second draws the same square as one that is read 20 times.
"""

from __future__ import annotations

from dataclasses import dataclass
import math

import numpy as np
from physsim_ros.drawing.strokes.polyline import angles, COUNT, spaced
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import BadSize, Malformed
from physsim_ros.model.requests import FARTHEST
from physsim_ros.model.shapes import SMALLEST

# Where more points are needed, for the ends of something narrow: so many times more.
FINER = 4
FINELY = FINER * (COUNT - 1) + 1
# A hook is no longer than this share of the stroke's size, and turns by more than that [rad].
HOOK, HOOK_TURN = 0.1, 1.2
# What may be cut off a closed stroke at either end, where it was drawn twice, in shares of its
# length; and the gap there from which on it is not worth asking whether it is closed.
TWICE, GAP = 0.14, 0.18
# How much of a way has to be cut off to be worth a gap of one metre.
KEEPING = 0.6


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Stroke:
    """
    A stroke, evenly spaced.

    :param points: (COUNT, 2) float64: the whole way, hooks cut off [m]
    :param outline: (FINELY - 1, 2) float64: the way closed, the first point not repeated, what
        was drawn twice cut off [m]; None where the ends lie far apart
    :param gap: between the ends, in shares of the length
    :param size: diagonal of the rectangle around it [m]
    :param length: of its way [m]
    """

    points: Floats
    outline: Floats | None
    gap: float
    size: float
    length: float


def stroke(samples: Floats) -> Stroke:
    """
    Make a stroke of a pen's samples.

    :param samples: (n, 2) float64: x, y [m]; or (n, 3), the third column the time of each, which
        puts them in order
    :raises Malformed: there are none, or one is not finite
    :raises BadSize: all are in one place, or one is too far away
    """
    way = spaced(_without_hooks(spaced(_checked(samples), FINELY)), FINELY)
    points = way[::FINER]
    outline, gap = _outline(points, way)
    return Stroke(
        points=points,
        outline=outline,
        gap=gap,
        size=float(np.hypot(*np.ptp(points, axis=0))),
        length=float(np.hypot(*np.diff(points, axis=0).T).sum()),
    )


def _checked(samples: Floats) -> Floats:
    """Return the samples' places, those that repeat the one before left out."""
    if len(samples) == 0:
        raise Malformed('the stroke has no samples', field='poses')
    if samples.shape[1] > 2 and (np.diff(samples[:, 2]) < 0.0).any():
        # They came in another order than the pen went.
        samples = samples[np.argsort(samples[:, 2], kind='stable')]
    places = samples[:, :2]
    if not np.isfinite(places).all():
        raise Malformed('a sample of the stroke is not finite', field='poses')
    if np.abs(places).max() > FARTHEST:
        raise BadSize(f'the stroke reaches further than {FARTHEST:g} m', field='poses')
    if np.hypot(*np.ptp(places, axis=0)) < SMALLEST:
        raise BadSize(
            f'the stroke is smaller than {SMALLEST:g} m: a point draws nothing', field='poses'
        )
    return places


def _without_hooks(way: Floats) -> Floats:
    """Cut off the flicks of a pen that was set down before it rested, or lifted late."""
    points = way[::FINER]
    x, y = points.T
    size = math.hypot(float(np.ptp(x)), float(np.ptp(y)))
    reach = int(HOOK * size / float(np.hypot(np.diff(x), np.diff(y)).mean()))
    if reach < 2:
        return way
    first, last = _hook(points, reach), len(points) - 1 - _hook(points[::-1], reach)
    kept = slice(FINER * first, FINER * last + 1)
    return way[kept] if last - first > len(points) // 2 else way


def _hook(points: Floats, reach: int) -> int:
    """Return how many points at the beginning, of so many at most, are a hook."""
    at = np.arange(1, reach + 1)
    a = points[at] - points[0]
    b = points[at + np.maximum(at, 4)] - points[at]
    turn = np.abs(angles(a, b))
    sharpest = int(turn.argmax())
    # Where it still gets sharper at the end, what turns is longer than a hook.
    return sharpest + 1 if turn[sharpest] > HOOK_TURN and sharpest < reach - 1 else 0


def _outline(points: Floats, way: Floats) -> tuple[Floats | None, float]:
    """
    Return the closed way that a stroke makes, if it makes one, and the gap in it.

    :param points: evenly spaced
    :param way: the same, with more points
    """
    count = len(points)
    step = float(np.hypot(*np.diff(points, axis=0).T).mean())
    ends = int(TWICE * count)
    head, tail = points[:ends], points[-ends:]
    apart = np.hypot(*(head[:, None] - tail[None]).transpose(2, 0, 1))
    # Points that are cut off before a place of the head, and after one of the tail.
    cut = np.arange(ends)[:, None] + np.arange(ends)[None, ::-1]
    best = int((apart + KEEPING * step * cut).argmin())
    first, last = divmod(best, ends)
    gap = float(apart[first, last]) / (step * (count - 1))
    if gap > GAP:
        return None, gap
    once = way[slice(FINER * first, FINER * (count - ends + last) + 1)]
    return spaced(np.vstack((once, once[:1])), FINELY)[:-1], gap
