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
        # By ids of the pair: the sign of the normal, and the contact.
        self._first_touches: dict[tuple[int, int], tuple[int, Contact]] = {}

    def add_first_touch(self, a: int, b: int, contact: Contact) -> None:
        """Add the manifold of two bodies, by their ids, that begin to touch."""
        self._first_touches[min(a, b), max(a, b)] = (1 if a < b else -1, contact)

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
        if self._first_touches:
            for row, pair in enumerate(map(tuple, pairs.tolist())):
                if pair in self._first_touches:
                    sign, contact = self._first_touches[pair]
                    manifolds[:, row] = manifold_of(contact, sign)
        return manifolds

    def copy(self, old: LastManifolds, renaming: Renaming) -> None:
        """Copy the manifolds of the same bodies under other ids."""
        self.ids, rows = renaming.rename_pairs(old.ids, old.manifolds.T)
        self.manifolds = rows.T
        for pair, (sign, contact) in old._first_touches.items():
            (ids, signs) = renaming.rename_pairs(
                np.array([pair], np.uint64), np.full((1, 2), float(sign))
            )
            for (a, b), (same, _) in zip(ids.tolist(), signs.tolist(), strict=True):
                self._first_touches[a, b] = (int(same), contact)
