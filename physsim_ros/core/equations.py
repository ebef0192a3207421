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
Linear equations whose rows meet where two joints push the same body: solved group by group.

Law: exact but for rounding, whatever the order of the rows. A long group, as a chain is one, is
cut into rungs that are climbed one by one; its cost grows with its length, not with the cube.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
import itertools
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from physsim_ros.core.snapshot import Floats

# Up to so many rows are solved as one matrix. For larger ones numpy's algebra uses threads, whose
# waiting for each other takes up to a thousand times as long where another program is busy.
DENSE = 48
# Joints may say the same twice, as the four of a parallelogram do; so little give lets them.
_GIVE = 1e-9

# What is left of a row beside those before it, as a share of its own, when it follows from them.
_DEPENDENT = 1e-5

Meeting = tuple[int, int]


class _Spot(NamedTuple):
    """Where a row is: its rung, its place there, and where matrices with that and the next are."""

    rung: int
    slot: int
    own: int
    size: int
    across: int
    following: int


class Equations:
    """
    Groups of equations; rows of different groups do not meet.

    :param groups: the rows of each
    :param sides: pairs of sides that push the same body; side s is of row s modulo `count`
    :param count: of rows

    :ivar left: (k,) one side of each number of the matrices
    :ivar right: (k,) the other one
    """

    def __init__(
        self, groups: Iterable[Sequence[int]], sides: Sequence[Meeting], count: int
    ) -> None:
        met: dict[int, list[int]] = {}
        for one, other in sides:
            met.setdefault(one % count, []).append(other % count)
        self._blocks: list[_Block] = []
        self._ladders: list[_Ladder] = []
        spots: dict[int, _Spot] = {}
        self._groups = list(groups)
        small: list[Sequence[int]] = []
        start = 0
        for group in self._groups:
            if len(group) <= DENSE:
                small.append(group)
            else:
                start = self._add_ladder(_rungs(group, met), spots, start)
        for size, same in itertools.groupby(sorted(small, key=len), key=len):
            start = self._add_block(list(same), size, spots, start)
        self._numbers = start
        self._order = np.array([*spots], np.intp)
        self._diagonal = np.array(
            [spot.own + spot.slot * (spot.size + 1) for spot in spots.values()], np.intp
        )
        self._meet(sides, spots, count)

    def _add_ladder(self, rungs: list[list[int]], spots: dict[int, _Spot], start: int) -> int:
        """Lay out the matrices of a long group; return where the next ones begin."""
        sizes = [len(each) for each in rungs]
        self._ladders.append(_Ladder(tuple(sizes), len(spots), start))
        # A number between two groups is left out, so that their rungs are no neighbours.
        rung = 2 * len(spots)
        for rows, following in itertools.zip_longest(rungs, sizes[1:], fillvalue=0):
            assert isinstance(rows, list)  # noqa: S101 - the longer of the two
            size = len(rows)
            across = start + size * size
            for slot, row in enumerate(rows):
                spots[row] = _Spot(rung, slot, start, size, across, following)
            start = across + size * following
            rung += 1
        return start

    def _add_block(
        self, groups: list[Sequence[int]], size: int, spots: dict[int, _Spot], start: int
    ) -> int:
        """Lay out the matrices of short groups of one size; return where the next ones begin."""
        self._blocks.append(_Block(len(groups), size, len(spots), start))
        for rows in groups:
            rung = 2 * len(spots)
            for slot, row in enumerate(rows):
                spots[row] = _Spot(rung, slot, start, size, 0, 0)
            start += size * size
        return start

    def _meet(self, sides: Sequence[Meeting], spots: dict[int, _Spot], count: int) -> None:
        """Find where in the matrices each pair of sides counts."""
        found: list[tuple[int, int, int]] = []
        for one, other in sides:
            spot, to = spots[one % count], spots[other % count]
            if to.rung == spot.rung:
                found.append((one, other, spot.own + spot.slot * spot.size + to.slot))
            elif to.rung > spot.rung:
                at = spot.across + spot.slot * spot.following + to.slot
                found.append((one, other, at))
            # What leads back a rung is the mirror image of what leads on to this one.
        self.left, self.right, self._spots = np.array(found, np.intp).reshape(-1, 3).T.copy()

    def solve(self, shared: Floats, wanted: Floats, active: NDArray[np.bool_]) -> Floats:
        """
        Return the unknown of each row.

        :param shared: (k,) what each pair of sides adds to the matrices
        :param wanted: (r,) the right hand side
        :param active: (r,) whether a row counts; the unknown of one that does not is 0
        """
        if not active.all():
            count = len(active)
            shared = shared * (active[self.left % count] & active[self.right % count])
            wanted = np.where(active, wanted, 0.0)
        matrices = np.bincount(self._spots, shared, self._numbers).astype(np.float64, copy=False)
        matrices[self._diagonal] *= 1.0 + _GIVE
        matrices[self._diagonal] += ~active[self._order]
        ordered = wanted[self._order]
        for block in self._blocks:
            block.solve(matrices, ordered)
        for ladder in self._ladders:
            ladder.solve(matrices, ordered)
        unknown = np.empty_like(wanted)
        unknown[self._order] = ordered
        return unknown

    def dependent(self, shared: Floats, active: NDArray[np.bool_]) -> list[int]:
        """
        Return the rows that follow from those before them.

        :param shared: (k,) what each pair of sides adds to the matrices
        :param active: (r,) whether a row counts
        """
        count = len(active)
        counting = ([row for row in sorted(group) if active[row]] for group in self._groups)
        groups = sorted(filter(None, counting), key=len)
        sizes = np.array([len(group) for group in groups], np.intp)
        starts = np.concatenate(((0,), np.cumsum(sizes**2)))
        # For each row: where the matrix of its group begins, how wide that is, its place there.
        spots = np.zeros((3, count), np.intp)
        for group, start, size in zip(groups, starts.tolist(), sizes.tolist(), strict=False):
            spots[:, group] = np.full(size, start), np.full(size, size), np.arange(size)
        rows, columns = self.left % count, self.right % count
        both = active[rows] & active[columns]
        start, width, slot = spots[:, rows[both]]
        at = start + width * slot + spots[2, columns[both]]
        numbers = np.bincount(at, shared[both], starts[-1]).astype(np.float64, copy=False)
        found: list[int] = []
        first = 0
        for size, alike in itertools.groupby(groups, key=len):
            chosen = np.array(list(alike))
            end = first + chosen.size * size
            found += chosen[_follow(numbers[first:end].reshape(-1, size, size))].tolist()
            first = end
        return found


