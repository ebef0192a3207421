# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
People: whole drawings by imitated hands, each with habits of its own and one fault.

A person draws every stroke of a drawing beside where it should be, trembling and in a hurry, and
pauses between two things. One of them draws a thing in several strokes.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from .faults import all_arrive, Fault, FAULTS
from .figures import Figure
from .hand import Hand
from .hands import drawn, hand
from .outlines import Floats
from .scenes import SEEDS

SEVERAL = 'several strokes'
PLAIN = 'no fault'
PEOPLE: dict[str, Fault] = {
    PLAIN: Fault(),
    **{
        name: FAULTS[name]
        for name in (
            'a pen that rests',
            'tremor of 2 %',
            'gap to 11.5 %',
            'ends that cross',
            'bowed sides',
        )
    },
    SEVERAL: Fault(),
    **{
        name: FAULTS[name]
        for name in ('a finger on a tablet', 'a finger on a busy page', 'few samples')
    },
}
# Typical distance by which a stroke is beside its place [m]: two pixels of a page of 1,600.
_AIM = 0.02
# Habits of a hand that are lengths.
_LENGTHS = (
    *('drift', 'tremor', 'noise', 'rounding', 'bow', 'hook_down', 'hook_up', 'slip', 'pixel'),
    *('first_step', 'simplified', 'slant', 'warp', 'missed', 'arc', 'wander'),
)
# Extent above which a figure is not drawn less exactly [m].
_STEADY = 2.0
# Seconds between two strokes of one thing, and between two things.
_WITHIN, _BETWEEN = 0.3, 1.5
# Change of direction that is a corner [rad], as in drawing files.
_CORNER = 0.2
# The greatest number of corners of what is drawn line by line.
_MOST_LINES = 8


def drawn_by(
    person: str, strokes: list[Floats], half: str = 'report'
) -> Iterator[tuple[Floats, float]]:
    """
    Yield the strokes of a drawing as somebody draws it, and when each begins [s].

    :param person: one of `PEOPLE`
    :param strokes: as they should be, (n, 3) float64 each: x, y [m], time [s]
    :param half: of the people
    """
    fault = PEOPLE[person]
    number = list(PEOPLE).index(person)
    rng = np.random.default_rng((SEEDS[half], number, 1))
    now = 0.0
    for stroke in strokes:
        now += _BETWEEN
        for path in _parts(_vertices(stroke)) if person == SEVERAL else [_vertices(stroke)]:
            figure, place = figure_of(path)
            somebody = hand(np.random.default_rng((SEEDS[half], number)), figure, half)
            somebody = all_arrive(somebody, rng)
            faulty = fault.figure(figure, rng)
            if faulty is not None:
                figure, somebody = faulty, fault.hand(somebody, rng)
            samples = drawn(figure, placed(somebody, path, place, rng), rng)
            samples = fault.samples(samples, rng)
            yield samples, now
            now += float(np.ptp(samples[:, 2])) + _WITHIN


def _vertices(stroke: Floats) -> Floats:
    """Return the samples of a stroke without those on straight lines, (n, 2) float64 [m]."""
    points = stroke[:, :2]
    moved = np.hypot(*np.diff(points, axis=0).T) > 1e-6
    points = points[np.concatenate(((True,), moved))]
    return points[np.concatenate(((True,), _turns(points) > 1e-6, (True,)))]


def _turns(points: Floats) -> Floats:
    steps = np.diff(points, axis=0)
    headings = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    return np.abs(np.diff(headings))


def _is_closed(path: Floats) -> bool:
    return bool(np.hypot(*(path[0] - path[-1])) < 1e-6)


def _parts(path: Floats) -> list[Floats]:
    """Return the lines of a polygon or an x, or else all in one."""
    if _is_closed(path) and len(path) - 1 <= _MOST_LINES:
        return [path[[side, side + 1]] for side in range(len(path) - 1)]
    if _crosses(path):
        return [path[:2], path[2:]]
    return [path]


def _crosses(path: Floats) -> bool:
    """Return whether a path is an x: two diagonals and a side between them."""
    if len(path) != 4:
        return False
    (a, b), (c, d) = path[:2], path[2:]
    sides = [np.linalg.det(np.array((q - p, r - p))) for p, q, r in ((a, b, c), (a, b, d))]
    return sides[0] * sides[1] < 0.0 and bool(np.hypot(*(a - c)) < np.hypot(*(a - b)) * 1.1)


def figure_of(path: Floats) -> tuple[Figure, Floats]:
    """Return a path as a figure about the origin, and where that lies [m]."""
    closed = _is_closed(path)
    sharp = np.count_nonzero(_turns(path) > _CORNER)
    curved = len(path) - 2 - sharp > sharp
    away = path[:-1] if closed else path
    middle = away.mean(axis=0)
    away = away - middle
    spread = np.linalg.svd(away, compute_uv=False)
    return Figure(
        # The head of an arrow is drawn last.
        kind='arrow' if curved and sharp else '',
        path=away,
        closed=closed,
        corners=-1 if curved else len(away),
        thin=float(max(spread[-1] / spread[0], 0.05)) if closed else 1.0,
        smooth=curved and not sharp,
    ), middle


def placed(somebody: Hand, path: Floats, place: Floats, rng: np.random.Generator) -> Hand:
    """Return a hand that draws a path where it is, in its size, and not less exactly if large."""
    size = float(np.hypot(*np.ptp(path, axis=0)))
    share = min(1.0, _STEADY / size)
    x, y = (place + rng.normal(0.0, _AIM, 2)).tolist()
    exact = {name: share * getattr(somebody, name) for name in _LENGTHS}
    return replace(somebody, size=size, place=(x, y), **exact)
