# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Partition of cells into the fewest rectangles.

Problem: minimum partition of a rectilinear region, holes included, into rectangles. Method: W.
Lipski, E. Lodi, F. Luccio, C. Mugnai and L. Pagli, On two-dimensional data organization II, 1979;
T. Ohtsuki, Minimum dissection of rectilinear regions, 1982; a survey is D. Eppstein,
Graph-theoretic solutions to computational geometry problems, 2009, section 3. Each reflex vertex
must be cut; a chord, an interior segment between two reflex vertices, cuts two at once. Horizontal
and vertical chords that meet exclude each other: the most that go together are a maximum
independent set of a bipartite graph, by matching (Hopcroft and Karp; SciPy) and the theorem of
König. Each other reflex vertex has a horizontal cut of its own.

Cost: arrays of the size of the grid, and the matching; a million cells take some 0.2 s.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Flags, Ints
from physsim_ros.model.errors import WorldFull

# Greatest number of chords that are matched in one connected tangle of chords, 0.1 s. In a larger
# one, as in noise, those of the more numerous direction are taken, 1 % less than the most there.
_MOST_MATCHED = 5000


class _Chords(NamedTuple):
    """
    Chords along the lines of a grid.

    :ivar lines: (k,) int64: number of the line of each
    :ivar begins: (k,) int64: the lattice point on it at which it begins
    :ivar ends: (k,) int64: the one at which it ends
    """

    lines: Ints
    begins: Ints
    ends: Ints


