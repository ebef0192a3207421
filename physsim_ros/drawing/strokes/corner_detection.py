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
The corners of a way: those that a person meant, and where they lie.

Candidates are looked for where the pen turns within a short way, as ShortStraw does (Wolin, Eoff
and Hammond, 2008). Which of them are meant is decided by all of them at once: the fewest straight
sides that explain the way.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from physsim_ros.drawing.strokes.fitting import line
from physsim_ros.drawing.strokes.polyline import angles, smoothed, turns
from physsim_ros.drawing.strokes.stroke import HOOK, HOOK_TURN
from physsim_ros.model.arrays import Floats
from physsim_ros.model.transform import cross, Point

# Smoothing before corners are looked for, and the arms of the angle there [points].
SMOOTHING, ARM = 1.2, 5
# The least turn that may be a corner, and the least that is one [rad].
CANDIDATE_TURN, CORNER_TURN = 0.3, 0.42
# The greatest turn at which two sides still meet in a point [rad].
SHARPEST = 2.6
# The most candidates that are weighed against one another.
CANDIDATES = 28
# What a corner has to save to be worth it: mean square distance, in shares of the size squared.
CORNER_COST = 0.0075**2
# A straight side gets at least that share of its length from one end to the other.
ASTRAY = 0.75
# What is left of an end that is bent off is no longer than this share of the length.
STUB = 0.07
# How near to the gap in a closed way a side that only bridges it begins and ends, in shares of
# the length, and how far its ends may slip past one another.
SEAM, SLIP = 0.03, 0.045


def corners(points: Floats, *, closed: bool, gap: float = 0.0) -> list[int]:
    """
    Return which points are corners; of an open way, the ends are.

    :param points: (n, 2) float64: evenly spaced; of a closed way, the first not repeated
    :param gap: in shares of a closed way, what at its end was not drawn
    """
    count = len(points)
    smooth = smoothed(points, SMOOTHING, closed=closed)
    turn = np.abs(turns(smooth, ARM, closed=closed))
    places = _peaks(turn, closed=closed)
    if not closed:
        inner = places[(places > 2) & (places < count - 3)]
        return _meant(smooth, np.array([0, *inner, count - 1]))
    if len(places) < 2:
        return list(map(int, places))
    # Opened at the sharpest corner, which certainly is one.
    start = places[turn[places].argmax()]
    way = np.roll(smooth, -start, axis=0)
    opened = np.array([*np.sort((places - start) % count), count])
    chosen = _meant(np.vstack((way, way[:1])), opened)
    at = sorted((each + int(start)) % count for each in chosen[:-1])
    return _without_seam(smooth, at, gap)


