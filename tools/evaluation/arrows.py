# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Arrows as people draw them: in one stroke, or a shaft and a head.

Barbs are 0.15 to 0.9 of the shaft long, 0.4 of it in the middle, and those of a head that is a
stroke of its own longer. Of four arrows one has a head of more than half its length.
"""

from __future__ import annotations

import math

import numpy as np

from .figures import Figure, turned, turned_about_origin
from .outlines import Floats, Random

# The median length of barbs, and the least and greatest, in shares of the shaft; the standard
# deviation of its logarithm.
_BARB, _SHORTEST, _LONGEST, _SPREAD = 0.4, 0.15, 0.9, 0.3
# The median length of barbs of a head that is a stroke of its own.
_BARB_APART = 0.5
# The median length of the barbs of a round arrow, in shares of the radius.
_BARB_ROUND = 0.5


def arrow(rng: Random) -> Figure:
    """Return an arrow in one stroke: a shaft, often bowed, and a head, in any order."""
    tip, tail = np.array([0.5, 0.0]), np.array([-0.5, rng.normal(0.0, 0.03)])
    bow = rng.normal(0.0, 0.07) if rng.random() < 0.5 else 0.0
    share = np.linspace(0.0, 1.0, 12, endpoint=False)
    shaft = tail + share[:, None] * (tip - tail)
    shaft[:, 1] += 4.0 * bow * share * (1.0 - share)
    # About the end of the shaft as it is bowed.
    barbs = _barbs(rng, _BARB)
    one, other = tip + _along(bow, barbs if rng.random() < 0.5 else barbs[::-1])
    # The pen comes back beside the tip, by as much as the head is large.
    beside = 0.03 + 0.05 * max(float(np.hypot(*(barbs.mean(axis=0)))) - 0.25, 0.0)
    again = tip + rng.normal(0.0, beside, 2)
    neck = tip + _along(bow, barbs.mean(axis=0) * (1.0, 0.0))
    heads = (
        # Each barb drawn to and fro, the first one or both.
        (tip, one, again, other),
        (tip, one, again, other),
        (tip, one, again, other, tip + rng.normal(0.0, beside, 2)),
        # The head closed.
        (tip, one, other),
        (tip, one, other, again),
        (neck, one, tip, other, neck + rng.normal(0.0, 0.02, 2)),
    )
    head = heads[rng.integers(len(heads))]
    head_first = rng.random() < 0.15
    if head_first:
        path = np.vstack((one, tip, other, again, shaft[::-1]))
    else:
        path = np.vstack((shaft, head))
    path = turned(path, rng.uniform(0, 7))
    return Figure(kind='arrow', path=path, tail=-1 if head_first else 0)


def round_arrow(rng: Random) -> Figure:
    """Return an arc about an axle in its middle, and a head."""
    sweep = rng.uniform(1.9, 5.6)
    angle = np.linspace(-sweep / 2, sweep / 2, 40)
    flat = rng.uniform(0.85, 1.0)
    arc = 0.5 * np.column_stack((np.cos(angle), flat * np.sin(angle)))
    tip, along = arc[-1], arc[-1] - arc[-4]
    # The head turned a little inwards, as the arc is.
    heading = math.atan2(along[1], along[0]) + 0.15 + rng.normal(0.0, 0.1)
    barbs = 0.5 * turned_about_origin(_barbs(rng, _BARB_ROUND), heading)
    one, other = tip + (barbs if rng.random() < 0.5 else barbs[::-1])
    heads = (one, tip + rng.normal(0.0, 0.02, 2), other), (one, other), (one, other, tip)
    path = np.vstack((arc, heads[rng.integers(len(heads))]))
    path = path * (1.0, rng.choice([-1.0, 1.0]))
    # About the axle, and not about the middle of its extent.
    return Figure(kind='round arrow', path=turned_about_origin(path, rng.uniform(0, 7)))


def shaft_and_head(rng: Random) -> list[Floats]:
    """Return a shaft, often bowed, that ends short of its head or beyond it, and the head."""
    gap = rng.uniform(0.03, 0.2) if rng.random() < 0.6 else rng.uniform(-0.1, 0.03)
    tip = np.array((0.5, 0.0)) + rng.normal(0.0, 0.02, 2)
    bow = rng.normal(0.0, 0.07) if rng.random() < 0.5 else 0.0
    share = np.linspace(0.0, 1.0, 12)
    x, y = (1.0 - gap) * share - 0.5, share * rng.normal(0.0, 0.02)
    shaft = np.column_stack((x, y + 4.0 * bow * share * (1.0 - share)))
    one, other = tip + _along(bow, _barbs(rng, _BARB_APART))
    return [shaft, np.array((one, tip, other))]


def _barbs(rng: Random, median: float) -> Floats:
    """Return the ends of both barbs of a straight arrow, (2, 2) float64, from its tip."""
    length = median * math.exp(rng.normal(0.0, _SPREAD))
    # Long barbs lie nearer to the shaft.
    opening = rng.uniform(0.35, 0.85) * min(1.0, (0.5 / length) ** 0.4)
    barbs = np.array(
        [(-math.cos(opening), math.sin(opening)), (-math.cos(opening), -math.sin(opening))]
    )
    lengths = length * rng.uniform(0.75, 1.25, (2, 1))
    angles = rng.normal(0.0, 0.12, 2)
    barbs = np.array([turned_about_origin(*pair) for pair in zip(barbs, angles, strict=True)])
    return np.asarray(barbs * np.clip(lengths, _SHORTEST, _LONGEST))


def _along(bow: float, barbs: Floats) -> Floats:
    """Return the barbs of a straight arrow, (..., 2), turned for a shaft that is bowed."""
    # The slope of a parabola at its end. Some of it the hand does not follow.
    return turned_about_origin(barbs, -0.7 * math.atan(4.0 * bow))
