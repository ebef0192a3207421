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
Ghosts: the snapshots of courses that were left, as they were shown, within a budget in bytes.

Law: a ghost is what was shown, to the bit; what was not shown has none.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Collection, Sequence

from physsim_ros.model.snapshot import Snapshot
from physsim_ros.simulation.frame_cache import CachedFrame

# Greatest memory of the ghosts of all courses [bytes]: a minute of 100 bodies in each of three.
GREATEST_SIZE = 48 * 2**20


class Ghosts:
    """The snapshots of courses that were left."""

    def __init__(self) -> None:
        self._shots: dict[int, list[CachedFrame]] = {}

    @property
    def size(self) -> int:
        """Return the memory that they take [bytes]."""
        return sum(shot.size for shots in self._shots.values() for shot in shots)

    def add_course(self, number: int, shots: Sequence[CachedFrame]) -> None:
        """Keep the snapshots of a course that is left; the oldest courses make room for it."""
        kept = [shot._replace(contacts=None) for shot in shots]
        self._shots[number] = sorted(kept, key=lambda shot: shot.snapshot.step)
        while self._shots and self.size > GREATEST_SIZE:
            del self._shots[next(iter(self._shots))]

    def take_course(self, number: int) -> list[CachedFrame]:
        """Return the snapshots of a course that is returned to, and keep them no more."""
        return self._shots.pop(number, [])

    def retain(self, numbers: Collection[int]) -> None:
        """Drop the snapshots of all courses but some."""
        self._shots = {each: self._shots[each] for each in self._shots if each in numbers}

    def snapshot_at(self, number: int, step: int) -> Snapshot | None:
        """Return the last frame that a course showed until a step; None where it is not kept."""
        shots = self._shots.get(number, [])
        place = bisect_right(shots, step, key=lambda shot: shot.snapshot.step)
        return shots[place - 1].snapshot if place else None
