# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Cleaning of the samples of a pen: rests, spikes and late first samples.

Law: a stroke that was sampled well loses nothing but samples closer together than `GRAIN`.

Samples close together are replaced by their mean (radial distance simplification), so that a pen
that rests draws no length. Jumps are found as by the Hampel filter (Hampel, 1974): a step is
compared with the median of the steps around it, not of the whole stroke, since pens hurry.
"""

from __future__ import annotations

import math

import numpy as np
from physsim_ros.model.arrays import Floats

# The distance at which samples are distinct, in shares of the stroke's size: a pen that rests
# jitters by some 0.2 % (standard deviation), and no side of a figure is shorter than 4 %.
GRAIN = 0.01
# The least step that is a jump, in medians of the steps around it and in shares of the size. A
# barb drawn with one sample at its end is 5 steps of the shaft long.
_JUMP, _FAR = 5.0, 0.15
# The number of steps on either side whose median a step is compared with.
_AROUND = 4
# The least number of samples of a stroke with jumps: those of fewer are clicks.
_FEWEST = 12


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
        return float(np.hypot(*np.ptp(samples, axis=0)))
    inner = np.partition(samples, (1, len(samples) - 2), axis=0)
    return float(np.hypot(*(inner[-2] - inner[1])))


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
    steps = np.hypot(*np.diff(points, axis=0).T)
    kept = np.ones(len(points), np.bool_)
    for at in np.flatnonzero(steps > _FAR * size).tolist():
        around = slice(max(at - _AROUND, 0), at + 2 + _AROUND)
        if at + 1 < len(steps) and steps[at + 1] > _FAR * size:
            # The two steps of a spike are not among those that they are compared with.
            usual = float(np.median(np.sort(steps[around])[:-2]))
            back = math.dist(points[at], points[at + 2])
            there = min(float(steps[at]), float(steps[at + 1]))
            kept[at + 1] = there <= _JUMP * usual or back >= 0.5 * there
        elif at in {0, len(steps) - 1} and kept[at]:
            # The pen came from its last stroke, or went on to its next.
            usual = float(np.median(np.sort(steps[around])[:-1]))
            kept[at and at + 1] = steps[at] <= _JUMP * usual
    return points[kept]
