# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Cleaning of the samples of a pen: rests, spikes, and late first samples.

Law: no part of the drawn line is cut off. A stroke that was sampled well loses only samples that
are closer together than `GRAIN`.

Samples close together are replaced by their mean (radial distance simplification), so that a pen
that rests draws no length. A jump is a step much longer than all others. It may be drawn: fast
pens make long steps, and programs that send strokes omit samples of straight lines.
"""

from __future__ import annotations

import math

import numpy as np
from physsim_ros.drawing.strokes.polyline import size_of
from physsim_ros.model.arrays import Floats
from physsim_ros.model.transform import norms

# The least distance of two samples that are kept, in shares of the stroke's size: a resting pen
# jitters by some 0.2 % (standard deviation), and no side of a figure is shorter than 4 %.
GRAIN = 0.01
# The least length of a jump: in lengths of the longest other step, and in shares of the size.
_JUMP, _FAR = 2.0, 0.15
# The least number of samples of a stroke with jumps: strokes of fewer are clicks.
_FEWEST = 12
# The greatest distance of a first sample from the line that the stroke continues, in shares of the
# size: a touch screen reports a finger late, at up to 35 % of the size. The number of steps that
# give the direction of that line.
_ASTRAY, _AHEAD = 0.3, 3


def clean_samples(samples: Floats) -> Floats:
    """
    Return the positions of a pen without rests and jumps, (k, 2) float64 [m].

    :param samples: (n, 2) float64: in order, finite [m]
    """
    grain = GRAIN * _robust_size(samples)
    merged = _merged(samples, grain)
    kept = _without_jumps(merged)
    # The two parts of a rest that a spike interrupted are one rest again.
    return kept if len(kept) == len(merged) else _merged(kept, grain)


def _robust_size(samples: Floats) -> float:
    """Return the diagonal of the bounding box without the outermost sample on each side [m]."""
    if len(samples) < _FEWEST:
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


def _without_jumps(points: Floats) -> Floats:
    """Return points without spikes, and without ends that belong to another stroke."""
    if len(points) < _FEWEST:
        return points
    size = _robust_size(points)
    steps = norms(np.diff(points, axis=0))
    last = len(steps) - 1
    # A jump at an end is the longest step, the two jumps of a spike are the two longest.
    but_two, but_one = (_JUMP * np.sort(steps)[-3:-1]).tolist()
    kept = np.ones(len(points), np.bool_)
    for at in np.flatnonzero(steps > max(_FAR * size, but_two)).tolist():
        if at < last and steps[at + 1] > _FAR * size:
            # To one point and from it; it is a spike if the pen comes back.
            there = min(float(steps[at]), float(steps[at + 1]))
            back = math.dist(points[at], points[at + 2])
            kept[at + 1] = there <= but_two or back >= 0.5 * there
        elif at == 0:
            kept[0] = steps[0] <= but_one or _goes_on(points, _ASTRAY * size)
        elif at == last and kept[last]:
            kept[-1] = steps[last] <= but_one or _goes_on(points[::-1], _ASTRAY * size)
    return points[kept]


def _goes_on(points: Floats, astray: float) -> bool:
    """
    Return whether the first step of a stroke belongs to it: it has its direction, or closes it.

    :param astray: greatest distance of the first point from the line of the next steps [m]
    """
    first, second, ahead = points[[0, 1, 1 + _AHEAD]]
    step, along = second - first, ahead - second
    along = along * (math.hypot(*step) / max(math.hypot(*along), 1e-300))
    return math.hypot(*(step - along)) <= astray or math.dist(first, points[-1]) <= astray / 2
