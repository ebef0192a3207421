# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Corner detection: the intended corners of a stroke, and their positions.

Candidates are points at which the stroke turns over a short distance, as in ShortStraw (Wolin,
Eoff and Hammond, 2008). The corners among them minimise the description length (Rissanen, 1978):
the logarithm of the residual of straight sides plus a cost for each corner, by dynamic programming
over all candidates. The more the sides wobble, the more a corner has to explain.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray
from physsim_ros.drawing.geometry import angles, meeting_point
from physsim_ros.drawing.strokes.fitting import line, WOBBLE
from physsim_ros.drawing.strokes.resampled import ARM, smoothed, turns
from physsim_ros.drawing.strokes.stroke import HOOK
from physsim_ros.model.arrays import Floats
from physsim_ros.model.shapes import signed_area
from physsim_ros.model.transform import dots, norms, Point

# The least turn of a corner [rad], half of which makes a candidate: over its arms it is rounded.
_CORNER_TURN = 0.42
# Cost of a corner: the decrease of the logarithm of the residual (mean square distance) that is
# worth one.
_CORNER_COST = 0.5
# The wobble of outlines, which is worth no corner, in shares of the size: less than that of open
# strokes (`WOBBLE`), since their many corners are flatter.
_WOBBLE_CLOSED = 0.008
# Places along a side, -1 .. 1, between fifths that may be round, and the parabola there.
_ALONG = np.linspace(-0.6, 0.6, 12)
_PARABOLA = _ALONG**2 - (_ALONG**2).mean()
# The least distance between the ends of a side, in shares of the length along the stroke.
_LEAST_CHORD = 0.75


def corners(path: Floats, *, closed: bool) -> list[int]:
    """
    Return the indices of the corners; the ends of an open polyline are corners.

    :param path: (n, 2) float64: smooth, evenly spaced; of a closed one, the first not repeated
    """
    count = len(path)
    turn = np.abs(turns(path, ARM, closed=closed))
    places = _peaks(turn, closed=closed)
    if not closed:
        inner = places[(places > 2) & (places < count - 3)]
        chosen = _corners_among(path, np.array([0, *inner, count - 1]), WOBBLE)
        return _without_arcs(path, chosen)
    if len(places) < 2:
        return list(map(int, places))
    # Opened at the sharpest candidate, which is a corner.
    start = places[turn[places].argmax()]
    turned = np.roll(path, -start, axis=0)
    opened = np.array([*np.sort((places - start) % count), count])
    chosen = _corners_among(np.vstack((turned, turned[:1])), opened, _WOBBLE_CLOSED)
    return sorted((each + int(start)) % count for each in chosen[:-1])


