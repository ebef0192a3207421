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
Contact report: contact points, normals and impulses, summed over the steps of a frame.

A Python callback a contact would double the cost of a step, so every step reads only pairs and
impulses in batch, and the last one of a frame their manifolds. A pair that has parted before the
frame ends keeps its manifold from the frame before, or from its first touch. The engine does not
list the contacts of sleeping bodies: while a pair sleeps, the impulses of its last step awake and
its last manifold are repeated.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.batch_io import BatchIO, Ids
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.model.arrays import Flags, Floats, Ints
from physsim_ros.model.snapshot import Contacts
import pymunk
from pymunk import batch

_F = batch.ArbiterFields
_FIRSTS_AND_IMPULSES = _F.BODY_A_ID | _F.TOTAL_IMPULSE
_PAIRS_AND_IMPULSES = _F.BODY_B_ID | _FIRSTS_AND_IMPULSES
_PLACES = _F.BODY_A_ID | _F.NORMAL | _F.CONTACT_COUNT
_PLACES |= _F.POINT_A_1 | _F.POINT_B_1 | _F.POINT_A_2 | _F.POINT_B_2
# So many listings of earlier steps are kept until they are added up.
_MOST_STEPS = 16
# Makes one key of two ids.
_SPREAD = np.uint64(0x9E3779B97F4A7C15)
# Normals whose mean is shorter than this have none.
OPPOSED = 1e-6


