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

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
import itertools

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.islands import Graph, ranges, Rows
from physsim_ros.model.arrays import Floats

# Up to so many rows are solved as one matrix. For larger ones numpy's algebra uses threads, whose
# waiting for each other takes up to a thousand times as long where another program is busy.
DENSE = 48
# Joints may say the same twice, as the four of a parallelogram do; so little give lets them.
_GIVE = 1e-9

# What is left of a row beside those before it, as a share of its own, when it follows from them.
_DEPENDENT = 1e-5


class Equations:
    """
    Groups of equations; rows of different groups do not meet.

    :param groups: the rows of each, which hang together
    :param left: (k,) of each pair of sides that push the same body the one; every pair comes both
        ways round, and side s is of row s modulo `count`
    :param right: (k,) the other one
    :param count: of rows

    :ivar left: (l,) of each number of the matrices the one side
    :ivar right: (l,) the other one
    """

    def __init__(self, groups: Sequence[Rows], left: Rows, right: Rows, count: int) -> None:
        one, other = left % count, right % count
        groups = sorted(groups, key=len)
        rungs = [group for group in groups if len(group) <= DENSE]
        following = [0] * len(rungs)
        self._parts: list[_Block | _Ladder] = []
        first = start = 0
        for size, alike in itertools.groupby(rungs, key=len):
            block = _Block(len(list(alike)), size, first, start)
            self._parts.append(block)
            first, start = block.last, block.end
        graph = Graph(one, other, count)
        short = len(rungs)
        for group in groups[short:]:
            cut = _rungs(graph.from_end(int(group[0])))
            ladder = _Ladder(tuple(map(len, cut)), first, start)
            self._parts.append(ladder)
            rungs += cut
            following += [*ladder.sizes[1:], 0]
            first, start = ladder.last, ladder.end
        self._numbers = start
        # The rows in the order in which they are solved.
        self._order: Rows = np.concatenate([np.empty(0, np.intp), *rungs])
        sizes, after = np.array([*map(len, rungs)], np.intp), np.array(following, np.intp)
        starts = np.cumsum(sizes * (sizes + after)) - sizes * (sizes + after)

        def of_rows(values: Rows) -> Rows:
            result = np.empty(count, np.intp)
            result[self._order] = values
            return result

        # Of each row: its rung and its place there, and where in the matrices its line begins,
        # that of the rung with itself and that with the next one.
        rung = of_rows(np.repeat(np.arange(len(rungs)), sizes))
        slot = of_rows(ranges(np.zeros_like(sizes), sizes))
        line = starts[rung] + slot * sizes[rung]
        line_on = starts[rung] + sizes[rung] ** 2 + slot * after[rung]
        self._diagonal = (line + slot)[self._order]
        # What leads back a rung is the mirror image of what leads on to this one.
        forth = rung[other] >= rung[one]
        self.left, self.right, one, other = (each[forth] for each in (left, right, one, other))
        self._at = np.where(rung[other] == rung[one], line[one], line_on[one]) + slot[other]

    def solve(self, shared: Floats, wanted: Floats, active: NDArray[np.bool_]) -> Floats:
        """
        Return the unknown of each row.

        :param shared: (l,) what each pair of sides adds to the matrices
        :param wanted: (r,) the right hand side; or (r, k), several of them
        :param active: (r,) whether a row counts; the unknown of one that does not is 0
        :return: of the shape of `wanted`
        """
        matrices = self._matrices(shared, active)
        matrices[self._diagonal] *= 1.0 + _GIVE
        several = wanted.reshape(len(wanted), -1)
        ordered = np.where(active[:, None], several, 0.0)[self._order]
        for part in self._parts:
            part.solve(matrices, ordered)
        unknown = np.empty_like(several)
        unknown[self._order] = ordered
        return unknown.reshape(wanted.shape)

    def dependent(self, shared: Floats, active: NDArray[np.bool_]) -> list[int]:
        """
        Return the rows that follow from those that come before them in the order of solving.

        :param shared: (l,) what each pair of sides adds to the matrices
        :param active: (r,) whether a row counts
        """
        matrices = self._matrices(shared, active)
        least = _DEPENDENT * matrices[self._diagonal]
        follows = np.zeros(len(active), np.bool_)
        for part in self._parts:
            part.find_dependent(matrices, least, follows)
        found: list[int] = self._order[follows].tolist()
        return found

    def _matrices(self, shared: Floats, active: NDArray[np.bool_]) -> Floats:
        """Return all matrices one after the other; a row that does not count says nothing."""
        if not active.all():
            count = len(active)
            shared = shared * (active[self.left % count] & active[self.right % count])
        numbers = np.bincount(self._at, shared, self._numbers).astype(np.float64, copy=False)
        numbers[self._diagonal] += ~active[self._order]
        return numbers


