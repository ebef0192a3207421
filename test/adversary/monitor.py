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

"""Memory, threads and descriptors of a process, sample by sample, and whether they grow."""

from __future__ import annotations

from statistics import median
from typing import NamedTuple

import psutil

# Memory that a run may gain between its middle and its end [MB]: budgets that are not full yet at
# the middle, and the pages of allocators.
MEMORY_GAIN = 40.0
# Threads and descriptors more than in the first third: those of discovered participants come late.
COUNT_GAIN = 4


class Sample(NamedTuple):
    """The state of the process in a world at rest."""

    minutes: float
    megabytes: float
    threads: int
    descriptors: int
    children: int
    late_frames: int


class Monitor:
    """
    Samples of a process.

    :param pid: of the process
    """

    def __init__(self, pid: int) -> None:
        self._process = psutil.Process(pid)
        self.samples: list[Sample] = []

    def sample(self, minutes: float, late_frames: int) -> Sample:
        """
        Add a sample.

        :param minutes: since the beginning [min]
        :param late_frames: in the last quiet seconds
        """
        process = self._process
        with process.oneshot():
            found = Sample(
                minutes,
                process.memory_info().rss / 2**20,
                process.num_threads(),
                process.num_fds(),
                len(process.children(recursive=True)),
                late_frames,
            )
        self.samples.append(found)
        return found

    def children(self) -> list[psutil.Process]:
        """Return its child processes."""
        found: list[psutil.Process] = self._process.children(recursive=True)
        return found

    @property
    def slope(self) -> float:
        """Return the slope of memory over the second half, by least squares [MB/h]."""
        begin = len(self.samples) // 2
        half = self.samples[begin:]
        if len(half) < 2:
            return 0.0
        hours = [each.minutes / 60 for each in half]
        middle = sum(hours) / len(hours)
        spread = sum((hour - middle) ** 2 for hour in hours)
        rise = sum((h - middle) * each.megabytes for h, each in zip(hours, half, strict=True))
        return rise / spread

    def faults(self) -> list[str]:
        """Return a sentence about each quantity that has grown, and about late frames."""
        if not self.samples:
            return ['not one round was finished']
        third = max(1, len(self.samples) // 3)
        first, middle, last = (
            self.samples[:third],
            self.samples[third:-third] or self.samples,
            self.samples[-third:],
        )
        faults = []
        gain = median(s.megabytes for s in last) - median(s.megabytes for s in middle)
        if gain > MEMORY_GAIN:
            faults.append(f'memory grows: {gain:.0f} MB from the middle to the end')
        for field in ('threads', 'descriptors', 'children'):
            before = max(getattr(each, field) for each in first)
            after = min(getattr(each, field) for each in last)
            if after > before + (COUNT_GAIN if field != 'children' else 0):
                faults.append(f'{field} grow: {before} at first, {after} at the end')
        late = sum(each.late_frames for each in self.samples)
        if late:
            faults.append(f'{late} frames were late while nobody disturbed the world')
        return faults