def vertices(points: Floats, at: list[int], *, closed: bool) -> Floats:
    """
    Return where the sides between corners meet: sharp, however round the pen took them.

    :param at: the corners, as `corners` returns them
    """
    count, total = len(at), len(points)
    found = points[at].copy()
    if count < 2:
        return found
    lines = []
    for first, last in zip(at, at[1:] + at[:1], strict=True):
        span = (last - first) % total
        # The fifths next to the corners may be round.
        rows = np.arange(first + span // 5, first + span - span // 5 + 1) % total
        lines.append(line(points[rows]))
    if not closed:
        for corner, (middle, along, _) in ((0, lines[0]), (-1, lines[-2])):
            found[corner] = middle + along * ((found[corner] - middle) @ along)
    for corner in range(0 if closed else 1, count if closed else count - 1):
        (p, u, _), (q, v, _) = lines[corner - 1], lines[corner]
        sine = float(cross(u, v))
        # Nearly parallel lines meet anywhere.
        if abs(sine) > 0.3:
            found[corner] = p + u * (cross(q - p, v) / sine)
    return found


def bends_of(points: Floats) -> Floats:
    """Return the ends and bends of an open way."""
    at = _without_stubs(points, corners(points, closed=False))
    return vertices(points, at, closed=False)


def side_error(outline: Floats, at: list[int]) -> float:
    """Return how far a closed way lies from the sides between its corners, root mean square."""
    way = np.vstack((outline, outline[: at[0] + 1]))
    ends = np.array([*at, at[0] + len(outline)])
    return math.sqrt(float(np.diagonal(_errors(way, ends), 1).sum()) / len(outline))


def _without_stubs(points: Floats, at: list[int]) -> list[int]:
    """Return the corners of an open way without ends that are too short to be meant."""
    kept = list(at)
    for _ in range(2):
        # From the other end in the second round, and so the right way round after both.
        kept.reverse()
        if len(kept) > 2:
            a, b = np.diff(points[kept[-3:]], axis=0)
            bent = abs(float(angles(a, b))) > HOOK_TURN / 2
            if abs(kept[-1] - kept[-2]) < (STUB + HOOK * bent / 2) * (len(points) - 1):
                kept.pop()
    return kept


def _peaks(turn: NDArray[np.float64], *, closed: bool) -> NDArray[np.intp]:
    """Return where the way turns most, at most so many places."""
    around = np.pad(turn, 2, mode='wrap' if closed else 'constant')
    highest = np.max([around[:-4], around[1:-3], around[3:-1], around[4:]], axis=0)
    places = np.flatnonzero((turn >= highest) & (turn > CANDIDATE_TURN))
    if len(places) > CANDIDATES:
        places = np.sort(places[np.argsort(-turn[places])[:CANDIDATES]])
    return places


def _meant(way: Floats, places: NDArray[np.intp]) -> list[int]:
    """
    Return those of the places at which sides begin and end that are meant, the ends among them.

    All choices are weighed; a corner has to pay for itself, and what is left of corners that
    hardly turn is dropped.
    """
    if len(places) > 2:
        places = places[_fewest(_errors(way, places), way)]
    kept: list[int] = places.tolist()
    points: list[tuple[float, float]] = list(map(tuple, way[kept].tolist()))
    turning = [_turn(*around) for around in zip(points, points[1:], points[2:], strict=False)]
    while turning and min(turning) <= CORNER_TURN:
        least = turning.index(min(turning))
        del kept[least + 1], points[least + 1], turning[least]
        # Those beside it turn by more now.
        for corner in range(max(least, 1), min(least + 2, len(points) - 1)):
            before, after = points[corner - 1], points[corner + 1]
            turning[corner - 1] = _turn(before, points[corner], after)
    return kept


def _fewest(errors: NDArray[np.float64], way: Floats) -> list[int]:
    """Return which places to keep, where each costs as much as it has to save."""
    cost = CORNER_COST * float((np.ptp(way, axis=0) ** 2).sum()) * len(way)
    # Dynamic programming: the cheapest way to each place, over the last one before it.
    total, before = [0.0], [0]
    for end, row in enumerate(errors.T.tolist()[1:], 1):
        ways = [known + error for known, error in zip(total, row[:end], strict=True)]
        least = min(ways)
        total.append(least + cost)
        before.append(ways.index(least))
    chosen = [len(before) - 1]
    while chosen[-1] > 0:
        chosen.append(before[chosen[-1]])
    return chosen[::-1]


def _turn(a: Point, b: Point, c: Point) -> float:
    """Return by how much a way from a over b to c turns there, 0 .. π [rad]."""
    (ux, uy), (vx, vy) = (b[0] - a[0], b[1] - a[1]), (c[0] - b[0], c[1] - b[1])
    return abs(math.atan2(ux * vy - uy * vx, ux * vx + uy * vy))


def _without_seam(way: Floats, at: list[int], gap: float) -> list[int]:
    """Drop the corners of a side that only bridges the ends of a closed way, and was not drawn."""
    count = len(way)
    near = round(SEAM * count)
    # The gap is at the end; a side that bridges it begins there and ends at the beginning.
    bridge = [each for each in at if each >= count * (1.0 - gap / (1.0 + gap)) - near]
    first, last = bridge[0] if bridge else at[0], at[0] if bridge else at[-1]
    if len(at) < 4 or first == last or last > near:
        return at
    kept = [each for each in at if each > last and each < first]
    into, out = way[first] - way[kept[-1]], way[kept[0]] - way[last]
    turn = abs(float(angles(into, out)))
    if turn > SHARPEST or (turn < CORNER_TURN and gap > SLIP):
        # The sides beside it run on, or back, beside one another: what is between was meant.
        return at
    return [*kept, first] if turn > CORNER_TURN else kept


def _errors(way: Floats, places: NDArray[np.intp]) -> NDArray[np.float64]:
    """
    Return how badly one straight side explains the way between each two places.

    :return: (k, k) float64: sum of squared distances from the straight line that is nearest [m²]
    """
    x, y = (way - way.mean(axis=0)).T
    sums = np.zeros((5, len(way) + 1))
    np.cumsum((x, y, x * x, x * y, y * y), axis=1, out=sums[:, 1:])
    # The point next to a corner may be round.
    first = sums[:, places + 1][:, :, None]
    last = sums[:, places][:, None, :]
    number = np.maximum(places[None, :] - places[:, None] - 1, 1)
    sx, sy, sxx, sxy, syy = last - first
    xx, xy, yy = sxx - sx * sx / number, sxy - sx * sy / number, syy - sy * sy / number
    least = np.maximum((xx + yy) / 2 - np.hypot((xx - yy) / 2, xy), 0.0)
    # Back on its own line a way leaves no distance from it, but gets nowhere.
    ends = way[places]
    chord = np.hypot(*(ends[None] - ends[:, None]).transpose(2, 0, 1))
    steps = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(way, axis=0).T))))[places]
    astray = np.maximum(ASTRAY * (steps[None] - steps[:, None]) - chord, 0.0)
    wrong: NDArray[np.float64] = least + number * astray**2
    return wrong
