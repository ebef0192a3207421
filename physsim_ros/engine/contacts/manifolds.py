# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Manifolds: the contact points of two bodies, with their normal.

The engine does not list pairs that sleep or have parted; those keep their last known manifolds. A
manifold is a column of five numbers: normal, from the body of the lesser id to the other one;
count of points; mean point [m].
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from physsim_ros.engine.batch_io import Ids
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.contacts.pair_ids import find_pairs, NO_PAIRS, Renaming
from physsim_ros.model.arrays import Floats, Ints
import pymunk
from pymunk._chipmunk_cffi import lib

# ruff: noqa: SLF001 - Pymunk reads a manifold in a microsecond only so

NO_MANIFOLDS: Floats = np.empty((5, 0))


def _read_manifold(arbiter: pymunk.Arbiter, sign: int) -> tuple[float, ...]:
    """
    Return the manifold of two shapes that touch.

    :param sign: -1 where the engine has the body of the greater id first, else 1
    """
    found = lib.cpArbiterGetContactPointSet(arbiter._arbiter)
    points = [found.points[number] for number in range(found.count)]
    count = max(1, found.count)
    x = sum((point.pointA.x + point.pointB.x) / 2 for point in points) / count
    y = sum((point.pointA.y + point.pointB.y) / 2 for point in points) / count
    return sign * found.normal.x, sign * found.normal.y, found.count, x, y


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


class SleepingPairs(NamedTuple):
    """
    Touching pairs of which a body sleeps.

    :ivar ids: (k, 2) uint64: the engine's ids of the bodies, the lesser one first
    :ivar impulses: (k, 2) float64: of their last step awake [N s]
    :ivar manifolds: (5, k) float64: their last ones
    """

    ids: Ids = NO_PAIRS
    impulses: Floats = np.empty((0, 2))
    manifolds: Floats = NO_MANIFOLDS

    def without_body(self, body: int) -> SleepingPairs:
        """Return the pairs without those of a body, by its id."""
        stays = (self.ids != body).all(axis=1)
        return SleepingPairs(self.ids[stays], self.impulses[stays], self.manifolds[:, stays])


def read_sleeping_pairs(table: BodyTable, rows: Ints) -> SleepingPairs:
    """
    Return the sleeping pairs as the engine keeps them, shape by shape.

    :param rows: of sleeping bodies; the pairs of other ones are left out
    """
    found: dict[object, tuple[tuple[int, int], tuple[float, float], tuple[float, ...]]] = {}

    def add_arbiter(arbiter: pymunk.Arbiter) -> None:
        a, b = (body.id for body in arbiter.bodies)
        sign = 1 if a < b else -1
        impulse = sign * arbiter.total_impulse
        manifold = _read_manifold(arbiter, sign)
        # By the pair of shapes.
        found[arbiter._arbiter] = (min(a, b), max(a, b)), (impulse.x, impulse.y), manifold

    for row in rows.tolist():
        table.bodies[row].pm_body.each_arbiter(add_arbiter)
    if not found:
        return SleepingPairs()
    ids, impulses, manifolds = zip(*found.values(), strict=True)
    return SleepingPairs(
        np.array(ids, np.uint64), np.array(impulses, np.float64), np.array(manifolds, np.float64).T
    )
