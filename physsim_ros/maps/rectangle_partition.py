# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Partition of cells into few rectangles.

Problem: minimum partition of a rectilinear region, holes included, into rectangles. Method: T.
Ohtsuki, Minimum dissection of rectilinear regions, 1982; a survey is D. Eppstein, Graph-theoretic
solutions to computational geometry problems, 2009, section 3. Each reflex vertex must be cut; a
chord, an interior segment between two reflex vertices, cuts two at once. Horizontal and vertical
chords that meet exclude each other. Of these the ones of the more numerous direction are drawn;
Ohtsuki draws as many as go together, a maximum matching. Each other reflex vertex has a horizontal
cut of its own.

Accuracy: the fewest rectangles where no chords meet, as in mazes and rooms; up to 6 % more in
noise and on ragged outlines. Cost: arrays of the size of the grid.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from physsim_ros.model.arrays import Flags, Ints
from physsim_ros.model.errors import WorldFull


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
    Return few rectangles that together are the occupied cells, none twice.

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
    across, along = _chosen(_chords(right, reflex), _chords(up.T, reflex.T), reflex.shape)
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
        template = 'the map has {count} rectangles or more; at most {most} are allowed'
        raise WorldFull(template, count=count, most=most)


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


def _chosen(across: _Chords, along: _Chords, shape: tuple[int, int]) -> tuple[_Chords, _Chords]:
    """Return the chords that are drawn: of those that meet others only one direction."""
    meet_across = _meets(across, _points(along, shape[::-1]).T)
    meet_along = _meets(along, _points(across, shape).T)
    if np.count_nonzero(meet_across) >= np.count_nonzero(meet_along):
        return across, _Chords(*(each[~meet_along] for each in along))
    return _Chords(*(each[~meet_across] for each in across)), along


def _meets(chords: _Chords, points: Flags) -> Flags:
    """Return whether each chord has one of some lattice points, (m, n) bool."""
    counts = np.cumsum(np.pad(points, ((0, 0), (1, 0))), axis=1, dtype=np.int32)
    return counts[chords.lines, chords.ends + 1] > counts[chords.lines, chords.begins]


def _points(chords: _Chords, shape: tuple[int, int]) -> Flags:
    """Return (m, n) bool: whether a lattice point is on a chord."""
    further = _Chords(chords.lines, chords.begins, chords.ends + 1)
    return _drawn(further, (shape[0], shape[1] + 1))[:, :-1]


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
