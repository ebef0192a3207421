# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Search of the graphs of contacts and joints, given as arrays of rows and pairs of rows."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Flags

Rows = NDArray[np.intp]


def ranges(first: Rows, count: Rows) -> Rows:
    """Return the integers of several ranges, one range after the other."""
    ends = np.cumsum(count)
    rows: Rows = np.repeat(first - ends + count, count)
    rows += np.arange(len(rows))
    return rows


def reachable(marked: Flags, pairs: Rows) -> Flags:
    """
    Return (n,) bool: marked nodes, and all that are connected with one by pairs.

    Breadth-first search, in as many rounds as the longest shortest path has pairs.

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


def components(count: int, pairs: Rows) -> Rows:
    """
    Return (n,) intp: the least node that each node is connected with by pairs.

    Pointer jumping (Y. Shiloach and U. Vishkin, 1982), in rounds by the logarithm of the longest
    path.

    :param count: of nodes
    :param pairs: (k, 2) intp: nodes that are connected
    """
    least = np.arange(count)
    one, other = pairs.T
    while True:
        lesser = np.minimum(least[one], least[other])
        found = least.copy()
        for side in (one, other):
            np.minimum.at(found, side, lesser)
            np.minimum.at(found, least[side], lesser)
        found = found[found]
        if np.array_equal(found, least):
            return found
        least = found
