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
What touches: the engine's contacts, summed over the steps of a frame, read in batch.

A Python callback a contact would double the cost of a step, so every step reads only pairs and
impulses, and the last one of a frame their places. A pair that has parted before the frame ends
keeps its place from the frame before, or from its first touch.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
import pymunk
from pymunk import batch

from physsim_ros.core.snapshot import Contacts, Floats, Ints

Ids = NDArray[np.uint64]

_F = batch.ArbiterFields
_PAIRS_AND_IMPULSES = _F.BODY_A_ID | _F.BODY_B_ID | _F.TOTAL_IMPULSE
_PLACES = _F.NORMAL | _F.CONTACT_COUNT | _F.POINT_A_1 | _F.POINT_B_1 | _F.POINT_A_2 | _F.POINT_B_2
# Ids are addresses of 16-byte blocks. Multiples of the golden ratio keep as far apart as any can
# (the three-distance theorem), so that a * GOLDEN + b differs for all pairs of a 32 GiB heap.
_ALIGNMENT, _GOLDEN = np.uint64(4), np.uint64(0x9E3779B97F4A7C15)


class ContactLog:
    """
    Sums up contacts from step to step until they are taken.

    :param space: whose `collision_persistence` is 1, so that the engine lists only contacts of
        the last step
    """

    def __init__(self, space: pymunk.Space) -> None:
        self._space = space
        self._buffer = batch.Buffer()
        # Runs of steps with the same pairs: ids (m, 2), sums of impulses on the first (m, 2).
        self._runs: list[tuple[Ids, Floats]] = []
        # Where pairs touched at the end of the last frame, by ascending key: normal, count of
        # points, mean point; and at the first touches since then.
        self._keys: Ids = np.empty(0, np.uint64)
        self._places: Floats = np.empty((0, 5))
        self._begun: dict[tuple[int, int], tuple[float, ...]] = {}

    def begin(self, arbiter: pymunk.Arbiter) -> None:
        """Remember where two shapes touched first, should they part before the frame ends."""
        a, b = arbiter.bodies
        points = [(each.point_a + each.point_b) / 2 for each in arbiter.contact_point_set.points]
        x, y = sum(points, pymunk.Vec2d(0, 0)) / max(1, len(points))
        self._begun[a.id, b.id] = (*arbiter.normal, len(points), x, y)

    def add_step(self) -> None:
        """Add the contacts of the step that has just been made."""
        ints, impulses = self._read(_PAIRS_AND_IMPULSES)
        ids, impulses = ints.reshape(-1, 2), impulses.reshape(-1, 2)
        if self._runs and np.array_equal(self._runs[-1][0], ids):
            self._runs[-1][1].__iadd__(impulses)
        else:
            self._runs.append((ids, impulses))

    def take(self, ids: Ids, rows: Ints, centers: Floats) -> Contacts:
        """
        Return the contacts since the last call, each pair once.

        :param ids: (n,) uintp: the engine's ids of the bodies, ascending
        :param rows: (n,) int64: the row in the scene of each; an id that is missing belongs to
            the walls of `bounds`, or to a body that has gone since
        :param centers: (n, 2) float64: centres of mass, between which overlaps with sensors lie
        """
        runs, self._runs = self._runs, []
        if not runs or len(ids) == 0:
            self._begun.clear()
            return NO_CONTACTS
        last = runs[-1][0]
        keys, first = np.unique(_keys(last), return_index=True)
        touching, places = last[first], self._read_places()[first]
        sums = np.zeros((len(keys), 2))
        gone: list[tuple[Ids, Floats]] = []
        for pairs, impulses in runs:
            run_keys = _keys(pairs)
            at, here = _find(keys, run_keys)
            for axis in (0, 1):
                weights = np.where(here, impulses[:, axis], 0.0)
                sums[:, axis] += np.bincount(at, weights, len(keys))[: len(keys)]
            if not here.all():
                gone.append((pairs[~here], impulses[~here]))
        parted = self._parted(gone) if gone else None
        self._keys, self._places = keys, places
        self._begun.clear()
        if parted is not None:
            touching, places, sums = map(
                np.concatenate, zip((touching, places, sums), parted, strict=True)
            )
        return _in_rows(touching, places, sums, ids, rows, centers)

    def _parted(self, gone: list[tuple[Ids, Floats]]) -> tuple[Ids, Floats, Floats]:
        """Return pairs, places and impulses of what touched and parted within the frame."""
        pairs = np.concatenate([each[0] for each in gone])
        keys, first, which = np.unique(_keys(pairs), return_index=True, return_inverse=True)
        sums = np.zeros((len(keys), 2))
        np.add.at(sums, which, np.concatenate([each[1] for each in gone]))
        at, before = _find(self._keys, keys)
        places = np.zeros((len(keys), 5))
        places[before] = self._places[at[before]]
        for row in np.flatnonzero(~before):
            a, b = pairs[first[row]].tolist()
            # A body that has gone takes its first touch with it.
            places[row] = self._begun.get((a, b), (1.0, 0.0, 0.0, 0.0, 0.0))
        return pairs[first], places, sums

    def _read_places(self) -> Floats:
        """Return (m, 5) float64: normal, count of points, mean point, of the last step."""
        ints, floats = self._read(_PLACES)
        numbers = floats.reshape(-1, 10)
        points = numbers[:, 2:].reshape(-1, 4, 2)
        first = (points[:, 0] + points[:, 1]) / 2
        both = (points[:, 0] + points[:, 1] + points[:, 2] + points[:, 3]) / 4
        places = np.empty((len(ints), 5))
        places[:, :2] = numbers[:, :2]
        places[:, 2] = ints
        places[:, 3:] = np.where((ints > 1)[:, None], both, first)
        return places

    def _read(self, fields: batch.ArbiterFields) -> tuple[Ids, Floats]:
        # The buffer is reused (a new one a call would leak), so what leaves is a copy.
        self._buffer.clear()
        batch.get_space_arbiters(self._space, fields, self._buffer)
        ints = np.frombuffer(self._buffer.int_buf(), dtype=np.uint64).copy()
        return ints, np.frombuffer(self._buffer.float_buf(), dtype=np.float64).copy()


