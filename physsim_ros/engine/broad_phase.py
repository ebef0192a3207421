# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Broad phase: pairs of axis-aligned boxes that overlap, and discs that may cover a point.

Problem: comparing all with all takes n² / 2 comparisons.
Method: hundreds of boxes are sorted and swept from left to right. Of more, and of discs, each is
kept by size, in cells of a power of two that is at least its size, so that it overlaps others of
its level in 3 x 3 cells only; a smaller one is looked up in each coarser level (Ericson, Real-Time
Collision Detection, 7.5 and 7.2).
Law: every overlapping pair is found once, whatever the sizes and wherever the boxes are; a pair
costs the same whatever else is in the world.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
import itertools
import math

import numpy as np
from physsim_ros.model.arrays import Flags, Floats, Ints
from physsim_ros.model.transform import Point

# Smallest cell, as a power of two [m]: 1 µm, so that cells 1e12 m away have a 64-bit number.
_FINEST = -20
# Counts of pairs up to which they are compared one by one, and up to which those are compared that
# overlap from left to right: each faster than what comes after it, with the same result.
_FEW_PAIRS, _FEW_BESIDE = 1_000, 10_000
# Row numbers times this, modulo 2**64: rows of cells do not meet by chance. 2**64 / golden ratio.
_HASH = np.int64(-7046029254386353131)


def boxes_overlap(a: Floats, b: Floats) -> Flags:
    """Tell which boxes (..., 4) overlap."""
    inside: Flags = (a[..., :2] <= b[..., 2:]) & (b[..., :2] <= a[..., 2:])
    overlap: Flags = inside[..., 0] & inside[..., 1]
    return overlap


def pairs_in_parts(
    boxes: Floats, first: Flags, *, most: int | None = None
) -> Iterator[tuple[Ints, Ints]]:
    """
    Return the pairs of boxes that overlap, each pair once, part by part.

    :param boxes: (n, 4) float64: left, bottom, right, top [m]
    :param first: (n,) bool: one box of each pair is among these
    :param most: pairs that are compared for a part, but for those of one box; None is all
    :return: (p,) and (p,) rows of a part, the lower one first
    """
    rows = np.flatnonzero(first)
    if len(rows) * len(boxes) <= _FEW_PAIRS:
        one, other = np.repeat(rows, len(boxes)), np.tile(np.arange(len(boxes)), len(rows))
        once = (one < other) | ~first[other]
        yield _overlapping(boxes, one[once], other[once])
        return
    swept = _sweep(boxes, first)
    if swept is not None:
        yield _overlapping(boxes, *swept)
        return
    for here, finer, cells in _levels(boxes):
        for one, other in _neighbours(cells, np.flatnonzero(first & (here | finer)), here, most):
            # Two of these in one level find each other.
            once = (one < other) | ~(first & here)[other] | ~here[one]
            yield _overlapping(boxes, one[once], other[once])
        if (first & here).any():
            queries = np.flatnonzero(~first & finer)
            for one, other in _neighbours(cells, queries, first & here, most):
                yield _overlapping(boxes, other, one)


def _sweep(boxes: Floats, first: Flags) -> tuple[Ints, Ints] | None:
    """
    Return the pairs of boxes that overlap from left to right, None if there are many.

    Sort and sweep: a box overlaps those that begin between its own ends.
    """
    order = np.argsort(boxes[:, 0], kind='stable')
    until = np.searchsorted(boxes[order, 0], boxes[order, 2], 'right')
    first = first[order]
    parts = []
    for asking, members in ((first, np.ones_like(first)), (~first, first)):
        begun = np.append(0, np.cumsum(members))
        places = np.flatnonzero(asking)
        counts = begun[until[places]] - begun[places + 1]
        parts.append((places, np.flatnonzero(members), begun[places + 1], counts))
    if sum(int(counts.sum()) for *_, counts in parts) > _FEW_BESIDE:
        return None
    one = [np.repeat(places, counts) for places, _, _, counts in parts]
    other = [members[_ranges(starts, counts)] for _, members, starts, counts in parts]
    return order[np.concatenate(one)], order[np.concatenate(other)]