class ContactReport:
    """
    Sums up contacts from step to step until they are taken.

    :param io: of a space whose `collision_persistence` is 1, so that the engine lists only
        contacts of the last step
    """

    def __init__(self, io: BatchIO) -> None:
        self._io = io
        # Of the last step, in the engine's order: ids of each pair, the lesser one first, and the
        # sums of its impulses.
        self._ids: Ids = np.empty((0, 2), np.uint64)
        self._sums: Floats = np.empty((0, 2))
        # Which one the engine has first, and so which way round its impulses are.
        self._firsts: Ids = np.empty(0, np.uint64)
        self._signs: Floats = np.empty((0, 1))
        # The impulses of these in the last step.
        self._given: Floats = np.empty((0, 2))
        # Pairs that sleep, the impulses of their last step awake, and their places; they stand
        # behind the listed ones.
        self._sleeping = NO_SLEEPERS
        self._slot_changes = 0
        # Whether contacts of the step before were not read.
        self._unwatched = True
        # Steps since the frame began.
        self._steps = 0
        # The same of earlier steps of the frame, at whose ends other pairs touched.
        self._earlier: list[tuple[Ids, Floats]] = []
        # Where pairs touched at the end of the last frame: normal, count of points, mean point, a
        # column each; and where they touched first since then.
        self._places: tuple[Ids, Floats] = (self._ids, np.empty((5, 0)))
        self._begun: dict[tuple[int, int], tuple[int, pymunk.ContactPointSet]] = {}
        self._listing: _Listing | None = None
        # Whether no pair has begun to touch since the ids were read: then as many are the same.
        self.settled = False

    def begin(self, arbiter: pymunk.Arbiter, contact: pymunk.ContactPointSet) -> None:
        """Remember where two shapes touched first, should they part before the frame ends."""
        self.settled = False
        a, b = (body.id for body in arbiter.bodies)
        self._begun[min(a, b), max(a, b)] = (1 if a < b else -1, contact)

    def add_step(self, table: BodyTable) -> None:
        """
        Add the contacts of the step that the engine has just made.

        :param table: of the bodies, after that step
        """
        self._steps += 1
        if table.slot_changes != self._slot_changes:
            self._slot_changes, self.settled = table.slot_changes, False
        sleeping = len(self._sleeping[0])
        if self.settled:
            firsts, impulses = self._io.read_contacts(_FIRSTS_AND_IMPULSES)
            if len(firsts) == len(self._ids) - sleeping:
                # The engine turns a pair round as its bodies move, in a contact that goes on too.
                if not np.array_equal(firsts, self._firsts):
                    self._firsts, self._signs = firsts.copy(), self._signs_of(firsts)
                self._add_impulses(impulses.reshape(-1, 2))
                return
        ints, impulses = self._io.read_contacts(_PAIRS_AND_IMPULSES)
        self._firsts = ints[::2].copy()
        impulses = impulses.reshape(-1, 2).copy()
        ids, self._signs = _oriented(ints.reshape(-1, 2))
        self._sleeping = self._find_sleeping(table, ids)
        self._unwatched = False
        ids = np.concatenate((ids, self._sleeping[0]))
        if not np.array_equal(ids, self._ids):
            self._begin_listing(ids)
        self._add_impulses(impulses)
        self.settled = True

    def _find_sleeping(self, table: BodyTable, listed: Ids) -> tuple[Ids, Floats, Floats]:
        """Return pairs of the step before that sleep now, with their impulses and places then."""
        if not table.asleep.any():
            return NO_SLEEPERS
        if self._unwatched:
            return _read_sleeping(table)
        asleep = np.append(table.asleep, False)[table.rows_of(self._ids)].any(axis=1)
        asleep &= ~_find(self._ids, listed)[1]
        ids, places = self._ids[asleep], self._places
        if np.array_equal(places[0], self._ids):
            return ids, self._given[asleep], places[1][:, asleep]
        return ids, self._given[asleep], self._last_places(ids)

    def _add_impulses(self, impulses: Floats) -> None:
        self._given = np.concatenate((impulses * self._signs, self._sleeping[1]))
        self._sums += self._given

    def _signs_of(self, firsts: Ids) -> Floats:
        """Return (k, 1): -1 where the engine has another one of a pair first than its lesser."""
        return np.where(firsts == self._ids[: len(firsts), 0], 1.0, -1.0)[:, None]

    def _begin_listing(self, ids: Ids) -> None:
        """Go on with other pairs."""
        # What parts in the first step of a frame has not touched in it.
        if self._steps > 1:
            self._earlier.append((self._ids, self._sums))
        self._ids, self._sums = ids, np.zeros(ids.shape)
        if len(self._earlier) >= _MOST_STEPS:
            self._earlier = [self._merge()]

    def _merge(self) -> tuple[Ids, Floats]:
        """Add what earlier steps gave to the pairs that touch still; return that of the others."""
        if not self._earlier:
            return NO_PAIRS
        ids, sums = (np.concatenate(each) for each in zip(*self._earlier, strict=True))
        self._earlier = []
        rows, found = _find(ids, self._ids)
        for column in (0, 1):
            given = np.bincount(rows[found], sums[found, column], len(self._ids))
            self._sums[:, column] += given
        return ids[~found], sums[~found]

    def forget(self, body: int) -> None:
        """
        Drop the contacts of a body that has gone from the space since the last step.

        The engine lists them no more, and by its id alone it could not be told from the walls.

        :param body: its id in the engine
        """
        self.settled = False
        stays = (self._ids != body).all(axis=1)
        self._ids, self._sums = self._ids[stays], self._sums[stays]
        self._given = self._given[stays]
        ids, given, places = self._sleeping
        stays = (ids != body).all(axis=1)
        self._sleeping = ids[stays], given[stays], places[:, stays]
        for number, (ids, sums) in enumerate(self._earlier):
            stays = (ids != body).all(axis=1)
            self._earlier[number] = ids[stays], sums[stays]

    def skip_step(self) -> None:
        """Forget all contacts: nobody watches the step that has just been made."""
        self._sleeping, self._unwatched = NO_SLEEPERS, True
        self._ids, self._sums = NO_PAIRS
        self._given = self._sums
        self.clear()
        self.settled = False

    def clear(self) -> None:
        """Forget what has been summed up since the last call of `take`."""
        self._earlier = []
        self._sums = np.zeros_like(self._sums)
        self._steps = 0
        self._begun.clear()

    def inherit(self, old: ContactReport, old_ids: Ids, ids: Ids) -> None:
        """
        Take over what another log has summed up, of the same bodies under other ids.

        :param old_ids: (n,) uint64: the engine's ids of the bodies there
        :param ids: (n,) uint64: their ids here
        """
        ascending = np.argsort(old_ids)

        def renamed(pairs: Ids, values: Floats) -> tuple[Ids, Floats]:
            # What has gone since the last step is known to the log, but has no other id.
            known = np.isin(pairs, old_ids).all(axis=1)
            places = np.searchsorted(old_ids[ascending], pairs[known])
            pairs, signs = _oriented(ids[ascending[places]])
            values = values[known]
            # An impulse, or a normal and what has no direction.
            values[:, :2] *= signs
            return pairs, values

        self._steps = old._steps
        self._ids, self._sums = renamed(old._ids, old._sums)
        self._given = np.zeros_like(self._sums)
        self._earlier = [renamed(pairs, sums) for pairs, sums in old._earlier]
        pairs, places = old._places
        pairs, rows = renamed(pairs, places.T)
        self._places = pairs, rows.T
        names = dict(zip(old_ids.tolist(), ids.tolist(), strict=True))
        for (first, second), (sign, contact) in old._begun.items():
            if first in names and second in names:
                a, b = names[first], names[second]
                self._begun[min(a, b), max(a, b)] = (sign if a < b else -sign, contact)

    def take(self, table: BodyTable, centers: Callable[[], Floats]) -> Contacts:
        """
        Return the contacts since the last call, each pair once.

        :param table: of the bodies; an id that is not in it belongs to the walls of `bounds`, or
            to a body that has gone since
        :param centers: returns (n, 2) float64: centres of mass, between which overlaps with
            sensors lie
        """
        if self._steps == 0:
            return NO_CONTACTS
        parted, given = self._merge()
        touching, sums, places = self._ids, self._sums, self._read_places()
        if len(parted):
            touching, sums = np.concatenate((touching, parted)), np.concatenate((sums, given))
            places = np.concatenate((places, self._last_places(parted)), axis=1)
        self._places = (self._ids, places[:, : len(self._ids)])
        self._sums = np.zeros_like(self._sums)
        self._steps = 0
        self._begun.clear()
        if len(table.bodies) == 0 or len(touching) == 0:
            return NO_CONTACTS
        if self._listing is None or not self._listing.holds(touching, table):
            self._listing = _list(touching, table)
        contacts, pointless = self._listing.contacts(places, sums, len(self._ids))
        overlaps = np.flatnonzero(pointless & (contacts.pairs[:, 1] >= 0))
        if len(overlaps):
            _place_overlaps(contacts, overlaps, centers())
        return contacts

    def _last_places(self, pairs: Ids) -> Floats:
        """Return (5, m) float64: where pairs that have parted touched last, as far as known."""
        ids, known = self._places
        places = np.zeros((5, len(pairs)))
        places[0] = 1.0
        rows, found = _find(pairs, ids)
        places[:, found] = known[:, rows[found]]
        for row, pair in enumerate(map(tuple, pairs.tolist())):
            if pair in self._begun:
                sign, contact = self._begun[pair]
                mean = _mean_point(contact)
                places[:, row] = *(sign * contact.normal), len(contact.points), *mean
        return places

    def _read_places(self) -> Floats:
        """Return (5, m) float64: normal, count of points, mean point, of the last step."""
        ints, floats = self._io.read_contacts(_PLACES)
        firsts, counts = ints.reshape(-1, 2).T
        # Columns, because numpy adds them up five times as fast as pairs.
        columns = np.ascontiguousarray(floats.reshape(-1, 10).T)
        places = np.empty((5, len(counts)))
        places[:2] = columns[:2] * self._signs_of(firsts).T
        places[2] = counts
        # On either body; the second point is zero where there is but one.
        first, second = columns[2:4] + columns[4:6], columns[6:8] + columns[8:10]
        np.add(first, second, out=places[3:])
        places[3:] *= 0.5 / np.maximum(counts, 1)
        return np.concatenate((places, self._sleeping[2]), axis=1)


