# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Frames of one scene that are logged together, and the times at which they are logged.

The timeline `recorded` is the time of the picture: it never goes back, also while the world does,
and runs at the pace of the wall clock while the world keeps up. `sim_time` is the world's.

Law: what is sent at intervals has a period in seconds of `recorded`, and so the same rate at any
rate of frames.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Frame
import rerun as rr

RECORDED = 'recorded'
Times = list[rr.TimeColumn]

# Time between two frames until stamps and speed give one [ns]: a period of the default rate.
_FIRST_PERIOD = 16_666_667
# Greatest number of texts or arrows that are sent in a second: of more, fewer frames have them.
_BUDGET = 9000
# Shortest and longest time between two frames [ns]: after a seek the picture does not wait.
_SHORTEST, _LONGEST = 1_000_000, 1_000_000_000


class Change(NamedTuple):
    """
    What is to be sent with a batch.

    :ivar unit: length of a unit of the view [m]
    :ivar resends_scene: whether components that change only with the scene are to be sent
    :ivar resends_all: whether those of them that did not change are to be sent, too
    :ivar moved: (n,) bool: whether each body has moved since it was sent last
    """

    unit: float
    resends_scene: bool
    resends_all: bool
    moved: NDArray[np.bool_]


class FrameBatch:
    """
    Frames of one scene.

    :param frames: at least one, in order
    :param recorded: (f + 1,) int64: times on the timeline `recorded` of the frame before, -1 if
        there is none, and of the frames [ns]
    :param elapsed: (f,) int64: simulation time since the frame before each, forth or back [ns]

    :ivar recorded: (f,) int64: times of the frames [ns]
    :ivar poses: (f, n, 3) float64: of the bodies, x, y [m], yaw [rad]
    """

    def __init__(self, frames: Sequence[Frame], recorded: Ints, elapsed: Ints) -> None:
        self.frames = frames
        self.recorded = recorded[1:]
        self.elapsed = elapsed
        self._recorded_with_last = recorded
        self.scene: Scene = frames[0].snapshot.scene
        self.poses: Floats = np.stack([each.snapshot.poses for each in frames])
        self._stamps = np.array([each.snapshot.stamp for each in frames], dtype=np.int64)
        self.times = self.times_at(range(len(frames)))

    def __len__(self) -> int:
        return len(self.frames)

    def times_at(self, indices: Sequence[int]) -> Times:
        """Return the times of some of the frames, by their index in the batch."""
        rows = list(indices)
        return [
            rr.TimeColumn(RECORDED, duration=self.recorded[rows].astype('timedelta64[ns]')),
            rr.TimeColumn('sim_time', duration=self._stamps[rows].astype('timedelta64[ns]')),
        ]

    def due(self, period: float) -> list[int]:
        """Return the indices of the frames at which another period [s] of the recording begins."""
        periods = self._recorded_with_last // max(round(period * 1e9), 1)
        due: list[int] = np.flatnonzero(np.diff(periods)).tolist()
        return due

    def sampled(self, period: float) -> list[int]:
        """Return the indices of the frames that are due, as `due` does, and of the last one."""
        return sorted({*self.due(period), len(self.frames) - 1})


def sampling_period(count: int) -> float:
    """Return the period at which texts or arrows are sent [s], by their number in a frame."""
    return count / _BUDGET


class RecordedClock:
    """
    The times of frames in a recording.

    :ivar recorded: time of the last frame [ns]; -1 before the first one
    """

    def __init__(self) -> None:
        self.recorded = -1
        self._before: Frame | None = None
        # Of the last frame to which steps led: simulation time, and recorded time, since the one
        # before it [ns].
        self._elapsed = self._period = _FIRST_PERIOD

    def batches(self, frames: Sequence[Frame]) -> Iterator[FrameBatch]:
        """Yield frames in batches of one scene each."""
        for _, group in groupby(frames, key=lambda frame: id(frame.snapshot.scene)):
            run, recorded, elapsed = list(group), [self.recorded], []
            for frame in run:
                self._advance(frame)
                recorded.append(self.recorded)
                elapsed.append(self._elapsed)
            yield FrameBatch(run, np.array(recorded, np.int64), np.array(elapsed, np.int64))

    def _advance(self, frame: Frame) -> None:
        """Advance to the time of the next frame."""
        before, self._before = self._before, frame
        if before is None:
            self.recorded = 0
            return
        elapsed = abs(frame.snapshot.stamp - before.snapshot.stamp)
        period = self._period
        if elapsed and frame.speed:
            period = min(max(round(elapsed / abs(frame.speed)), _SHORTEST), _LONGEST)
        if elapsed and frame.stepped:
            self._elapsed = elapsed
        if elapsed and frame.passing:
            self._period = period
        self.recorded += period


class Track(Protocol):
    """A part of the picture: it sends its entities of each batch."""

    def send(self, batch: FrameBatch, change: Change) -> None:
        """Send what has changed."""
