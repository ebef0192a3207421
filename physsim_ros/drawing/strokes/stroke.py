# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A stroke: the path of a pen evenly spaced, without hooks, and closed to an outline.

Law: the result does not depend on the number and spacing of the samples. A square that is sampled
at 200 Hz is the same as one that is sampled at 20 Hz.
"""

from __future__ import annotations

from dataclasses import dataclass
import math

import numpy as np
from physsim_ros.drawing.geometry import angles, path_length, size_of, spaced
from physsim_ros.drawing.strokes.resampled import ARM, COUNT
from physsim_ros.drawing.strokes.samples import pen_path
from physsim_ros.model.arrays import Floats
from physsim_ros.model.transform import dots, norms

# Factor of the finer resampling, for the ends of narrow outlines, and its number of points.
_FINER = 4
_FINELY = _FINER * (COUNT - 1) + 1
# The greatest length of a hook, in shares of the stroke's size; the least turn at which the pen
# turns back, as at a hook and at the tip of an arrow [rad].
HOOK, SHARP = 0.1, 1.2
# The least number of rounds of an outline that was drawn more than once, and the greatest mean
# distance of the other rounds from one, in shares of the size: that of a five-pointed star is 0.1.
ROUNDS, AGAIN = 1.25, 0.065
# The greatest overlap that is cut off at either end of a closed stroke, in shares of its length.
_OVERLAP = 0.14


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Stroke:
    """
    A stroke of evenly spaced points.

    :param points: (COUNT, 2) float64: the stroke without hooks [m]
    :param outline: (4 (COUNT - 1), 2) float64: the stroke closed, overlapping ends cut off, the
        first point not repeated [m]
    :param gap: between the ends, in shares of the length
    :param relatability: how well both ends go on across the gap, -2 .. 2: the cosines of the two
        angles between them and the gap (Kellman and Shipley, 1991); an arc of a circle has nearly
        2, the two ends of a U have 0
    :param size: diagonal of its bounding box [m]
    :param length: arc length [m]
    """

    points: Floats
    outline: Floats
    gap: float
    relatability: float
    size: float
    length: float


def resample_stroke(samples: Floats) -> Stroke:
    """
    Return the stroke through the samples of a pen.

    :param samples: (n, 2) float64: x, y [m]; or (n, 3), the third column the time of each, by
        which they are ordered
    :raises Malformed: there are none, or one is not finite
    :raises BadSize: all are at one point, or one is too far away
    """
    path = spaced(_without_hooks(spaced(pen_path(samples), _FINELY)), _FINELY)
    points = path[::_FINER]
    first, last = _repeated_round(points) or _seam(points)
    length = path_length(points)
    gap = math.dist(points[last], points[first]) / (length * (last - first) / (COUNT - 1))
    once = path[slice(_FINER * first, _FINER * last + 1)]
    return Stroke(
        points=points,
        outline=spaced(np.vstack((once, once[:1])), _FINELY)[:-1],
        gap=gap,
        relatability=_relatability(points, first, last),
        size=size_of(points),
        length=length,
    )


def _without_hooks(path: Floats) -> Floats:
    """Return a stroke without the short sharp turns at its ends that a moving pen leaves."""
    points = path[::_FINER]
    x, y = points.T
    size = math.hypot(float(np.ptp(x)), float(np.ptp(y)))
    reach = int(HOOK * size / float(np.hypot(np.diff(x), np.diff(y)).mean()))
    if reach < 2:
        return path
    first, last = _hook(points, reach), len(points) - 1 - _hook(points[::-1], reach)
    kept = slice(_FINER * first, _FINER * last + 1)
    return path[kept] if last - first > len(points) // 2 else path


def _hook(points: Floats, reach: int) -> int:
    """Return the number of points of a hook at the beginning, at most `reach`."""
    at = np.arange(1, reach + 1)
    a = points[at] - points[0]
    b = points[at + np.maximum(at, 4)] - points[at]
    turn = np.abs(angles(a, b))
    sharpest = int(turn.argmax())
    # A turn that is sharpest at the last point belongs to something longer than a hook.
    return sharpest + 1 if turn[sharpest] > SHARP and sharpest < reach - 1 else 0


def _relatability(points: Floats, first: int, last: int) -> float:
    """Return how well a stroke goes on from its last point across the gap to its first one."""
    gap = points[first] - points[last]
    before = points[last] - points[last - ARM]
    after = points[first + ARM] - points[first]
    lengths = norms(np.stack((before, after))) * max(math.hypot(*gap), 1e-300)
    return float((dots(np.stack((before, after)), gap) / np.maximum(lengths, 1e-300)).sum())


def _seam(points: Floats) -> tuple[int, int]:
    """
    Return the first and the last point of an outline whose ends overlap by `_OVERLAP`.

    Ends overlap where they cross or run in the same direction; those of a plank that lacks a part
    of one side run against each other.
    """
    count = len(points)
    step = float(norms(np.diff(points, axis=0)).mean())
    ends = int(_OVERLAP * count)
    head, tail = points[:ends], points[-ends:]
    gaps = norms(head[:, None] - tail[None])
    # Number of points before a point of the head and after a point of the tail.
    cut = np.arange(ends)[:, None] + np.arange(ends)[None, ::-1]
    onward = points[ARM:][:ends] - head
    until = tail - points[:-ARM][-ends:]
    overlap = (dots(onward[:, None], until[None]) > 0.0) | (gaps < step) | (cut == 0)
    # A length that is cut off costs as much as a gap of half of it.
    best = int(np.where(overlap, gaps + step * cut / 2, np.inf).argmin())
    first, last = divmod(best, ends)
    return first, count - ends + last


def _repeated_round(points: Floats) -> tuple[int, int] | None:
    """Return the first and the last point of one round of an outline drawn more than once."""
    count = len(points)
    away = points - points.mean(axis=0)
    rounds = abs(float(angles(away[:-1], away[1:]).sum())) / (2 * math.pi)
    if rounds < ROUNDS:
        return None
    usual = (count - 1) / rounds
    lengths = np.arange(int(0.75 * usual), min(int(1.25 * usual), count - 1))
    firsts = np.arange(count)[:, None]
    lasts = np.minimum(firsts + lengths, count - 1)
    gaps = norms(points[lasts] - points[firsts])
    gaps[firsts + lengths > count - 1] = np.inf
    first, length = divmod(int(gaps.argmin()), len(lengths))
    last = first + int(lengths[length])
    # An outline is drawn again if the rest of the stroke lies along it; a star is not.
    kept, rest = points[first:last], np.vstack((points[:first], points[last:]))
    off = norms(rest[:, None] - kept[None]).min(axis=1)
    again = float(off.mean()) < AGAIN * size_of(points)
    return (first, last) if again else None
