# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Several strokes as one: which touch each other, and their order as if the pen had not been lifted.

Law: the shape of a figure does not depend on the order and the directions of its strokes. Each is
followed by the one that begins nearest to its end; the first one is that with the shortest gaps
between all. A shaft and a head, open, closed or filled, are joined as an arrow in one stroke.
"""

from __future__ import annotations

from collections.abc import Sequence
import itertools
import math

import numpy as np
from physsim_ros.drawing.geometry import angles, convex_hull, path_length, size_of, spaced
from physsim_ros.drawing.strokes.resampled import ARM, COUNT, few_points, smoothed, straightness
from physsim_ros.model.arrays import Flags, Floats
from physsim_ros.model.transform import cross, dots, norms, segment_distances

# The greatest distance of strokes that touch, and of ends that meet, in shares of the size; the
# least turn from one stroke to another that goes back [rad].
_TOUCHING, _NEAR, _BACK = 0.15, 0.05, 2.8
# The length by which a stroke may end short of another that it is to meet, in shares of its own.
_BEYOND = 0.2
# A shaft and a head: the least straightness of the shaft and of barbs (distance of the ends by
# length), the greatest angle between barbs [rad], the least length of the shorter barb by that of
# the longer, and its greatest length and the greatest gap before the tip, in lengths of the shaft.
_STRAIGHT, _WIDEST, _BALANCE, _LONGEST, _NECK = 0.8, 2.3, 0.35, 1.1, 0.35
# A closed head: its least length by that of the hull around it, whose greatest distance from a
# triangle, in lengths of its longer side.
_ROUND, _OFF = 0.7, 0.2
# The number of points in the gap between two strokes, which is then no jump of the pen.
_BETWEEN = 32


def joined_strokes(strokes: Sequence[Floats]) -> Floats:
    """
    Return several strokes as one, with points along the straight gaps between them.

    :param strokes: each (n, 2) float64: evenly spaced [m]
    :return: (n, 2) float64 [m]; a single stroke as it is
    """
    if len(strokes) < 2:
        return strokes[0]
    ordered = _in_order(strokes)
    gaps = [np.linspace(a[-1], b[0], _BETWEEN + 2)[1:-1] for a, b in itertools.pairwise(ordered)]
    return np.vstack([ordered[0], *itertools.chain(*zip(gaps, ordered[1:], strict=True))])


def _in_order(strokes: Sequence[Floats]) -> list[Floats]:
    """Return strokes in the order and the directions of the shortest gaps between all."""
    paths = list(strokes)
    orders = [
        _nearest_next(first, paths[:at] + paths[slice(at + 1, None)])
        for at, path in enumerate(paths)
        for first in (path, path[::-1])
    ]
    return min(orders, key=_gap_between)


def are_sides(strokes: Sequence[Floats]) -> bool:
    """
    Return whether strokes follow one another as the sides of an outline.

    They do not where they end beside each other, and the next one goes back: the outline lacks a
    side there, as between two chevrons within each other.
    """
    ordered = _in_order(strokes)
    size = size_of(np.vstack(ordered))
    return not any(
        math.dist(one[-1], other[0]) > _NEAR * size and _goes_back(one, other)
        for one, other in itertools.pairwise(ordered)
    )


def _goes_back(one: Floats, other: Floats) -> bool:
    """Return whether a stroke begins in the direction against that in which another one ends."""
    # Over a quarter of each, since ends tremble.
    arm = len(one) // 4
    return abs(float(angles(one[-1] - one[-1 - arm], other[arm] - other[0]))) > _BACK


def joined_arrow(strokes: Sequence[Floats]) -> Floats | None:
    """
    Return a shaft and the strokes of a head as an arrow in one stroke, or None.

    The pen returns from the first barb to the tip, or goes round a head that is closed.

    :param strokes: each (n, 2) float64: evenly spaced [m]
    :return: (n, 2) float64, from the tail on [m]
    """
    if len(strokes) < 2:
        return None
    order = sorted(range(len(strokes)), key=lambda at: -math.dist(strokes[at][0], strokes[at][-1]))
    for at in order:
        shaft = strokes[at]
        if straightness(shaft) < _STRAIGHT:
            continue
        head = joined_strokes([*strokes[:at], *strokes[slice(at + 1, None)]])
        parts = _open_headed(shaft, head) or _closed_headed(shaft, head)
        if parts is not None:
            return np.vstack(parts)
    return None


def _closed_headed(shaft: Floats, head: Floats) -> list[Floats] | None:
    """Return the parts of an arrow whose head is a triangle, filled or not, or None."""
    chord, outline = math.dist(shaft[0], shaft[-1]), convex_hull(head)
    if norms(outline - shaft[0]).min() < norms(outline - shaft[-1]).min():
        shaft = shaft[::-1]
    if path_length(head) < _ROUND * path_length(np.vstack((outline, outline[:1]))):
        return None
    along = (shaft[-1] - shaft[0]) / chord
    outline = np.roll(outline, -int(dots(outline, along).argmax()), axis=0)
    tip = outline[0]
    aside = cross(along, outline - tip)
    barbs = outline[[int(aside.argmax()), int(aside.argmin())]]
    less, more = sorted(norms(barbs - tip).tolist())
    gap = float(segment_distances(shaft[-1:], tip, barbs.mean(axis=0))[0])
    if not _BALANCE * more < less or more > _LONGEST * chord or gap > _NECK * chord:
        return None
    sides = (barbs[0], tip, barbs[0]), (tip, barbs[1], barbs[1])
    off = segment_distances(outline, *(np.array(each)[:, None] for each in sides)).min(axis=0)
    if float(off.max()) > _OFF * more:
        return None
    shaft = shaft[: int(norms(shaft - tip).argmin()) + 1]
    neck = np.linspace(shaft[-1], tip, _BETWEEN)[1:-1]
    return [shaft, neck, spaced(np.vstack((outline, tip)), COUNT)]


def _open_headed(shaft: Floats, head: Floats) -> list[Floats] | None:
    """Return the parts of an arrow with two barbs from its tail on, or None."""
    chord, bend = math.dist(shaft[0], shaft[-1]), segment_distances(head, head[0], head[-1])
    tip = int(bend.argmax())
    less, more = sorted(norms(head[[0, -1]] - head[tip]).tolist())
    angle = abs(float(angles(head[0] - head[tip], head[-1] - head[tip])))
    straight = (less + more) / path_length(smoothed(head, closed=False))
    if straight < _STRAIGHT or angle > _WIDEST or not _BALANCE * more < less < _LONGEST * chord:
        return None
    if math.dist(shaft[0], head[tip]) < math.dist(shaft[-1], head[tip]):
        shaft = shaft[::-1]
    if math.dist(shaft[-1], head[tip]) > min(_NECK * chord, more):
        return None
    # A shaft that goes beyond the tip ends beside it.
    shaft = shaft[: int(norms(shaft - head[tip]).argmin()) + 1]
    neck = np.linspace(shaft[-1], head[tip], _BETWEEN)[1:-1]
    return [shaft, neck, head[tip::-1], head[1:]]


def _nearest_next(first: Floats, others: Sequence[Floats]) -> list[Floats]:
    """Return paths from a first one on, each the one that begins nearest to the end before it."""
    ordered, left = [first], [each for path in others for each in (path, path[::-1])]
    while left:
        at = min(range(len(left)), key=lambda each: math.dist(left[each][0], ordered[-1][-1]))
        ordered.append(left[at])
        # Both directions of that path are done.
        del left[slice(at - at % 2, at - at % 2 + 2)]
    return ordered


def _gap_between(paths: Sequence[Floats]) -> float:
    """Return the length of all gaps between the paths [m]."""
    return sum(math.dist(a[-1], b[0]) for a, b in itertools.pairwise(paths))


def touching(strokes: Sequence[Floats], snap: float) -> Flags:
    """Return which strokes touch each other, (n, n) bool."""
    paths, sizes = (
        [_extended(stroke) for stroke in strokes],
        [size_of(stroke) for stroke in strokes],
    )
    touching = np.zeros((len(paths), len(paths)), np.bool_)
    for one, other in itertools.combinations(range(len(paths)), 2):
        size = max(sizes[one], sizes[other])
        touching[one, other] = touch(paths[one], paths[other], size, snap)
    return touching | touching.T


def touch(one: Floats, other: Floats, size: float, snap: float) -> bool:
    """Return whether points of two strokes of a size are near enough to touch."""
    x, y = (one[:, None] - other[None]).transpose(2, 0, 1)
    return float(np.hypot(x, y).min()) <= min(_TOUCHING * size, max(snap, _NEAR * size))


def _extended(stroke: Floats) -> Floats:
    """Return points of a stroke and of its lines beyond both ends, where others may meet it."""
    parts = [few_points(stroke)]
    # As far from one another as those on the stroke.
    step = path_length(stroke) / len(parts[0])
    steps = step * np.arange(1, int(_BEYOND * len(parts[0])) + 1)[:, None]
    for points in (stroke, stroke[::-1]):
        ahead = points[0] - points[ARM]
        parts.append(points[0] + steps * (ahead / max(float(norms(ahead)), 1e-300)))
    return np.vstack(parts)