def _follow(matrices: Floats, least: Floats) -> NDArray[np.bool_]:
    """
    Eliminate the first rows of matrices one by one, but for those that follow from others.

    :param matrices: (k, n, n) symmetric; in the end, what is left of the other rows
    :param least: (k, m) of what each of the first rows has at least, where it says something new
    :return: (k, m) bool: which follow
    """
    follows = np.zeros(least.shape, np.bool_)
    if _all_new(matrices, least):
        return follows
    for place in range(least.shape[1]):
        pivot = matrices[:, place, place]
        follows[:, place] = pivot <= least[:, place]
        # A row meets few of the others.
        met = np.flatnonzero(matrices[~follows[:, place], place].any(axis=0))
        if not len(met) or met[-1] <= place:
            continue
        after = slice(place + 1, met[-1] + 1)
        rest = matrices[:, after, place]
        share = rest / np.where(follows[:, place], np.inf, pivot)[:, None]
        matrices[:, after, after] -= rest[:, :, None] * share[:, None, :]
    return follows


def _all_new(matrices: Floats, least: Floats) -> bool:
    """Eliminate all the first rows at once, if none of them follows; tell whether so."""
    size = least.shape[1]
    own, across = matrices[:, :size, :size], matrices[:, :size, size:]
    try:
        factors = np.linalg.cholesky(own)
    except np.linalg.LinAlgError:
        return False
    # The squares are what row by row elimination finds on the diagonal.
    if not (np.diagonal(factors, axis1=1, axis2=2) ** 2 > least).all():
        return False
    matrices[:, size:, size:] -= across.transpose(0, 2, 1) @ np.linalg.solve(own, across)
    return True


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

    @property
    def last(self) -> int:
        """Where their rows end."""
        return self.first + self.count * self.size

    @property
    def end(self) -> int:
        """Where their matrices end."""
        return self.start + self.count * self.size**2

    def solve(self, matrices: Floats, ordered: Floats) -> None:
        """Put the unknowns in the place of the right hand side."""
        rows = slice(self.first, self.last)
        right = ordered[rows].reshape(self.count, self.size, -1)
        solved = np.linalg.solve(self._own(matrices), right)
        ordered[rows] = solved.reshape(self.last - self.first, -1)

    def find_dependent(self, matrices: Floats, least: Floats, follows: NDArray[np.bool_]) -> None:
        """Note which rows follow from those before them; see `_follow`."""
        rows = slice(self.first, self.last)
        bounds = least[rows].reshape(self.count, self.size)
        follows[rows] = _follow(self._own(matrices), bounds).ravel()

    def _own(self, matrices: Floats) -> Floats:
        numbers = slice(self.start, self.end)
        return matrices[numbers].reshape(self.count, self.size, self.size)


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

    @property
    def last(self) -> int:
        """Where their rows end."""
        return self.first + sum(self.sizes)

    @property
    def end(self) -> int:
        """Where their matrices end."""
        across = sum(size * following for size, following in itertools.pairwise(self.sizes))
        return self.start + sum(size**2 for size in self.sizes) + across

    def solve(self, matrices: Floats, ordered: Floats) -> None:
        """Eliminate from rung to rung up, and put in what is known then from rung to rung down."""
        climbed: list[tuple[slice, NDArray[np.floating]]] = []
        taken: NDArray[np.floating] | None = None
        several = ordered.shape[1]
        for rows, own, across in self._climb(matrices):
            size, following = across.shape
            right = np.empty((size, following + several))
            right[:, :following] = across
            right[:, following:] = ordered[rows]
            left = own
            if taken is not None:
                left = own - taken[:, :size]
                right[:, following:] -= taken[:, size:]
            solved = np.linalg.solve(left, right)
            taken = right[:, :following].T @ solved
            climbed.append((rows, solved))
        known = np.empty((0, several))
        for rows, solved in reversed(climbed):
            following = len(known)
            known = ordered[rows] = solved[:, following:] - solved[:, :following] @ known

    def find_dependent(self, matrices: Floats, least: Floats, follows: NDArray[np.bool_]) -> None:
        """Note which rows follow from those before them; see `_follow`."""
        left: Floats = np.zeros((1, 1, 1))
        for rows, own, across in self._climb(matrices):
            size, following = across.shape
            both = np.zeros((1, size + following, size + following))
            both[0, :size, :size] = own
            both[0, :size, size:] = across
            both[0, size:, :size] = across.T
            both[:, :size, :size] += left
            follows[rows] = _follow(both, least[None, rows])
            left = both[:, size:, size:]

    def _climb(self, matrices: Floats) -> Iterator[tuple[slice, Floats, Floats]]:
        """Yield of each rung its rows, its matrix with itself, and that with the next one."""
        first, start = self.first, self.start
        for size, following in itertools.zip_longest(self.sizes, self.sizes[1:], fillvalue=0):
            last, across = first + size, start + size * size
            end = across + size * following
            own = matrices[start:across].reshape(size, size)
            yield slice(first, last), own, matrices[across:end].reshape(size, following)
            first, start = last, end


def _rungs(levels: Sequence[Rows]) -> list[Rows]:
    """Put levels together, since a few larger matrices are solved faster than many small ones."""
    rungs: list[list[Rows]] = [[]]
    rows = 0
    for level in levels:
        if rungs[-1] and rows + len(level) > DENSE // 2:
            rungs.append([])
            rows = 0
        rungs[-1].append(level)
        rows += len(level)
    return [np.concatenate(each) for each in rungs]
