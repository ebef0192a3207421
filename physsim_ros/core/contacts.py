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

A Python callback a contact would double the cost of a step.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.core.snapshot import Contacts, Floats, Ints

Ids = NDArray[np.uintp]
import pymunk
from pymunk import batch

_F = batch.ArbiterFields
_PAIR_AND_IMPULSE = _F.BODY_A_ID | _F.BODY_B_ID | _F.TOTAL_IMPULSE
_PLACE = _F.NORMAL | _F.CONTACT_COUNT | _F.POINT_A_1 | _F.POINT_B_1 | _F.POINT_A_2 | _F.POINT_B_2


class ContactLog:
    """
    Sums up contacts from step to step until they are taken.

    :param space: whose `collision_persistence` is 1, so that the engine lists only contacts of
        the last step
    """

    def __init__(self, space: pymunk.Space) -> None:
        self._space = space
        self._buffer = batch.Buffer()
        # Runs of steps with the same pairs: ids (m, 2), impulse sums (m, 2), places (m, 10).
        self._runs: list[tuple[Ids, Floats, Floats]] = []

    def add_step(self) -> None:
        """Add the contacts of the step that has just been made."""
        ints, floats = self._read(_PAIR_AND_IMPULSE)
        ids, impulses = ints.reshape(-1, 2), floats.reshape(-1, 2)
        if self._runs and np.array_equal(self._runs[-1][0], ids):
            self._runs[-1][1].__iadd__(impulses)
        elif len(ids):
            self._runs.append((ids, impulses, self._places()))

    def clear(self) -> None:
        """Forget all steps."""
        self._runs.clear()

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
            return NO_CONTACTS
        touching = np.concatenate([run[0] for run in runs])
        places = np.concatenate([run[2] for run in runs])
        at = np.minimum(np.searchsorted(ids, touching), len(ids) - 1)
        pairs = np.where(ids[at] == touching, rows[at], -1)
        # Normal and impulse side by side; the engine's impulse acts on the first body, the log
        # tells what the first gives.
        vectors = np.column_stack((places[:, :2], -np.concatenate([run[1] for run in runs])))
        swap = (pairs[:, 1] >= 0) & ((pairs[:, 0] > pairs[:, 1]) | (pairs[:, 0] < 0))
        pairs[swap] = pairs[swap, ::-1]
        vectors[swap] *= -1.0
        known = np.flatnonzero(pairs[:, 0] >= 0)
        # One key a pair; a stable sort keeps the steps of a pair in their order.
        keys = pairs[known, 0] * (len(ids) + 1) + pairs[known, 1]
        order = known[np.argsort(keys, kind='stable')]
        if len(order) == 0:
            return NO_CONTACTS
        new = (pairs[order[1:]] != pairs[order[:-1]]).any(axis=1)
        first = np.concatenate(([0], np.flatnonzero(new) + 1))
        last = order[np.concatenate((first[1:], [len(order)])) - 1]
        contacts = Contacts(
            pairs=pairs[last],
            points=places[last, 3:5],
            normals=vectors[last, :2],
            impulses=np.add.reduceat(vectors[order, 2:], first, axis=0),
        )
        _place_overlaps(contacts, places[last, 2] == 0, centers)
        return contacts

    def _places(self) -> Floats:
        """Return (m, 5) float64: normal, count of points, mean point, of the last step."""
        ints, floats = self._read(_PLACE)
        count = ints.astype(np.float64)
        numbers = floats.reshape(-1, 10)
        normal = numbers[:, :2]
        first = (numbers[:, 2:4] + numbers[:, 4:6]) / 2
        second = (numbers[:, 6:8] + numbers[:, 8:10]) / 2
        point = np.where(count[:, None] > 1, (first + second) / 2, first)
        return np.column_stack((normal, count, point))

    def _read(self, fields: batch.ArbiterFields) -> tuple[Ids, Floats]:
        # The buffer is reused (a new one a call would leak), so what leaves is a copy.
        self._buffer.clear()
        batch.get_space_arbiters(self._space, fields, self._buffer)
        ints = np.frombuffer(self._buffer.int_buf(), dtype=np.uintp).copy()
        return ints, np.frombuffer(self._buffer.float_buf(), dtype=np.float64).copy()


NO_CONTACTS = Contacts(
    pairs=np.empty((0, 2), dtype=np.int64),
    points=np.empty((0, 2)),
    normals=np.empty((0, 2)),
    impulses=np.empty((0, 2)),
)


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