NO_PAIRS = np.empty((0, 2), np.uint64), np.empty((0, 2))
NO_SLEEPERS = *NO_PAIRS, np.empty((5, 0))
NO_CONTACTS = Contacts(
    pairs=np.empty((0, 2), dtype=np.int64),
    points=np.empty((0, 2)),
    normals=np.empty((0, 2)),
    impulses=np.empty((0, 2)),
)


def _read_sleeping(table: BodyTable) -> tuple[Ids, Floats, Floats]:
    """Return sleeping pairs with impulses and places as the engine keeps them, one by one."""
    found: dict[object, tuple[tuple[int, int], tuple[float, float], tuple[float, ...]]] = {}

    def note(arbiter: pymunk.Arbiter) -> None:
        a, b = (body.id for body in arbiter.bodies)
        sign, contact = (1 if a < b else -1), arbiter.contact_point_set
        impulse = sign * arbiter.total_impulse
        place = (*(sign * contact.normal), len(contact.points), *_mean_point(contact))
        key = arbiter._arbiter  # noqa: SLF001 - tells pairs of shapes apart
        found[key] = (min(a, b), max(a, b)), (impulse.x, impulse.y), place

    for row in np.flatnonzero(table.asleep).tolist():
        table.bodies[row].engine.each_arbiter(note)
    ids, impulses, places = zip(*found.values(), strict=True) if found else ((), (), ())
    return (
        np.array(ids, np.uint64).reshape(-1, 2),
        np.array(impulses, np.float64).reshape(-1, 2),
        np.array(places, np.float64).reshape(-1, 5).T,
    )