def _levels(boxes: Floats) -> Iterator[tuple[Flags, Flags, Ints]]:
    """Return (n,) bool the boxes of each level, those of finer levels, and (n, 2) the cells."""
    sizes = (boxes[:, 2:] - boxes[:, :2]).max(axis=1, initial=0.0)
    levels = np.maximum(np.frexp(sizes)[1], _FINEST)
    centers = (boxes[:, :2] + boxes[:, 2:]) / 2
    for level in np.unique(levels).tolist():
        cells = np.floor(np.ldexp(centers, -level)).astype(np.int64)
        yield levels == level, levels < level, cells


def _overlapping(boxes: Floats, one: Ints, other: Ints) -> tuple[Ints, Ints]:
    """Return the pairs whose boxes overlap, the lower row first."""
    overlap = boxes_overlap(boxes[one], boxes[other])
    one, other = one[overlap], other[overlap]
    return np.minimum(one, other), np.maximum(one, other)


def _neighbours(
    cells: Ints, queries: Ints, members: Flags, most: int | None
) -> Iterator[tuple[Ints, Ints]]:
    """
    Return the pairs of a query and a member in its own cell or one of the eight around it.

    :param most: pairs of a part, but for those of one query; None is all
    """
    rows, near = _rows_near(cells, queries, members)
    starts, counts = zip(*near, strict=True)
    cuts: list[int] = []
    if most is not None:
        parts = np.cumsum(np.sum(counts, axis=0)) // most
        cuts = (np.flatnonzero(np.diff(parts)) + 1).tolist()
    for begin, end in itertools.pairwise([0, *cuts, len(queries)]):
        part = slice(begin, end)
        ones = [np.repeat(queries[part], count[part]) for count in counts]
        others = [
            rows[_ranges(start[part], count[part])]
            for start, count in zip(starts, counts, strict=True)
        ]
        yield np.concatenate(ones), np.concatenate(others)


def _rows_near(cells: Ints, queries: Ints, members: Flags) -> tuple[Ints, list[tuple[Ints, Ints]]]:
    """
    Return the members in the cell of each query and in the eight around it.

    :return: rows of the members by cell; and of each row of three cells, (q,) and (q,) the first
        place among these and their count
    """
    keys = cells[:, 1] * _HASH + cells[:, 0]
    rows = np.flatnonzero(members)
    rows = rows[np.argsort(keys[rows], kind='stable')]
    ranked = keys[rows]
    near = []
    for side in (-1, 0, 1):
        middle = (cells[queries, 1] + side) * _HASH + cells[queries, 0]
        starts = np.searchsorted(ranked, middle - 1, 'left')
        near.append((starts, np.searchsorted(ranked, middle + 1, 'right') - starts))
    return rows, near


def _ranges(first: Ints, count: Ints) -> Ints:
    """Return the integers of several ranges, one range after the other."""
    ends = np.cumsum(count)
    rows: Ints = np.repeat(first - ends + count, count)
    rows += np.arange(len(rows))
    return rows


class PointGrid:
    """
    Discs that stay where they are, asked which of them may cover a point.

    A disc is in the cell of its centre, in the level whose cells are as wide as its radius, or up
    to twice as wide.

    :param centers: of the discs [m]
    :param radii: of them, in the same order [m]
    """

    def __init__(self, centers: Iterable[Point], radii: Iterable[float]) -> None:
        # Row, centre and radius of each disc, by level, column and row of its cell.
        self._cells: dict[tuple[int, int, int], list[tuple[int, Point, float]]] = {}
        for row, ((x, y), radius) in enumerate(zip(centers, radii, strict=True)):
            # A share for the rounding of places, 1 nm at 1 000 km.
            reach = radius * (1.0 + 1e-12) + 1e-15 * (abs(x) + abs(y))
            cell = _cell_of(x, y, math.frexp(reach)[1])
            self._cells.setdefault(cell, []).append((row, (x, y), reach))
        self._levels = {level for level, _, _ in self._cells}

    def near(self, point: Point) -> Iterator[int]:
        """Yield the rows of the discs that may cover a point [m]."""
        for level in self._levels:
            _, column, line = _cell_of(*point, level)
            columns, lines = range(column - 1, column + 2), range(line - 1, line + 2)
            for cell in itertools.product((level,), columns, lines):
                for row, center, reach in self._cells.get(cell, ()):
                    if math.dist(center, point) <= reach:
                        yield row


def _cell_of(x: float, y: float, level: int) -> tuple[int, int, int]:
    """Return level, column and row of a place [m]; a cell is 2 to the level wide [m]."""
    return level, math.floor(math.ldexp(x, -level)), math.floor(math.ldexp(y, -level))
