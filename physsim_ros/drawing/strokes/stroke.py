# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A stroke: the samples of a pen cleaned, evenly spaced, without hooks, and closed to an outline.

Laws: the result does not depend on the number and spacing of the samples. A square that is sampled
at 200 Hz is the same as one that is sampled at 20 Hz. Cleaning cuts off no part of the drawn line:
a stroke that was sampled well loses only samples that are closer together than `GRAIN`.

Samples close together are replaced by their mean (radial distance simplification), so that a pen
that rests draws no length. A jump is a step much longer than all others. It is drawn: fast pens
make long steps, programs that send strokes omit samples of straight lines, and a touch screen
reports the first move of a finger late, at up to 35 % of the size, as if it had been faster than
all others. Only a jump to one sample and back is a spike. Times put samples in order, no more.
"""

from __future__ import annotations

from dataclasses import dataclass
import math

import numpy as np
from physsim_ros.drawing.geometry import angles, path_length, size_of, spaced
from physsim_ros.drawing.strokes.resampled import ARM, COUNT
from physsim_ros.model.arrays import Floats
from physsim_ros.model.checks import FARTHEST
from physsim_ros.model.errors import BadSize, Malformed
from physsim_ros.model.shapes import SMALLEST
from physsim_ros.model.transform import dots, norms

# Factor of the finer resampling, for the ends of narrow outlines, and its number of points.
_FINER = 4
_FINELY = _FINER * (COUNT - 1) + 1
# Strokes of fewer samples than half of `COUNT` have more put between them, on arcs; the only turn
# of three makes no arc.
_FEWEST = 4
# The greatest turn at a sample of an arc [rad]: a circle of eight has 0.79, a hexagon 1.05.
_GENTLE = 0.9
# The greatest length of a hook, in shares of the stroke's size; the least turn at which the pen
# turns back, as at a hook and at the tip of an arrow [rad].
HOOK, SHARP = 0.1, 1.2
# The least number of rounds of an outline that was drawn more than once, and the greatest mean
# distance of the other rounds from one, in shares of the size: that of a five-pointed star is 0.1.
ROUNDS, AGAIN = 1.25, 0.065
# The greatest overlap that is cut off at either end of a closed stroke, in shares of its length.
_OVERLAP = 0.14
# The least distance of two samples that are kept, in shares of the stroke's size: a resting pen
# jitters by some 0.2 % (standard deviation), and no side of a figure is shorter than 4 %.
GRAIN = 0.01
# The least length of a jump, in lengths of the longest other step.
_JUMP = 2.0
# The least number of samples of a stroke with jumps: strokes of fewer are clicks.
_CLICKS = 12


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
    cleaned = clean_samples(_checked(samples))
    if size_of(cleaned) < SMALLEST:
        raise BadSize(
            f'the stroke is smaller than {SMALLEST:g} m: a point draws nothing', field='poses'
        )
    while _FEWEST <= len(cleaned) < COUNT // 2:
        cleaned = _subdivided(cleaned)
    path = spaced(_without_hooks(spaced(cleaned, _FINELY)), _FINELY)
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


def _checked(samples: Floats) -> Floats:
    """Return the positions of the samples of the stroke, in order, (n, 2) float64 [m]."""
    if len(samples) == 0:
        raise Malformed('the stroke has no samples', field='poses')
    places = samples[:, :2]
    if not np.isfinite(places).all():
        raise Malformed('a sample of the stroke is not finite', field='poses')
    if np.abs(places).max() > FARTHEST:
        raise BadSize(f'the stroke reaches further than {FARTHEST:g} m', field='poses')
    if samples.shape[1] == 2:
        return places
    return places[np.argsort(samples[:, 2], kind='stable')]


def _subdivided(samples: Floats) -> Floats:
    """
    Return samples with one more between each two, on the arc through them.

    The arc between two samples turns by the harmonic mean of the turns there, and by 0 where these
    differ in sign or one is a corner (PPH subdivision scheme; Amat, Donat, Liandrat and Trillo,
    2006). Straight sides stay straight.
    """
    steps = np.diff(samples, axis=0)
    turn = np.zeros(len(samples))
    turn[1:-1] = angles(steps[:-1], steps[1:])
    turn[np.abs(turn) > _GENTLE] = 0.0
    if norms(samples[-1] - samples[0]) <= norms(steps).max():
        # A closed curve goes on at its ends.
        turn[0], turn[-1] = turn[1], turn[-2]
    before, after = turn[:-1], turn[1:]
    product = np.maximum(before * after, 0.0)
    mean = 2.0 * product / np.where(product > 0.0, before + after, 1.0)
    # The height of an arc is an eighth of its chord times its turn; of a step longer than both
    # beside it, as a side between two round corners, only a part as long as these turns.
    lengths = norms(steps)
    around = np.concatenate((lengths[-1:], lengths, lengths[:1]))
    bent = np.minimum(np.maximum(around[:-2], around[2:]) / lengths, 1.0)
    aside = np.column_stack((steps[:, 1], -steps[:, 0])) * (mean * bent / 8)[:, None]
    finer = np.empty((2 * len(samples) - 1, 2))
    finer[::2], finer[1::2] = samples, samples[:-1] + steps / 2 + aside
    return finer


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


def clean_samples(samples: Floats) -> Floats:
    """
    Return the positions of a pen without rests and jumps, (k, 2) float64 [m].

    :param samples: (n, 2) float64: in order, finite [m]
    """
    grain = GRAIN * _robust_size(samples)
    merged = _merged(samples, grain)
    kept = _without_spikes(merged)
    # The two parts of a rest that a spike interrupted are one rest again.
    return kept if len(kept) == len(merged) else _merged(kept, grain)


def _robust_size(samples: Floats) -> float:
    """Return the diagonal of the bounding box without the outermost sample on each side [m]."""
    if len(samples) < _CLICKS:
        return size_of(samples)
    inner = np.partition(samples, (1, len(samples) - 2), axis=0)
    return float(norms(inner[-2] - inner[1]))


def _merged(points: Floats, grain: float) -> Floats:
    """Return the means of runs of points that lie within `grain` of the first of the run [m]."""
    firsts, (x0, y0) = [0], points[0].tolist()
    for row, (x, y) in enumerate(points.tolist()):
        if math.hypot(x - x0, y - y0) > grain:
            firsts.append(row)
            x0, y0 = x, y
    if len(firsts) == len(points):
        return points
    counts = np.diff([*firsts, len(points)])
    means: Floats = np.add.reduceat(points, firsts, axis=0) / counts[:, None]
    return means


def _without_spikes(points: Floats) -> Floats:
    """Return points without spikes: without those to which the pen jumps, and from them back."""
    if len(points) < _CLICKS:
        return points
    steps = norms(np.diff(points, axis=0))
    # The two jumps of a spike are the two longest steps.
    usual = _JUMP * float(np.partition(steps, -3)[-3])
    there = np.minimum(steps[:-1], steps[1:])
    back = norms(points[2:] - points[:-2])
    kept = np.ones(len(points), np.bool_)
    kept[1:-1] = (there <= usual) | (back >= there / 2)
    return points[kept]