def _mean_point(contact: pymunk.ContactPointSet) -> pymunk.Vec2d:
    """Return the mean of the points of a contact, between the two bodies [m]."""
    points = [(each.point_a + each.point_b) / 2 for each in contact.points]
    return sum(points, pymunk.Vec2d(0, 0)) / max(1, len(points))


def _oriented(pairs: Ids) -> tuple[Ids, Floats]:
    """Return pairs with the lesser id first, and (k, 1): -1 where that turns one round, else 1."""
    # Column by column: numpy sorts pairs ten times as slowly.
    first, second = pairs.T
    signs = np.where(first > second, -1.0, 1.0)[:, None]
    return np.column_stack((np.minimum(first, second), np.maximum(first, second))), signs


def _find(pairs: Ids, listing: Ids) -> tuple[NDArray[np.intp], Flags]:
    """Return a row of each pair in a listing, and whether it is the pair's."""
    if len(listing) == 0:
        return np.zeros(len(pairs), np.intp), np.zeros(len(pairs), np.bool_)
    wanted, keys = (each[:, 0] * _SPREAD + each[:, 1] for each in (pairs, listing))
    order = np.argsort(keys)
    place = np.minimum(np.searchsorted(keys, wanted, sorter=order), len(keys) - 1)
    rows = order[place]
    # Another pair may have the same key: then this one is not found, and stays by itself.
    # Column by column: numpy compares pairs six times as slowly.
    (a, b), (first, second) = listing.T, pairs.T
    return rows, (a[rows] == first) & (b[rows] == second)