def _follow(halves: Floats) -> NDArray[np.bool_]:
    """
    Tell which rows of matrices follow from those before them.

    :param halves: (k, n, n) symmetric matrices, of which one half may be left out
    :return: (k, n)
    """
    matrices = np.where(halves != 0.0, halves, halves.transpose(0, 2, 1))
    count, size, _ = matrices.shape
    least = _DEPENDENT * np.diagonal(matrices, axis1=1, axis2=2)
    follows = np.zeros((count, size), np.bool_)
    for place in range(size):
        pivot = matrices[:, place, place]
        follows[:, place] = pivot <= least[:, place]
        pivot = np.where(follows[:, place], np.inf, pivot)
        # A row meets few of the others.
        after = slice(place + 1, None)
        met = np.flatnonzero(matrices[:, after, place].any(axis=0)) + place + 1
        rest = matrices[:, met, place]
        share = rest / pivot[:, None]
        matrices[:, met[:, None], met] -= rest[:, :, None] * share[:, None, :]
    return follows


@dataclass(frozen=True, slots=True, eq=False)
class _Block:
    """
    Groups of the same number of rows, which are solved side by side.

    :param count: of groups
    :param size: rows of each
    :param first: where their rows begin
    :param start: where their matrices begin
    """

    count: int
    size: int
    first: int
    start: int

    def solve(self, matrices: Floats, ordered: Floats) -> None:
        """Put the unknowns in the place of the right hand side."""
        count, size, first, start = self.count, self.size, self.first, self.start
        last, end = first + count * size, start + count * size * size
        own = matrices[start:end].reshape(count, size, size)
        solved = np.linalg.solve(own, ordered[first:last].reshape(count, size, 1))
        ordered[first:last] = solved.ravel()


@dataclass(frozen=True, slots=True, eq=False)
class _Ladder:
    """
    A long group, cut into rungs of which each meets only the one before and the one after.

    :param sizes: rows of each rung
    :param first: where their rows begin
    :param start: where their matrices begin: each rung with itself, then with the next one
    """

    sizes: tuple[int, ...]
    first: int
    start: int

    def solve(self, matrices: Floats, ordered: Floats) -> None:
        """Eliminate from rung to rung up, and put in what is known then from rung to rung down."""
        first, start = self.first, self.start
        climbed: list[tuple[slice, NDArray[np.floating]]] = []
        taken: NDArray[np.floating] | None = None
        for size, following in itertools.zip_longest(self.sizes, self.sizes[1:], fillvalue=0):
            across, end = start + size * size, start + size * (size + following)
            own = matrices[start:across].reshape(size, size)
            rows = slice(first, first + size)
            right = np.empty((size, following + 1))
            right[:, :following] = matrices[across:end].reshape(size, following)
            right[:, following] = ordered[rows]
            if taken is not None:
                own = own - taken[:, :-1]
                right[:, following] -= taken[:, -1]
            solved = np.linalg.solve(own, right)
            taken = right[:, :following].T @ solved
            climbed.append((rows, solved))
            first, start = first + size, end
        known = np.empty(0)
        for rows, solved in reversed(climbed):
            known = ordered[rows] = solved[:, -1] - solved[:, :-1] @ known


def _rungs(rows: Sequence[int], met: dict[int, list[int]]) -> list[list[int]]:
    """
    Cut a group into rungs: by how many joints lead there from its one end.

    :param rows: of the group
    :param met: for each row those that it meets, itself too
    """
    start = _levels(rows[0], met)[-1][0]
    rungs: list[list[int]] = [[]]
    for level in _levels(start, met):
        if rungs[-1] and len(rungs[-1]) + len(level) > DENSE // 2:
            rungs.append([])
        rungs[-1] += level
    return rungs


def _levels(start: int, met: dict[int, list[int]]) -> list[list[int]]:
    """Return rows by the number of joints that lead there."""
    levels, known = [[start]], {start}
    while levels[-1]:
        near = dict.fromkeys(other for row in levels[-1] for other in met[row])
        levels.append([row for row in near if row not in known])
        known |= near.keys()
    return levels[:-1]
