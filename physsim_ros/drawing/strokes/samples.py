# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The samples of a pen: checked, cleaned and completed to the path that was drawn.

Law: cleaning cuts off no part of the drawn line: a stroke that was sampled well loses only samples
that are closer together than `GRAIN`.

Samples close together are replaced by their mean (radial distance simplification), so that a pen
that rests draws no length. A jump is a step much longer than all others. It is drawn: fast pens
make long steps, programs that send strokes omit samples of straight lines, and a touch screen
reports the first move of a finger late, at up to 35 % of the size, as if it had been faster than
all others. Only a jump to one sample and back is a spike. Times put samples in order, no more.
"""

from __future__ import annotations

import math

import numpy as np
from physsim_ros.drawing.geometry import angles, size_of
from physsim_ros.drawing.strokes.resampled import COUNT
from physsim_ros.model.arrays import Floats
from physsim_ros.model.checks import FARTHEST
from physsim_ros.model.errors import BadSize, Malformed
from physsim_ros.model.shapes import SMALLEST
from physsim_ros.model.transform import norms

# Strokes of fewer samples than half of `COUNT` have more put between them, on arcs; the only turn
# of three makes no arc.
_FEWEST_SAMPLES = 4
# The greatest turn at a sample of an arc [rad]: a circle of eight has 0.79, a hexagon 1.05.
_GENTLE = 0.9
# The least distance of two samples that are kept, in shares of the stroke's size: a resting pen
# jitters by some 0.2 % (standard deviation), and no side of a figure is shorter than 4 %.
GRAIN = 0.01
# The least length of a jump, in lengths of the longest other step.
_JUMP = 2.0
# The least number of samples of a stroke with jumps: strokes of fewer are clicks.
_CLICKS = 12


def pen_path(samples: Floats) -> Floats:
    """
    Return the path through the samples of a pen, (k, 2) float64 [m].

    :param samples: (n, 2) float64: x, y [m]; or (n, 3), the third column the time of each, by
        which they are ordered
    :raises Malformed: there are none, or one is not finite
    :raises BadSize: all are at one point, or one is too far away
    """
    path = clean_samples(_checked(samples))
    if size_of(path) < SMALLEST:
        template = 'the stroke is smaller than {least:g} m: a point draws nothing'
        raise BadSize(template, field='poses', least=SMALLEST)
    while _FEWEST_SAMPLES <= len(path) < COUNT // 2:
        path = _subdivided(path)
    return path


def _checked(samples: Floats) -> Floats:
    """Return the positions of the samples of the stroke, in order, (n, 2) float64 [m]."""
    if len(samples) == 0:
        raise Malformed('the stroke has no samples', field='poses')
    places = samples[:, :2]
    if not np.isfinite(places).all():
        raise Malformed('a sample of the stroke is not finite', field='poses')
    if np.abs(places).max() > FARTHEST:
        raise BadSize('the stroke reaches further than {most:g} m', field='poses', most=FARTHEST)
    if samples.shape[1] == 2:
        return places
    return places[np.argsort(samples[:, 2], kind='stable')]


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
