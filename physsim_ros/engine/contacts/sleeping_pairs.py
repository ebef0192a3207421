# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pairs of sleeping bodies, whose contacts the engine does not list."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from physsim_ros.engine.batch_io import Ids
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.contacts.contact import read_contact
from physsim_ros.engine.contacts.manifolds import manifold_of, NO_MANIFOLDS
from physsim_ros.engine.contacts.pair_ids import NO_PAIRS
from physsim_ros.model.arrays import Floats, Ints
import pymunk


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
        manifold = manifold_of(read_contact(arbiter), sign)
        key = arbiter._arbiter  # noqa: SLF001 - identifies a pair of shapes
        found[key] = (min(a, b), max(a, b)), (impulse.x, impulse.y), manifold

    for row in rows.tolist():
        table.bodies[row].engine.each_arbiter(add_arbiter)
    if not found:
        return SleepingPairs()
    ids, impulses, manifolds = zip(*found.values(), strict=True)
    return SleepingPairs(
        np.array(ids, np.uint64), np.array(impulses, np.float64), np.array(manifolds, np.float64).T
    )
