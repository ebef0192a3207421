# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Contacts for pages: forces of a world that stands still, and touches of bodies that pages follow.

Laws: contacts belong to the first frame of a step; later frames of this step have them too. Where
the world was opened or changed since, they are solved for it as it is now; while a hand drags a
body, contacts remain where both bodies are where they were. A touch has the time of the step in
which it began, whatever the frames are.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from physsim_ros.model.arrays import Flags, Ints
from physsim_ros.model.snapshot import Contacts, Frame, NO_CONTACTS, Snapshot

# The forces of a world as it is now: contacts as of one step, and a snapshot with those of joints,
# media and attraction.
Forces = tuple[Contacts, Snapshot]


class LastContacts:
    """
    The last frame that had contacts.

    :param solve: returns the forces of the world as a snapshot shows it; None where it cannot
    """

    def __init__(self, solve: Callable[[Snapshot], Forces | None]) -> None:
        self._solve = solve
        self._last: tuple[Snapshot, Contacts] | None = None
        # The snapshot that was solved for last, and its forces.
        self._solved: tuple[Snapshot, Forces] | None = None

    def completed(self, frame: Frame) -> Frame:
        """Return a frame; one that repeats a step has the contacts of the step's first frame."""
        if frame.contacts is None:
            self._last = None
            return frame
        if frame.contacts.steps:
            self._last, self._solved = (frame.snapshot, frame.contacts), None
            return frame
        if self._last is not None and self._last[0].step != frame.snapshot.step:
            self._last = None
        if self._last is not None:
            snapshot, contacts = self._last
            frame = replace(frame, contacts=_still_there(contacts, snapshot, frame.snapshot))
            if _is_same(snapshot, frame.snapshot):
                return frame
        return self._with_forces(frame)

    def _with_forces(self, frame: Frame) -> Frame:
        """Return the frame of a world at rest with its forces of now, if they are known."""
        snapshot = frame.snapshot
        if frame.speed or snapshot.grips:
            return frame
        if self._solved is None or not _is_same(self._solved[0], snapshot):
            forces = self._solve(snapshot)
            self._solved = None if forces is None else (snapshot, forces)
        if self._solved is None:
            return frame
        contacts, loaded = self._solved[1]
        known = replace(snapshot, forces=loaded.forces, pulls=loaded.pulls, fields=loaded.fields)
        return replace(frame, contacts=contacts, snapshot=known)


def _is_same(before: Snapshot, now: Snapshot) -> bool:
    """Return whether nothing has been moved or changed."""
    if before.step != now.step or before.scene is not now.scene:
        return False
    return np.array_equal(before.poses, now.poses) and np.array_equal(before.twists, now.twists)


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


def touches_content(
    snapshot: Snapshot, contacts: Contacts | None, followed: frozenset[str], physics_rate: float
) -> dict[str, Any] | None:
    """
    Return the message of the touches of followed bodies that began during a frame.

    :param snapshot: of the frame
    :param contacts: of it
    :param followed: names of the bodies
    :param physics_rate: steps a second of simulation
    :return: None where there is none
    """
    if contacts is None or not len(contacts.begun):
        return None
    # Row -1 is a wall of the bounds.
    names = [*snapshot.scene.names, '']
    first = snapshot.step - contacts.steps
    pairs = zip(contacts.begun.tolist(), contacts.begun_at.tolist(), strict=True)
    found = [
        (names[one], names[other], (first + time) / physics_rate)
        for (a, b), time in pairs
        for one, other in ((a, b), (b, a))
        if names[one] in followed
    ]
    return {'type': 'touches', 'touches': found} if found else None
