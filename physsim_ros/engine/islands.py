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

"""Graphs as arrays: what meets at one place, and by how many meetings it hangs together."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Rows = NDArray[np.intp]


def ranges(first: Rows, count: Rows) -> Rows:
    """Return numbers in a row, so many from each first one on, one row after the other."""
    ends = np.cumsum(count)
    rows: Rows = np.repeat(first - ends + count, count)
    rows += np.arange(len(rows))
    return rows


def meetings(places: Rows, items: Rows) -> tuple[Rows, Rows]:
    """
    Return the pairs of items that are at one place, both ways round, and each with itself.

    :param places: (n,) of each item
    :param items: (n,)
    :return: (k,) and (k,)
    """
    order = np.argsort(places, kind='stable')
    _, sizes = np.unique(places, return_counts=True)
    first, count = (np.repeat(each, sizes) for each in (np.cumsum(sizes) - sizes, sizes))
    items = items[order]
    return np.repeat(items, count), items[ranges(first, count)]


def flood(marked: NDArray[np.bool_], pairs: Rows) -> NDArray[np.bool_]:
    """
    Return (n,) bool: marked nodes, and all that are connected with one by pairs.

    It takes as many rounds as the longest shortest path has pairs (breadth-first search).

    :param marked: (n,) bool
    :param pairs: (k, 2) intp: nodes that are connected
    """
    reached = marked.copy()
    one, other = pairs.T
    while True:
        near = reached[one] | reached[other]
        if not near.any():
            return reached
        reached[one[near]] = reached[other[near]] = True
        one, other = one[~near], other[~near]


class Graph:
    """
    What meets what.

    :param one: (k,) of each pair
    :param other: (k,) of each pair; every pair comes both ways round
    :param count: all are less
    """

    def __init__(self, one: Rows, other: Rows, count: int) -> None:
        order = np.argsort(one, kind='stable')
        self._near = other[order]
        self._first = np.searchsorted(one[order], np.arange(count + 1))

    def from_end(self, member: int) -> list[Rows]:
        """Return all that hangs together with a member, level by level from its one end."""
        return self._levels(int(self._levels(member)[-1][0]))

    def _levels(self, start: int) -> list[Rows]:
        """Return what hangs together by the number of meetings that lead there."""
        known = np.zeros(len(self._first) - 1, np.bool_)
        known[start] = True
        level = np.array([start], np.intp)
        levels = []
        while len(level):
            levels.append(level)
            first = self._first[level]
            near = np.unique(self._near[ranges(first, self._first[level + 1] - first)])
            level = near[~known[near]]
            known[level] = True
        return levels
