# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Cleaning of the samples of a pen: rests, spikes and late first samples.

Law: nothing that was drawn is cut off. A stroke that was sampled well loses nothing but samples
closer together than `GRAIN`.

Samples close together are replaced by their mean (radial distance simplification), so that a pen
that rests draws no length. A jump is a step much longer than all others: pens hurry, and what
sends their strokes leaves samples out, on straight lines most of all.
"""

from __future__ import annotations

import math

import numpy as np
from physsim_ros.drawing.strokes.plane import norms
from physsim_ros.drawing.strokes.polyline import size_of
from physsim_ros.model.arrays import Floats

# The distance at which samples are distinct, in shares of the stroke's size: a pen that rests
# jitters by some 0.2 % (standard deviation), and no side of a figure is shorter than 4 %.
GRAIN = 0.01
# The least step that is a jump, in longest other steps and in shares of the size.
_JUMP, _FAR = 2.0, 0.15
# The least number of samples of a stroke with jumps: those of fewer are clicks.
_FEWEST = 12
# The greatest distance of a first sample from where the stroke comes from, in shares of the size:
# a touch screen reports a finger late, at up to 35 % of the size. The number of steps by which
# the direction there is known.
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
    """Return the means of successive points within `grain` of the first of them."""
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
    """Return points without single ones to which the pen jumps, and from there back or on."""
    if len(points) < _FEWEST:
        return points
    size = _robust_size(points)
    steps = norms(np.diff(points, axis=0))
    # A jump at an end is the longest step, those of a spike are the two longest.
    but_two, but_one = (_JUMP * np.sort(steps)[-3:-1]).tolist()
    kept = np.ones(len(points), np.bool_)
    for at in np.flatnonzero(steps > max(_FAR * size, but_two)).tolist():
        if at + 1 < len(steps) and steps[at + 1] > _FAR * size:
            back = math.dist(points[at], points[at + 2])
            there = min(float(steps[at]), float(steps[at + 1]))
            kept[at + 1] = there <= but_two or back >= 0.5 * there
        elif at in {0, len(steps) - 1} and kept[at]:
            # The pen came from its last stroke, or went on to its next.
            path = points if at == 0 else points[::-1]
            kept[at and at + 1] = steps[at] <= but_one or _goes_on(path, _ASTRAY * size)
    return points[kept]


def _goes_on(points: Floats, astray: float) -> bool:
    """Return whether a stroke comes from its first point, no farther off [m], or ends near it."""
    first, second, ahead = points[[0, 1, 1 + _AHEAD]]
    step, along = second - first, ahead - second
    along = along * (math.hypot(*step) / max(math.hypot(*along), 1e-300))
    return math.hypot(*(step - along)) <= astray or math.dist(first, points[-1]) <= astray / 2
