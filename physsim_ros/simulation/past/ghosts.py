# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Ghosts: the snapshots of courses that were left, as they were shown.

Law: a ghost is what was shown, to the bit; what was not shown has none.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Collection, Sequence

from physsim_ros.model.snapshot import Snapshot
from physsim_ros.simulation.past.frame_segment import CachedFrame, size_of_frames


class Ghosts:
    """The snapshots of courses that were left."""

    def __init__(self) -> None:
        self._shots: dict[int, list[CachedFrame]] = {}
        self._sizes: dict[int, int] = {}

    @property
    def size(self) -> int:
        """Return the memory that they take [bytes]."""
        return sum(self._sizes.values())

    def add_course(self, number: int, shots: Sequence[CachedFrame]) -> None:
        """Keep the snapshots of a course that is left."""
        kept = [shot._replace(contacts=None) for shot in shots]
        self._shots[number] = sorted(kept, key=lambda shot: shot.snapshot.step)
        self._sizes[number] = size_of_frames(kept)

    def drop_oldest(self) -> int:
        """Drop those of the course that was left first; return the memory that they took."""
        if not self._shots:
            return 0
        first = next(iter(self._shots))
        size = self._sizes[first]
        self.take_course(first)
        # One without frames takes nothing.
        return size or self.drop_oldest()

    def take_course(self, number: int) -> list[CachedFrame]:
        """Return the snapshots of a course that is returned to, and keep them no more."""
        self._sizes.pop(number, None)
        return self._shots.pop(number, [])

    def retain(self, numbers: Collection[int]) -> None:
        """Drop the snapshots of all courses but some."""
        for number in [number for number in self._shots if number not in numbers]:
            self.take_course(number)

    def snapshot_at(self, number: int, step: int) -> Snapshot | None:
        """Return the last frame that a course showed until a step; None where it is not kept."""
        shots = self._shots.get(number, [])
        place = bisect_right(shots, step, key=lambda shot: shot.snapshot.step)
        return shots[place - 1].snapshot if place else None