def vertices(points: Floats, at: list[int], *, closed: bool) -> Floats:
    """
    Return the intersections of the sides between corners, (k, 2) float64 [m]: sharp corners.

    :param at: the corners, as `corners` returns them
    """
    count, total = len(at), len(points)
    found = points[at].copy()
    if count < 2:
        return found
    lines = []
    for first, last in zip(at, at[1:] + at[:1], strict=True):
        span = (last - first) % total
        # The fifths of a side next to its corners may be round.
        rows = np.arange(first + span // 5, first + span - span // 5 + 1) % total
        lines.append(line(points[rows]))
    if not closed:
        for corner, (middle, along, _) in ((0, lines[0]), (-1, lines[-2])):
            found[corner] = middle + along * dots(found[corner] - middle, along)
    for corner in range(0 if closed else 1, count if closed else count - 1):
        (one, along, _), (other, beside, _) = lines[corner - 1], lines[corner]
        meeting = meeting_point(one, along, other, beside)
        if meeting is not None:
            found[corner] = meeting
    return found


def bends_of(points: Floats, path: Floats) -> Floats:
    """
    Return the ends and bends of an open stroke, (k, 2) float64 [m].

    :param points: (n, 2) float64: of the stroke [m]
    :param path: the same, smooth
    """
    at = _without_stubs(points, corners(path, closed=False))
    return vertices(points, at, closed=False)


def outline_corners(outline: Floats) -> tuple[list[int], Floats, float]:
    """
    Return the corners of an outline and their positions.

    :return: their indices; (k, 2) float64 [m]; the distance of the outline from the sides between
        them (rms) [m], infinite where they are fewer than three
    """
    at = corners(smoothed(outline, closed=True), closed=True)
    error = _side_error(outline, at) if len(at) > 2 else math.inf
    return at, vertices(outline, at, closed=True), error


def _side_error(outline: Floats, at: list[int]) -> float:
    """Return the distance of a closed stroke from the sides between its corners (rms) [m]."""
    path = np.vstack((outline, outline[: at[0] + 1]))
    ends = np.array([*at, at[0] + len(outline)])
    return math.sqrt(float(np.diagonal(_residuals(path, ends), 1).sum()) / len(outline))


def turning_within(outline: Floats, at: list[int]) -> float:
    """
    Return the share of the turning of a closed polyline that lies within its sides.

    A circle has 1, a polygon 0. Parabolas of least squares make it independent of the tremor.

    :param at: the corners, as `corners` returns them
    """
    if len(at) < 2:
        return 1.0
    starts = np.array(at)
    middles = (starts + np.append(starts[1:], at[0] + len(outline))) / 2
    place = middles[:, None] + (middles - starts)[:, None] * _ALONG
    before = np.floor(place).astype(np.intp)
    share = (place - before)[..., None]
    points = outline[before % len(outline)] * (1.0 - share)
    points += outline[(before + 1) % len(outline)] * share
    slope = (points * _ALONG[:, None]).sum(axis=1) / float((_ALONG**2).sum())
    bend = (points * _PARABOLA[:, None]).sum(axis=1) / float((_PARABOLA**2).sum())
    bend *= 2.0 * _ALONG[-1]
    turn = float(angles(slope - bend, slope + bend).sum() / (2.0 * math.pi * _ALONG[-1]))
    return turn if signed_area(outline) > 0.0 else -turn


def _without_stubs(points: Floats, at: list[int]) -> list[int]:
    """Return the corners of an open stroke without those of ends that bend aside by mistake."""
    kept = list(at)
    for _ in range(2):
        # Each round reverses the order: one end each, and the order is restored.
        kept.reverse()
        if len(kept) > 2 and abs(kept[-1] - kept[-2]) < HOOK * (len(points) - 1):
            kept.pop()
    return kept


def _peaks(turn: NDArray[np.float64], *, closed: bool) -> NDArray[np.intp]:
    """Return the indices of the local maxima of the turn."""
    around = np.pad(turn, 2, mode='wrap' if closed else 'constant')
    highest = np.max([around[:-4], around[1:-3], around[3:-1], around[4:]], axis=0)
    return np.flatnonzero((turn >= highest) & (turn > _CORNER_TURN / 2))


def _corners_among(path: Floats, places: NDArray[np.intp], wobble: float) -> list[int]:
    """
    Return the indices of the corners among candidates, the ends included.

    Corners minimise residual and cost; those that turn by less than `_CORNER_TURN` are dropped.
    """
    if len(places) > 2:
        places = places[_least_cost(_residuals(path, places), path, wobble)]
    kept: list[int] = places.tolist()
    points: list[tuple[float, float]] = list(map(tuple, path[kept].tolist()))
    turning = [_turn(*around) for around in zip(points, points[1:], points[2:], strict=False)]
    while turning and min(turning) <= _CORNER_TURN:
        least = turning.index(min(turning))
        del kept[least + 1], points[least + 1], turning[least]
        # Its neighbours turn by more without it.
        for corner in range(max(least, 1), min(least + 2, len(points) - 1)):
            before, after = points[corner - 1], points[corner + 1]
            turning[corner - 1] = _turn(before, points[corner], after)
    return kept


def _least_cost(residuals: NDArray[np.float64], path: Floats, wobble: float) -> list[int]:
    """
    Return the candidates of least description length, the ends included.

    With k sides, of the least residual among all choices of k + 1 candidates (dynamic programming,
    Bellman, 1961), it is log(residual + wobble²) + k · _CORNER_COST.
    """
    # Mean square distances, in shares of the size squared.
    shares = residuals / (float((np.ptp(path, axis=0) ** 2).sum()) * len(path))
    shares[np.tril_indices(len(shares))] = np.inf
    total, before = shares[0], []
    best, sides = math.inf, 0
    for count in range(1, len(shares)):
        if count > 1:
            sums = total[:, None] + shares
            before.append(sums.argmin(axis=0))
            total = sums.min(axis=0)
        length = math.log(float(total[-1]) + wobble**2) + count * _CORNER_COST
        if length < best:
            best, sides = length, count
    chosen = [len(shares) - 1]
    for row in before[: sides - 1][::-1]:
        chosen.append(int(row[chosen[-1]]))
    return [0, *chosen[::-1]]


def _without_arcs(path: Floats, at: list[int]) -> list[int]:
    """Return the corners of an open polyline without those within a side that is an arc."""
    kept = list(at)
    while len(kept) > 2:
        straight = np.diagonal(_residuals(path, np.array(kept)), 1)
        sides = zip(kept, kept[2:], strict=False)
        arcs = np.array([_arc_error(path[slice(a, b + 1)]) for a, b in sides])
        worse = arcs - straight[:-1] - straight[1:]
        if worse.min() > 0.0:
            break
        del kept[1 + int(worse.argmin())]
    return kept


def _arc_error(points: Floats) -> float:
    """Return the sum of squared distances from the parabola of least squares [m²]."""
    share = np.linspace(-1.0, 1.0, len(points))
    square = share**2 - (share**2).mean()
    error = float(((points - points.mean(axis=0)) ** 2).sum())
    for each in (share, square):
        error -= float(((each[:, None] * points).sum(axis=0) ** 2).sum()) / float((each**2).sum())
    return error


def _turn(a: Point, b: Point, c: Point) -> float:
    """Return the turning angle at b of the polyline a, b, c, 0 .. π [rad]."""
    (ux, uy), (vx, vy) = (b[0] - a[0], b[1] - a[1]), (c[0] - b[0], c[1] - b[1])
    return abs(math.atan2(ux * vy - uy * vx, ux * vx + uy * vy))


def _residuals(path: Floats, places: NDArray[np.intp]) -> NDArray[np.float64]:
    """
    Return the residual of one straight side between each two candidates.

    :return: (k, k) float64: sum of squared distances of the points between them from the line of
        least squares, and the penalty of a stroke that goes back along it [m²]
    """
    x, y = (path - path.mean(axis=0)).T
    sums = np.zeros((5, len(path) + 1))
    np.cumsum((x, y, x * x, x * y, y * y), axis=1, out=sums[:, 1:])
    # The points between the two: a corner itself may be round.
    first = sums[:, places + 1][:, :, None]
    last = sums[:, places][:, None, :]
    number = np.maximum(places[None, :] - places[:, None] - 1, 1)
    sx, sy, sxx, sxy, syy = last - first
    xx, xy, yy = sxx - sx * sx / number, sxy - sx * sy / number, syy - sy * sy / number
    least = np.maximum((xx + yy) / 2 - np.hypot((xx - yy) / 2, xy), 0.0)
    # A stroke back along the same line has no such distance, but its ends lie too close together.
    ends = path[places]
    chord = norms(ends[None] - ends[:, None])
    steps = np.concatenate(([0.0], np.cumsum(norms(np.diff(path, axis=0)))))[places]
    missing = np.maximum(_LEAST_CHORD * (steps[None] - steps[:, None]) - chord, 0.0)
    penalty = number * missing**2
    residual: NDArray[np.float64] = least + penalty
    return residual