NO_CONTACTS = Contacts(
    pairs=np.empty((0, 2), dtype=np.int64),
    points=np.empty((0, 2)),
    normals=np.empty((0, 2)),
    impulses=np.empty((0, 2)),
)


def _keys(ids: Ids) -> Ids:
    """Return one number for each pair of ids."""
    blocks = ids >> _ALIGNMENT
    keys: Ids = blocks[:, 0] * _GOLDEN + blocks[:, 1]
    return keys


def _find(keys: Ids, wanted: Ids) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Return where ascending keys hold the wanted ones, and which of them they do hold."""
    if len(keys) == 0:
        return np.zeros(len(wanted), np.intp), np.zeros(len(wanted), np.bool_)
    at = np.minimum(np.searchsorted(keys, wanted), len(keys) - 1)
    return at, keys[at] == wanted


def _in_rows(
    touching: Ids, places: Floats, sums: Floats, ids: Ids, rows: Ints, centers: Floats
) -> Contacts:
    """Turn engine ids into rows of the scene, the earlier spawned first, in order."""
    at, known = _find(ids, touching.ravel())
    pairs = np.where(known, rows[at], -1).reshape(-1, 2)
    swap = (pairs[:, 1] >= 0) & ((pairs[:, 0] > pairs[:, 1]) | (pairs[:, 0] < 0))
    pairs = np.where(swap[:, None], pairs[:, ::-1], pairs)
    # The engine's impulse acts on the first body; the log tells what the first gives.
    sign = np.where(swap, -1.0, 1.0)[:, None]
    normals, impulses = places[:, :2] * sign, sums * -sign
    # The engine may list a pair both ways round; it is one pair still.
    keys = pairs[:, 0] * (len(ids) + 1) + pairs[:, 1]
    order = np.argsort(keys, kind='stable')
    order = order[pairs[order, 0] >= 0]
    first = np.flatnonzero(np.diff(keys[order], prepend=-2))
    if len(first) < len(order):
        impulses[order[first]] = np.add.reduceat(impulses[order], first, axis=0)
        order = order[first]
    contacts = Contacts(
        pairs=pairs[order],
        points=places[order, 3:],
        normals=normals[order],
        impulses=impulses[order],
    )
    _place_overlaps(contacts, places[order, 2] == 0, centers)
    return contacts


def _place_overlaps(contacts: Contacts, pointless: NDArray[np.bool_], centers: Floats) -> None:
    """Give overlaps with sensors, of which the engine has no points, a place and a normal."""
    overlaps = np.flatnonzero(pointless & (contacts.pairs[:, 1] >= 0))
    if len(overlaps) == 0:
        return
    a, b = centers[contacts.pairs[overlaps, 0]], centers[contacts.pairs[overlaps, 1]]
    apart = b - a
    length = np.hypot(apart[:, 0], apart[:, 1])[:, None]
    contacts.points[overlaps] = (a + b) / 2
    contacts.normals[overlaps] = np.where(
        length > 0, apart / np.maximum(length, 1e-300), (1.0, 0.0)
    )