@dataclass(frozen=True, slots=True, eq=False)
class _Listing:
    """
    Which rows of the scene touch, in order; the same from frame to frame in a pile at rest.

    :param touching: (k, 2): the engine's ids of pairs, as they come
    :param table: of the bodies
    :param pairs: (m, 2): rows of each pair, the earlier spawned first
    :param order: (l,): where the contacts of the pairs are among those that come, pair by pair
    :param first: (m,): where in that order each pair begins
    :param sign: (l,): -1 where the engine has a pair the other way round, in that order
    """

    touching: Ids
    table: BodyTable
    pairs: Ints
    order: NDArray[np.intp]
    first: NDArray[np.intp]
    sign: Floats

    def holds(self, touching: Ids, table: BodyTable) -> bool:
        """Return whether the same pairs touch as when this was made."""
        return self.table is table and np.array_equal(self.touching, touching)

    def contacts(self, places: Floats, sums: Floats, current: int) -> tuple[Contacts, Flags]:
        """
        Return the contacts, from what is known of each in the engine's order.

        :param places: (5, k) float64: normal, count of points, mean point
        :param sums: (k, 2) float64: impulses
        :param current: so many touch still, those that come first
        :return: the contacts, and (m,) bool: which of them have no points
        """
        # The engine's impulse acts on the first body; the log tells what the first gives.
        impulses = sums.take(self.order, axis=0).T * -self.sign
        places = places.take(self.order, axis=1)
        places[:2] *= self.sign
        if len(self.first) < len(self.order):
            impulses = np.add.reduceat(impulses, self.first, axis=1)
            places = self._one_each(places, self.order < current)
        contacts = Contacts(
            pairs=self.pairs, points=places[3:].T, normals=places[:2].T, impulses=impulses.T
        )
        return contacts, places[2] == 0

    def _one_each(self, places: Floats, current: Flags) -> Floats:
        """
        Return one place for each pair.

        :param current: (l,): which touch still
        """
        counts = np.diff(self.first, append=len(self.order))
        several = counts > 1
        rows = np.repeat(several, counts)
        counts = counts[several]
        result = places.take(self.first, axis=1)
        result[:, several] = _means(places[:, rows], current[rows], np.cumsum(counts) - counts)
        return result


def _means(places: Floats, current: Flags, first: NDArray[np.intp]) -> Floats:
    """
    Return the mean place of each pair over its points, which is of no order.

    The engine lists the contacts of a pair by addresses, another way each time.

    :param places: (5, l): normal, count of points, mean point, pair by pair
    :param current: (l,): which touch still; the others count only where none of the pair does
    :param first: (m,): where each pair begins
    """
    pairs = np.repeat(np.arange(len(first)), np.diff(first, append=len(current)))
    counts = places[2] * (current | ~np.logical_or.reduceat(current, first)[pairs])
    means = np.add.reduceat(places * counts, first, axis=1)
    means[2] = np.add.reduceat(counts, first)
    means[3:] /= np.maximum(means[2], 1.0)
    length = np.hypot(means[0], means[1])
    # Squeezed from both sides, it has the normal of one of them.
    angles = np.maximum.reduceat(np.arctan2(places[1], places[0]), first)
    means[:2] = np.where(
        length > OPPOSED * means[2],
        means[:2] / np.maximum(length, 1e-300),
        (np.cos(angles), np.sin(angles)),
    )
    return means


def _list(touching: Ids, table: BodyTable) -> _Listing:
    """Find the rows of the pairs that touch."""
    count = len(table.bodies)
    # The background has no row in a scene.
    a, b = (np.where(rows < count, rows, -1) for rows in table.rows_of(touching).T)
    swap = (b >= 0) & ((a > b) | (a < 0))
    a, b = np.where(swap, b, a), np.where(swap, a, b)
    keys = a * (count + 1) + b
    order = np.argsort(keys, kind='stable')
    order = order[a[order] >= 0]
    first = np.flatnonzero(np.diff(keys[order], prepend=-2))
    leading = order[first]
    return _Listing(
        touching=touching,
        table=table,
        pairs=np.column_stack((a[leading], b[leading])),
        order=order,
        first=first,
        sign=np.where(swap, -1.0, 1.0)[order],
    )


def _place_overlaps(contacts: Contacts, overlaps: NDArray[np.intp], centers: Floats) -> None:
    """Give overlaps with sensors, of which the engine has no points, a place and a normal."""
    a, b = centers[contacts.pairs[overlaps, 0]], centers[contacts.pairs[overlaps, 1]]
    apart = b - a
    length = np.hypot(apart[:, 0], apart[:, 1])[:, None]
    contacts.points[overlaps] = (a + b) / 2
    contacts.normals[overlaps] = np.where(
        length > 0, apart / np.maximum(length, 1e-300), (1.0, 0.0)
    )
