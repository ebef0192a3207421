# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pairs of bodies by the engine's ids of the two, the lesser one first."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.batch_io import Ids
from physsim_ros.model.arrays import Flags, Floats

# Multiplier of Fibonacci hashing, 2^64 over the golden ratio (Knuth, The Art of Computer
# Programming 3, 6.4): makes one key of two ids.
_SPREAD = np.uint64(0x9E3779B97F4A7C15)

NO_PAIRS: Ids = np.empty((0, 2), np.uint64)


def oriented(pairs: Ids) -> tuple[Ids, Floats]:
    """Return pairs with the lesser id first, and (k, 1) float64: -1 where that swaps one."""
    # Column by column: numpy sorts pairs ten times as slowly.
    first, second = pairs.T
    signs = np.where(first > second, -1.0, 1.0)[:, None]
    return np.column_stack((np.minimum(first, second), np.maximum(first, second))), signs


def same_ids(one: Ids, other: Ids) -> bool:
    """Return whether two arrays of ids or pairs are equal, in half the time of numpy."""
    return one is other or (len(one) == len(other) and not np.count_nonzero(one != other))


def find_pairs(pairs: Ids, listing: Ids) -> tuple[NDArray[np.intp], Flags]:
    """
    Find pairs in a listing of pairs.

    :return: (k,) intp: a row of the listing for each pair, and (k,) bool: whether it has the pair
    """
    if len(listing) == 0:
        return np.zeros(len(pairs), np.intp), np.zeros(len(pairs), np.bool_)
    wanted, keys = (each[:, 0] * _SPREAD + each[:, 1] for each in (pairs, listing))
    # Of a pair that is listed twice the first one, whatever the ids are.
    order = np.argsort(keys, kind='stable')
    place = np.minimum(np.searchsorted(keys, wanted, sorter=order), len(keys) - 1)
    rows = order[place]
    # Another pair may have the same key: then this one counts as not found.
    # Column by column: numpy compares pairs six times as slowly.
    (a, b), (first, second) = listing.T, pairs.T
    return rows, (a[rows] == first) & (b[rows] == second)


class Renaming:
    """
    The ids of the same bodies in two spaces.

    :param old_ids: (n,) uint64: in one of them
    :param ids: (n,) uint64: in the other one
    """

    def __init__(self, old_ids: Ids, ids: Ids) -> None:
        ascending = np.argsort(old_ids)
        self._old_ids = old_ids[ascending]
        self._ids = ids[ascending]

    def rename_pairs(self, pairs: Ids, values: Floats) -> tuple[Ids, Floats]:
        """
        Return pairs under their other ids, with their values.

        A pair with a body that has no other id, since it was removed, is dropped.

        :param values: (k, c) float64; the first two columns have a direction, which is reversed
            where the ids of a pair are swapped
        """
        known = np.isin(pairs, self._old_ids).all(axis=1)
        pairs, signs = oriented(self._ids[np.searchsorted(self._old_ids, pairs[known])])
        values = values[known]
        values[:, :2] *= signs
        return pairs, values