def rectangles_of(occupied: Flags, most: int) -> Ints:
    """
    Return the fewest rectangles that together are the occupied cells, none twice.

    :param occupied: (rows, columns) bool
    :param most: greatest number of rectangles
    :return: (k, 4) int64: first row, first column, row and column after the last; sorted by the
        first two
    :raises WorldFull: there are more
    """
    cells = np.pad(occupied, 1)
    # By lattice point: the cells around it, as lower left, lower right, upper left, upper right.
    around = cells[:-1, :-1], cells[:-1, 1:], cells[1:, :-1], cells[1:, 1:]
    count = np.zeros(around[0].shape, dtype=np.int8)
    for each in around:
        count += each
    reflex = count == 3
    corners = np.count_nonzero(count == 1) + np.count_nonzero(reflex)
    touching = np.count_nonzero((count == 2) & (around[0] == around[3]))
    # With each reflex vertex at the end of a chord; without chords 3 of 4 would count.
    _check_count(int(corners + 2 * touching) // 4, most)
    # Interior edges of the lattice from each point to the right, and up.
    right, up = around[1] & around[3], around[2] & around[3]
    across, along = _chords(right, reflex), _chords(up.T, reflex.T)
    keeps_across, keeps_along = _independent(across, along, reflex.shape)
    across = _Chords(*(each[keeps_across] for each in across))
    along = _Chords(*(each[keeps_along] for each in along))
    walls_up = _drawn(along, reflex.T.shape).T
    cut = reflex.copy()
    for line, column in ((across.lines, across.begins), (across.lines, across.ends)):
        cut[line, column] = False
    for line, column in ((along.begins, along.lines), (along.ends, along.lines)):
        cut[line, column] = False
    walls_right = _drawn(across, reflex.shape)
    walls_right |= _drawn(_cuts(cut, right, walls_up), reflex.shape)
    walls_right |= around[1] != around[3]
    walls_up |= around[2] != around[3]
    return _rectangles(cells, walls_right, walls_up, most)


def _check_count(count: int, most: int) -> None:
    if count > most:
        raise WorldFull(f'the map has {count} rectangles or more; at most {most} are allowed')


def _chords(edges: Flags, reflex: Flags) -> _Chords:
    """
    Return the chords along the rows of a lattice.

    :param edges: (m, n) bool: whether the edge from each point to the next one is interior
    :param reflex: (m, n) bool: the reflex vertices
    """
    before = np.zeros_like(edges)
    before[:, 1:] = edges[:, :-1]
    lines, begins = np.nonzero(edges & ~before)
    # A run of interior edges ends in the line in which it begins; both are in order.
    _, ends = np.nonzero(before & ~edges)
    chosen = reflex[lines, begins] & reflex[lines, ends]
    return _Chords(lines[chosen], begins[chosen], ends[chosen])


def _independent(across: _Chords, along: _Chords, shape: tuple[int, int]) -> tuple[Flags, Flags]:
    """Return which chords are in a largest set of chords that do not meet."""
    # Chords of one direction have no point in common.
    first = _numbered(across, shape)
    second = _numbered(along, shape[::-1]).T
    met = (first >= 0) & (second >= 0)
    rows, columns = first[met].astype(np.int64), second[met].astype(np.int64)
    sizes = len(across.lines), len(along.lines)
    if not len(rows):
        return np.ones(sizes[0], dtype=np.bool_), np.ones(sizes[1], dtype=np.bool_)
    from scipy.sparse import csgraph, csr_array  # noqa: PLC0415 - a fifth of the imports of a node

    tangled, out_across, out_along = _tangles(rows, columns, sizes)
    easy = ~tangled[rows]
    rows, columns = rows[easy], columns[easy]
    graph = csr_array((np.ones(len(rows), dtype=np.int8), (rows, columns)), shape=sizes)
    partners = csgraph.maximum_bipartite_matching(graph, perm_type='column')
    # König: along alternating paths from what has no partner.
    matched = np.full(sizes[1], -1, dtype=np.int64)
    matched[partners[partners >= 0]] = np.flatnonzero(partners >= 0)
    reached, passed = partners < 0, np.zeros(sizes[1], dtype=np.bool_)
    front = reached
    while front.any():
        fresh = np.zeros(sizes[1], dtype=np.bool_)
        fresh[columns[front[rows]]] = True
        fresh &= ~passed
        passed |= fresh
        front = np.zeros(sizes[0], dtype=np.bool_)
        front[matched[fresh & (matched >= 0)]] = True
        front &= ~reached
        reached = reached | front
    return reached & ~out_across, ~passed & ~out_along


def _tangles(rows: Ints, columns: Ints, sizes: tuple[int, int]) -> tuple[Flags, Flags, Flags]:
    """
    Return which chords along rows are in a large tangle, and those of both kinds to leave out.

    :param rows: (k,) int64: numbers of chords along rows that meet ones along columns
    :param columns: (k,) int64: numbers of these
    :param sizes: numbers of chords along rows and columns
    """
    from scipy.sparse import csgraph, csr_array  # noqa: PLC0415 - a fifth of the imports of a node

    ones, whole = np.ones(len(rows), dtype=np.int8), sum(sizes)
    graph = csr_array((ones, (rows, sizes[0] + columns)), shape=(whole, whole))
    count, labels = csgraph.connected_components(graph, directed=False)
    across, along = np.split(labels, sizes[:1])
    numbers = [np.bincount(each, minlength=count) for each in (across, along)]
    large = numbers[0] + numbers[1] > _MOST_MATCHED
    more = numbers[0] >= numbers[1]
    return large[across], (large & ~more)[across], (large & more)[along]


def _numbered(chords: _Chords, shape: tuple[int, int]) -> NDArray[np.int32]:
    """Return (m, n) int32: the number of the chord at each lattice point; -1 is none."""
    steps = np.zeros((shape[0], shape[1] + 1), dtype=np.int32)
    numbers = np.arange(1, len(chords.lines) + 1, dtype=np.int32)
    steps[chords.lines, chords.begins] = numbers
    steps[chords.lines, chords.ends + 1] -= numbers
    return np.cumsum(steps, axis=1, dtype=np.int32)[:, :-1] - np.int32(1)


def _drawn(chords: _Chords, shape: tuple[int, int]) -> Flags:
    """Return (m, n) bool: whether a chord has the edge from each lattice point to the next."""
    steps = np.zeros(shape, dtype=np.int32)
    np.add.at(steps, (chords.lines, chords.begins), 1)
    np.add.at(steps, (chords.lines, chords.ends), -1)
    drawn: Flags = np.cumsum(steps, axis=1, dtype=np.int32) > 0
    return drawn


def _cuts(reflex: Flags, edges: Flags, walls_up: Flags) -> _Chords:
    """
    Return the cuts along the rows from reflex vertices to what ends them.

    :param reflex: (m, n) bool: the vertices that no chord cuts
    :param edges: (m, n) bool: whether the edge to the right of each point is interior
    :param walls_up: (m, n) bool: whether a chord has the edge upward of each point
    """
    columns = np.arange(edges.shape[1])
    before = np.zeros_like(edges)
    before[:, 1:] = edges[:, :-1]
    chord = walls_up.copy()
    chord[1:] |= walls_up[:-1]
    stops_right, stops_left = chord | ~edges, chord | ~before
    following = np.where(stops_right, columns, len(columns))
    following = np.minimum.accumulate(following[:, ::-1], axis=1)[:, ::-1]
    preceding = np.maximum.accumulate(np.where(stops_left, columns, -1), axis=1)
    lines, begins = np.nonzero(reflex & edges)
    rightward = _Chords(lines, begins, following[lines, begins + 1])
    lines, ends = np.nonzero(reflex & before)
    leftward = _Chords(lines, preceding[lines, ends - 1], ends)
    return _Chords(*(np.concatenate(each) for each in zip(rightward, leftward, strict=True)))


def _rectangles(cells: Flags, walls_right: Flags, walls_up: Flags, most: int) -> Ints:
    """Return the rectangles that walls leave, by their lower left cells."""
    # The lattice point of a cell is its lower left corner.
    inside = cells[1:, 1:]
    rows, columns = np.nonzero(inside & walls_right & walls_up)
    _check_count(len(rows), most)
    width, height = inside.shape[1], inside.shape[0]
    right = np.where(walls_up, np.arange(width), width)
    right = np.minimum.accumulate(right[:, ::-1], axis=1)[:, ::-1]
    top = np.where(walls_right, np.arange(height)[:, None], height)
    top = np.minimum.accumulate(top[::-1], axis=0)[::-1]
    return np.column_stack((rows, columns, top[rows + 1, columns], right[rows, columns + 1]))
