# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Contact report: contact points, normals and impulses, summed over the steps of a frame.

A Python callback a contact would double the cost of a step, so every step reads only pairs and
impulses in batch, and the last one of a frame their manifolds. A pair that has parted before the
frame ends has its manifold of the frame before, or of its first touch. The engine does not list
the contacts of sleeping bodies: while a pair sleeps, the impulses of its last step awake and its
last manifold are repeated.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from physsim_ros.engine.batch_io import BatchIO, Ids
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.contacts.contact_listing import (
    list_pairs,
    PairListing,
    set_overlap_manifolds,
    set_wall_manifolds,
)
from physsim_ros.engine.contacts.manifolds import (
    LastManifolds,
    NO_MANIFOLDS,
    read_sleeping_pairs,
    SleepingPairs,
)
from physsim_ros.engine.contacts.pair_ids import (
    find_pairs,
    NO_PAIRS,
    oriented,
    Renaming,
    same_ids,
)
from physsim_ros.engine.contacts.touches import Touches
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.snapshot import Contacts, NO_CONTACTS
from pymunk import batch

_F = batch.ArbiterFields
_PAIRS_AND_IMPULSES = _F.BODY_A_ID | _F.BODY_B_ID | _F.TOTAL_IMPULSE
_MANIFOLDS = _F.BODY_A_ID | _F.NORMAL | _F.CONTACT_COUNT
_MANIFOLDS |= _F.POINT_A_1 | _F.POINT_B_1 | _F.POINT_A_2 | _F.POINT_B_2
_NO_IMPULSES, _NO_SIGNS, _NO_SLEEPING = np.empty((0, 2)), np.empty((0, 1)), SleepingPairs()
# Greatest count of steps whose parted pairs are listed by step before they are merged.
_MOST_STEPS = 16


