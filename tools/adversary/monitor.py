# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Memory, threads and descriptors of a process, sample by sample, and whether they grow."""

from __future__ import annotations

import math
from pathlib import Path
from statistics import median
from typing import NamedTuple

import numpy as np
import psutil

# Memory that a run may gain between its middle and its end [MB], without that of the past, which
# has a budget: pages of allocators.
MEMORY_GAIN = 40.0
# Share of its budget from which on the past is full: a part of it may be dropped at once.
FULL = 0.75
# Threads and descriptors more than in the first third: those of discovered participants come late.
COUNT_GAIN = 4
# Frames a second of the world [Hz].
RATE = 60.0


class Sample(NamedTuple):
    """The state of the process in a world at rest."""

    minutes: float
    megabytes: float
    past: float
    threads: int
    descriptors: int
    children: int
    late_frames: int

    @property
    def own(self) -> float:
        """Return the memory without that of the past [MB]."""
        return self.megabytes - self.past


class Monitor:
    """
    Samples of a process.

    :param pid: of the process
    :param budget: of the past [MB]
    """

    def __init__(self, pid: int, budget: float) -> None:
        self._budget = budget
        self._process = psutil.Process(pid)
        self._schedule = Path(f'/proc/{pid}/schedstat')
        self.samples: list[Sample] = []

    @property
    def waited(self) -> float:
        """
        Return the time for which the main thread could run, and had no processor [s].

        The second number of schedstat (Linux, Documentation/scheduler/sched-stats.rst).
        """
        return int(self._schedule.read_text().split()[1]) * 1e-9

    def sample(self, minutes: float, past: float, late_frames: int, waited: float) -> Sample:
        """
        Add a sample.

        :param minutes: since the beginning [min]
        :param past: memory of the past, by its own estimate [MB]
        :param late_frames: in the last quiet seconds; those do not count that others on this
            machine explain
        :param waited: in the same seconds, for a processor [s]
        """
        process = self._process
        with process.oneshot():
            found = Sample(
                minutes,
                process.memory_info().rss / 2**20,
                past,
                process.num_threads(),
                process.num_fds(),
                len(process.children(recursive=True)),
                max(0, late_frames - math.ceil(waited * RATE)),
            )
        self.samples.append(found)
        return found

    def children(self) -> list[psutil.Process]:
        """Return its child processes."""
        found: list[psutil.Process] = self._process.children(recursive=True)
        return found

    @property
    def words(self) -> str:
        """Return a sentence about the slope of own memory since the past was full."""
        full = (n for n, each in enumerate(self.samples) if each.past >= FULL * self._budget)
        first = next(full, len(self.samples))
        since = self.samples[first:]
        if len(since) < 4:
            return f'the past took less than {FULL * self._budget:.0f} MB: no slope of memory'
        # By least squares.
        hours = np.array([each.minutes / 60 for each in since])
        fit, covariance = np.polyfit(hours, [each.own for each in since], 1, cov=True)
        error = math.sqrt(covariance[0, 0])
        return (
            f'slope of own memory in {(hours[-1] - hours[0]) * 60:.0f} min with a full past: '
            f'{fit[0]:+.0f} MB/h, standard error {error:.0f}'
        )

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
        gain = median(s.own for s in last) - median(s.own for s in middle)
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
