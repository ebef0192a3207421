# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The contacts of a world that stands still: those of its last steps.

Law: contacts belong to the first frame of a step; later frames of this step have them too, where
both bodies are where they were then.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from physsim_ros.model.arrays import Flags, Ints
from physsim_ros.model.snapshot import Contacts, Frame, NO_CONTACTS, Snapshot


class LastContacts:
    """The last frame that had contacts."""

    def __init__(self) -> None:
        self._last: tuple[Snapshot, Contacts] | None = None

    def completed(self, frame: Frame) -> Frame:
        """Return a frame; one that repeats a step has the contacts of the step's first frame."""
        if frame.contacts is None:
            self._last = None
            return frame
        if frame.contacts.steps or self._last is None:
            self._last = frame.snapshot, frame.contacts
            return frame
        snapshot, contacts = self._last
        if snapshot.step != frame.snapshot.step:
            self._last = None
            return frame
        return replace(frame, contacts=_still_there(contacts, snapshot, frame.snapshot))


def _still_there(contacts: Contacts, before: Snapshot, now: Snapshot) -> Contacts:
    """Return the contacts of bodies that have not moved, by their rows in the scene of now."""
    rows, there = _rows_of(before, now)
    pairs = rows[contacts.pairs]
    kept = there[contacts.pairs].all(axis=1)
    return replace(
        contacts,
        pairs=pairs[kept],
        points=contacts.points[kept],
        normals=contacts.normals[kept],
        impulses=contacts.impulses[kept],
        # They were told with the first frame.
        begun=NO_CONTACTS.begun,
        begun_at=NO_CONTACTS.begun_at,
    )


def _rows_of(before: Snapshot, now: Snapshot) -> tuple[Ints, Flags]:
    """
    Return the rows that bodies have now, and whether they exist and have not moved.

    :return: (n + 1,) int64 and bool; the last element, which index -1 reads, is that of the walls
    """
    if before.scene.names == now.scene.names:
        rows = np.arange(len(before.poses))
    else:
        known = {name: row for row, name in enumerate(now.scene.names)}
        rows = np.array([known.get(name, -1) for name in before.scene.names], np.int64)
    there = rows >= 0
    there[there] = (now.poses[rows[there]] == before.poses[there]).all(axis=1)
    return np.append(rows, -1), np.append(there, True)
