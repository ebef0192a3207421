# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Strangers: hands of another mechanism than the others, with which nothing was chosen.

The pen follows its path as a critically damped mass on a spring, so that speed cuts corners. Every
corner is missed a little, every straight side is an arc of its own, and the hand wanders as a
first-order autoregressive process. Arrows of strangers have proportions of their own.
"""

from __future__ import annotations

from dataclasses import replace
import itertools
import math

import numpy as np

from .figures import Figure, turned, turned_about_origin
from .hand import Hand
from .outlines import Floats, Random

# The time constant of the wandering of a hand [s].
_MEMORY = 0.15
# Turns that are corners [rad], points of a side that is an arc, steps of the time of a lag [s].
_CORNER, _SIDE, _STEP = 0.5, 24, 0.002


def stranger(somebody: Hand, care: float, rng: Random) -> Hand:
    """Return a hand that has the screen of somebody, and habits of its own."""
    return replace(
        somebody,
        rate=float(rng.choice([50.0, 60.0, 90.0, 120.0])),
        uneven=rng.uniform(0.0, 0.3),
        drift=0.0,
        tremor=care * rng.exponential(0.0015),
        noise=rng.exponential(0.001),
        rounding=0.0,
        bow=0.0,
        hook_down=care * (rng.uniform(0.01, 0.06) if rng.random() < 0.12 else 0.0),
        hook_up=care * (rng.uniform(0.01, 0.06) if rng.random() < 0.18 else 0.0),
        slip=care * rng.exponential(0.02),
        slowing=rng.uniform(0.3, 0.8),
        unsteady=rng.uniform(0.0, 0.3),
        slant=care * rng.normal(0.0, 0.05),
        lag=rng.uniform(0.012, 0.035),
        missed=care * rng.gamma(2.0, 0.006),
        arc=care * rng.exponential(0.018),
        wander=care * rng.exponential(0.005),
    )


def sketched(path: Floats, figure: Figure, somebody: Hand, rng: Random) -> Floats:
    """Return the path of a stranger: each corner missed, each straight side an arc."""
    if figure.smooth:
        return path
    steps = np.diff(path, axis=0)
    heading = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    sharp = 1 + np.flatnonzero(np.abs(np.diff(heading)) > _CORNER)
    corners = [0, *sharp.tolist(), len(path) - 1]
    off = rng.normal(0.0, somebody.missed, (len(corners), 2))
    parts = []
    for number, (first, last) in enumerate(itertools.pairwise(corners)):
        rows = np.linspace(first, last, _SIDE, endpoint=False)
        side = np.column_stack([np.interp(rows, range(len(path)), each) for each in path.T])
        share = np.linspace(0.0, 1.0, _SIDE, endpoint=False)[:, None]
        along = path[last] - path[first]
        across = np.array((-along[1], along[0])) * rng.normal(0.0, somebody.arc)
        missed = (1.0 - share) * off[number] + share * off[number + 1]
        parts.append(side + missed + 4.0 * share * (1.0 - share) * across)
    return np.vstack((*parts, path[-1:] + off[-1]))


def followed(here: Floats, times: Floats, lag: float) -> Floats:
    """
    Return where the pen is at some times if it follows its path by a time constant.

    :param here: (n, 2) float64: where it is to be
    :param times: (n,) float64 [s]
    """
    # The last place is aimed at until the pen is there.
    steps = np.arange(0.0, times[-1] + 8.0 * lag, _STEP)
    aims = np.column_stack([np.interp(steps, times, here[:, axis]) for axis in (0, 1)])
    place, speed, places = aims[0].copy(), np.zeros(2), np.empty_like(aims)
    for number, aim in enumerate(aims):
        speed += _STEP * ((aim - place) / lag**2 - 2.0 * speed / lag)
        place += _STEP * speed
        places[number] = place
    spread = times * (steps[-1] / times[-1])
    return np.column_stack([np.interp(spread, steps, places[:, axis]) for axis in (0, 1)])


def wandering(times: Floats, spread: float, rng: Random) -> Floats:
    """Return the deviation of a stranger's hand at some times, (n, 2) float64."""
    found = np.zeros((len(times), 2))
    for number, step in enumerate(np.diff(times).tolist(), 1):
        kept = math.exp(-step / _MEMORY)
        found[number] = kept * found[number - 1] + rng.normal(
            0.0, spread * math.sqrt(1.0 - kept * kept), 2
        )
    return found


def arrow(rng: Random) -> Figure:
    """Return an arrow in one stroke, its barbs by an angle and a length, one often longer."""
    shaft = _shaft(rng)
    tip = shaft[-1]
    one, other = _head(rng, tip, 0.32)
    back = tip + rng.normal(0.0, 0.025, 2)
    order = rng.choice(5)
    if order == 0:
        head = (one, other, back)
    elif order == 1:
        head = (one, back, other, tip + rng.normal(0.0, 0.025, 2))
    else:
        head = (one, back, other)
    if rng.random() < 0.1:
        return Figure(
            kind='arrow',
            path=turned(np.vstack((one, tip, other, back, shaft[::-1])), rng.uniform(0, 7)),
            tail=-1,
        )
    return Figure(kind='arrow', path=turned(np.vstack((shaft, *head)), rng.uniform(0, 7)))


def shaft_and_head(rng: Random) -> list[Floats]:
    """Return a shaft and a head beside its end."""
    shaft = _shaft(rng)
    tip = shaft[-1] + (rng.normal(0.02, 0.05), rng.normal(0.0, 0.025))
    one, other = _head(rng, tip, 0.36)
    return [shaft, np.array((one, tip, other))]


def _shaft(rng: Random) -> Floats:
    x = np.linspace(0.0, 1.0, 16)
    return np.column_stack((x - 0.5, rng.normal(0.0, 0.04) * 4.0 * x * (1.0 - x)))


def _head(rng: Random, tip: Floats, median: float) -> tuple[Floats, Floats]:
    """Return the ends of both barbs, of lengths about a median, in either order."""
    length = min(max(median * math.exp(rng.normal(0.0, 0.35)), 0.14), 0.85)
    ends = [
        tip
        + turned_about_origin(
            np.array((-length * math.exp(rng.normal(0.0, 0.15)), 0.0)),
            side * min(max(rng.normal(0.65, 0.15), 0.3), 1.1),
        )
        for side in (-1.0, 1.0)
    ]
    return (ends[0], ends[1]) if rng.random() < 0.5 else (ends[1], ends[0])
