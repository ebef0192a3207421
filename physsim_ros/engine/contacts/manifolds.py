# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Manifolds: the contact points of two bodies, with their normal.

A manifold is a column of five numbers: normal, from the body of the lesser id to the other one;
count of points; mean point [m].
"""

from __future__ import annotations

import numpy as np
from physsim_ros.engine.batch_io import Ids
from physsim_ros.engine.contacts.contact import Contact
from physsim_ros.engine.contacts.pair_ids import find_pairs, NO_PAIRS, Renaming
from physsim_ros.model.arrays import Floats

NO_MANIFOLDS: Floats = np.empty((5, 0))


def manifold_of(contact: Contact, sign: int) -> tuple[float, ...]:
    """
    Return the manifold of a contact.

    :param sign: -1 where the engine has the body of the greater id first, else 1
    """
    normal, count = sign * contact.normal, len(contact.points)
    mean = sum((each.a + each.b) / 2 for each in contact.points) / max(1, count)
    return normal.real, normal.imag, count, mean.real, mean.imag


class LastManifolds:
    """
    The last known manifolds: at the end of the last frame, or at a first touch since then.

    :ivar ids: (k, 2) uint64: the pairs at the end of the last frame
    :ivar manifolds: (5, k) float64: their manifolds then
    """

    def __init__(self) -> None:
        self.ids: Ids = NO_PAIRS
        self.manifolds: Floats = NO_MANIFOLDS
        # Of each step: the pairs, and their manifolds.
        self._first_touches: list[tuple[Ids, Floats]] = []

    def add_first_touches(self, pairs: Ids, manifolds: Floats) -> None:
        """
        Add pairs that begin to touch.

        :param pairs: (k, 2) uint64
        :param manifolds: (5, k) float64
        """
        self._first_touches.append((pairs, manifolds))

    def end_frame(self, ids: Ids, manifolds: Floats) -> None:
        """Replace all manifolds by those at the end of a frame."""
        self.ids, self.manifolds = ids, manifolds
        self.drop_first_touches()

    def drop_first_touches(self) -> None:
        """Drop the first touches since the end of the last frame."""
        self._first_touches.clear()

    def of_pairs(self, pairs: Ids) -> Floats:
        """Return (5, m) float64: the last known manifolds of pairs."""
        manifolds = np.zeros((5, len(pairs)))
        manifolds[0] = 1.0
        rows, found = find_pairs(pairs, self.ids)
        manifolds[:, found] = self.manifolds[:, rows[found]]
        for touching, first in self._first_touches:
            rows, found = find_pairs(pairs, touching)
            manifolds[:, found] = first[:, rows[found]]
        return manifolds

    def copy(self, old: LastManifolds, renaming: Renaming) -> None:
        """Copy the manifolds of the same bodies under other ids."""
        self.ids, self.manifolds = _renamed(old.ids, old.manifolds, renaming)
        self._first_touches = [_renamed(*each, renaming) for each in old._first_touches]


def _renamed(pairs: Ids, manifolds: Floats, renaming: Renaming) -> tuple[Ids, Floats]:
    """Return pairs under their other ids, with their manifolds."""
    ids, rows = renaming.rename_pairs(pairs, manifolds.T)
    return ids, rows.T