class ContactReport:
    """
    Sums of the impulses of contacts over the steps of a frame, with their manifolds.

    :param io: of a space whose `collision_persistence` is 1, so that the engine lists only
        contacts of the last step
    """

    def __init__(self, io: BatchIO) -> None:
        self._io = io
        # The pairs of the last step, in the engine's order, sleeping ones last: ids, the lesser
        # one first; sums of impulses in the frame; impulses of the step [N s].
        self._ids: Ids = NO_PAIRS
        self._sums: Floats = _NO_IMPULSES
        self._impulses: Floats = _NO_IMPULSES
        # Those of them that are awake as the engine lists them, and the signs of their impulses.
        self._listed: Ids = NO_PAIRS
        self._signs: Floats = _NO_SIGNS
        # Manifolds of the pairs, (5, m), where another space has made the last step.
        self._copied_manifolds: Floats | None = None
        self._sleeping = _NO_SLEEPING
        # The table at the step before and how often its slots had changed, by bodies that fall
        # asleep or wake; None where the contacts of that step were not read.
        self._slots: tuple[BodyTable, int] | None = None
        # Count of steps since the frame began.
        self._steps = 0
        # Pairs that touched at the end of an earlier step of the frame and not of the next: ids
        # and sums of impulses.
        self._parted: list[tuple[Ids, Floats]] = []
        # Pairs that began to touch in the frame, by the number of the step.
        self._begun: list[tuple[int, Ids]] = []
        self._last = LastManifolds()
        self._listing: PairListing | None = None

    def add_first_touches(self, touches: Touches) -> None:
        """Store the manifolds of shapes that begin to touch: they may part within the frame."""
        pairs, signs = oriented(touches.ids)
        manifolds = np.empty((5, len(pairs)))
        manifolds[:2] = (touches.normals * signs).T
        manifolds[2] = touches.counts
        manifolds[3:] = touches.places.mean(axis=(0, 2)).T
        self._last.add_first_touches(pairs, manifolds)

    def add_step(self, table: BodyTable) -> None:
        """
        Add the contacts of the step that the engine has just made.

        :param table: of the bodies, after that step
        """
        self._steps += 1
        self._copied_manifolds = None
        slots = table, table.slot_changes
        sleep_changed, read_before = slots != self._slots, self._slots is not None
        listed, impulses = self._io.read_contacts(_PAIRS_AND_IMPULSES)
        listed, impulses = listed.reshape(-1, 2), impulses.reshape(-1, 2)
        if not sleep_changed and same_ids(listed, self._listed):
            self._add_impulses(impulses)
            return
        self._listed, impulses = listed.copy(), impulses.copy()
        ids, self._signs = oriented(self._listed)
        if sleep_changed:
            self._sleeping = self._find_sleeping(table, ids)
            self._slots = slots
        ids = np.concatenate((ids, self._sleeping.ids))
        if not same_ids(ids, self._ids):
            # Without the pairs of the step before it is not known which of these are new.
            if read_before:
                self._add_begun(ids)
            self._begin_listing(ids)
        self._add_impulses(impulses)

    def _find_sleeping(self, table: BodyTable, listed: Ids) -> SleepingPairs:
        """Return the pairs of the step before that sleep now."""
        if not table.asleep.any():
            return _NO_SLEEPING
        if self._slots is None:
            return read_sleeping_pairs(table, np.flatnonzero(table.asleep))
        rows, asleep = table.rows_of(self._ids), np.append(table.asleep, False)
        # A sensor that moves wakes nobody: its pairs are listed, until they part.
        awake = table.columns.dynamic & ~asleep
        sleeps = asleep[rows].any(axis=1) & ~awake[rows].any(axis=1)
        sleeps &= ~find_pairs(self._ids, listed)[1]
        ids, last = self._ids[sleeps], self._last
        if np.array_equal(last.ids, self._ids):
            return SleepingPairs(ids, self._impulses[sleeps], last.manifolds[:, sleeps])
        manifolds = last.of_pairs(ids)
        # A replay takes no frames: the last ones may be as old as the first touch.
        before, slept = find_pairs(ids, self._sleeping.ids)
        manifolds[:, slept] = self._sleeping.manifolds[:, before[slept]]
        fallen = np.unique(rows[sleeps][~slept])
        read = read_sleeping_pairs(table, fallen[asleep[fallen]])
        found, known = find_pairs(ids, read.ids)
        known &= ~slept
        manifolds[:, known] = read.manifolds[:, found[known]]
        return SleepingPairs(ids, self._impulses[sleeps], manifolds)

    def _add_impulses(self, impulses: Floats) -> None:
        self._impulses = impulses * self._signs
        if len(self._sleeping.ids):
            self._impulses = np.concatenate((self._impulses, self._sleeping.impulses))
        self._sums += self._impulses

    def _add_begun(self, ids: Ids) -> None:
        """Store the pairs of a step that did not touch in the step before."""
        begun = ids[~find_pairs(ids, self._ids)[1]]
        if len(begun):
            self._begun.append((self._steps, begun))

    def _begin_listing(self, ids: Ids) -> None:
        """Replace the pairs by those of the step that has just been made."""
        # A pair that parts in the first step of a frame has not touched in it.
        if self._steps > 1:
            self._parted.append((self._ids, self._sums))
        self._ids, self._sums = ids, np.zeros(ids.shape)
        if len(self._parted) >= _MOST_STEPS:
            self._parted = [self._merge_parted()]

    def _merge_parted(self) -> tuple[Ids, Floats]:
        """
        Add the impulses of earlier steps to pairs that touch again.

        :return: ids and sums of impulses of the pairs that have parted
        """
        if not self._parted:
            return NO_PAIRS, np.empty((0, 2))
        ids, sums = (np.concatenate(each) for each in zip(*self._parted, strict=True))
        self._parted = []
        rows, found = find_pairs(ids, self._ids)
        for column in (0, 1):
            again = np.bincount(rows[found], sums[found, column], len(self._ids))
            self._sums[:, column] += again
        return ids[~found], sums[~found]

    def forget_body(self, body: int) -> None:
        """
        Drop the contacts of a body that was removed from the space since the last step.

        An id that is in no table counts as that of the walls.

        :param body: its id in the engine
        """
        stays = (self._ids != body).all(axis=1)
        listed = stays[: len(self._listed)]
        self._listed, self._signs = self._listed[listed], self._signs[listed]
        if self._copied_manifolds is not None:
            self._copied_manifolds = self._copied_manifolds[:, stays]
        self._ids, self._sums = self._ids[stays], self._sums[stays]
        self._impulses = self._impulses[stays]
        self._sleeping = self._sleeping.without_body(body)
        for number, (ids, sums) in enumerate(self._parted):
            stays = (ids != body).all(axis=1)
            self._parted[number] = ids[stays], sums[stays]
        self._begun = [(step, ids[(ids != body).all(axis=1)]) for step, ids in self._begun]

    def skip_step(self) -> None:
        """Drop all contacts: those of the step that has just been made are not read."""
        self._sleeping, self._slots = _NO_SLEEPING, None
        self._ids = self._listed = NO_PAIRS
        self._sums = self._impulses = _NO_IMPULSES
        self._signs = _NO_SIGNS
        self.clear()

    def clear(self) -> None:
        """Drop the sums since the last call of `take_contacts`."""
        self._parted, self._begun = [], []
        self._sums = np.zeros(self._sums.shape)
        self._steps = 0
        self._last.drop_first_touches()

    def copy_sums(self, old: ContactReport, old_ids: Ids, ids: Ids) -> None:
        """
        Copy the sums of another report, of the same bodies under other ids.

        :param old_ids: (n,) uint64: the engine's ids of the bodies there
        :param ids: (n,) uint64: their ids here
        """
        renaming = Renaming(old_ids, ids)
        self._steps = old._steps
        self._ids, self._sums = renaming.rename_pairs(old._ids, old._sums)
        self._impulses = np.zeros_like(self._sums)
        if old._steps:
            rows = renaming.rename_pairs(old._ids, old._read_manifolds().T)[1]
            self._copied_manifolds = rows.T
        self._parted = [renaming.rename_pairs(*each) for each in old._parted]
        self._begun = [
            (step, renaming.rename_pairs(ids, np.zeros(ids.shape))[0]) for step, ids in old._begun
        ]
        self._last.copy(old._last, renaming)

    def take_contacts(self, table: BodyTable, centers: Callable[[], Floats]) -> Contacts:
        """
        Return the contacts since the last call, each pair once, and begin the next sums.

        :param table: of the bodies; an id that is not in it belongs to the walls of `bounds`
        :param centers: returns (n, 2) float64: centres of mass [m], by which overlaps without
            points are placed
        """
        if self._steps == 0:
            return NO_CONTACTS
        steps, self._steps = self._steps, 0
        begun, self._begun = self._begun, []
        if not (len(self._ids) or self._parted):
            self._last.end_frame(NO_PAIRS, NO_MANIFOLDS)
            return replace(NO_CONTACTS, steps=steps)
        parted, parted_sums = self._merge_parted()
        touching, sums, manifolds = self._ids, self._sums, self._read_manifolds()
        if len(parted):
            touching, sums = (
                np.concatenate((touching, parted)),
                np.concatenate((sums, parted_sums)),
            )
            manifolds = np.concatenate((manifolds, self._last.of_pairs(parted)), axis=1)
        self._last.end_frame(self._ids, manifolds[:, : len(self._ids)])
        self._sums = np.zeros(self._sums.shape)
        if self._listing is None or not self._listing.is_of(touching, table):
            self._listing = list_pairs(touching, table)
        contacts, pointless = self._listing.merge_contacts(manifolds, sums, len(self._ids))
        if np.count_nonzero(pointless):
            with_wall, places = contacts.pairs[:, 1] < 0, centers()
            set_overlap_manifolds(contacts, np.flatnonzero(pointless & ~with_wall), places)
            set_wall_manifolds(contacts, np.flatnonzero(pointless & with_wall), places, table)
        begun_pairs, begun_in = _rows_of_begun(begun, table)
        return replace(contacts, steps=steps, begun=begun_pairs, begun_in=begun_in)

    def _read_manifolds(self) -> Floats:
        """
        Return (5, m) float64: the manifolds of the last step, sleeping pairs last.

        A request between that step and the end of the frame may have changed what the engine
        lists: bodies have been woken, or the space is another. Then the last known ones.
        """
        if self._copied_manifolds is not None:
            return self._copied_manifolds
        if not len(self._listed):
            return self._sleeping.manifolds
        ints, floats = self._io.read_contacts(_MANIFOLDS)
        firsts, counts = ints.reshape(-1, 2).T
        if not same_ids(firsts, self._listed[:, 0]):
            return self._last.of_pairs(self._ids)
        # Columns, because numpy adds them up five times as fast as pairs.
        columns = np.ascontiguousarray(floats.reshape(-1, 10).T)
        manifolds = np.empty((5, len(counts)))
        manifolds[:2] = columns[:2] * self._signs.T
        manifolds[2] = counts
        # On either body; the second point is zero where there is but one.
        first, second = columns[2:4] + columns[4:6], columns[6:8] + columns[8:10]
        np.add(first, second, out=manifolds[3:])
        manifolds[3:] *= 0.5 / np.maximum(counts, 1)
        if len(self._sleeping.ids):
            return np.concatenate((manifolds, self._sleeping.manifolds), axis=1)
        return manifolds


def _rows_of_begun(begun: list[tuple[int, Ids]], table: BodyTable) -> tuple[Ints, Ints]:
    """Return rows of pairs, each once a step, as `Contacts` has them, and their steps."""
    pairs, steps = [np.empty((0, 2), np.int64)], [np.empty(0, np.int64)]
    for step, ids in begun:
        # Rows of the walls are the greatest ones, and come second.
        rows = np.unique(np.sort(table.rows_of(ids), axis=1), axis=0)
        pairs.append(np.where(rows == len(table.bodies), -1, rows))
        steps.append(np.full(len(rows), step))
    return np.concatenate(pairs), np.concatenate(steps)
