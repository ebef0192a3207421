# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Frames of one scene that are logged together, the times at which they are logged, line strips.

The timeline `recorded` is the time of the picture: it never goes back, also while the world does,
and runs at the pace of the wall clock while the world keeps up. `sim_time` is the world's.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats, Ints, Singles
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Frame
import pyarrow as pa
import rerun as rr

RECORDED = 'recorded'
Times = list[rr.TimeColumn]

# Time between two frames where stamps and speed do not give it [ns]: a period of 60 Hz.
_PERIOD = 16_666_667
_VECTOR = pa.list_(pa.field('item', pa.float32(), nullable=False), 3)
_STRIP = pa.list_(pa.field('item', _VECTOR, nullable=False))
# Shortest and longest time between two frames [ns]: after a seek the picture does not wait.
_SHORTEST, _LONGEST = 1_000_000, 1_000_000_000


class Change(NamedTuple):
    """
    What is to be sent with a batch.

    :ivar unit: length of a unit of the view [m]
    :ivar scene: whether components that change only with the scene are to be sent
    :ivar everything: whether those that did not change are to be sent, too
    :ivar moved: (n,) bool: whether each body has moved since it was sent last
    """

    unit: float
    scene: bool
    everything: bool
    moved: NDArray[np.bool_]


class FrameBatch:
    """
    Frames of one scene.

    :param frames: at least one, in order
    :param numbers: of the frames in the recording, without gaps
    :param recorded: (f,) int64: times of the frames on the timeline `recorded` [ns]

    :ivar poses: (f, n, 3) float64: of the bodies, x, y [m], yaw [rad]
    """

    def __init__(self, frames: Sequence[Frame], numbers: range, recorded: Ints) -> None:
        self.frames = frames
        self.numbers = numbers
        self.recorded = recorded
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

    def sampled(self, period: int) -> list[int]:
        """Return the indices of every `period`-th frame of the recording, and of the last one."""
        last = len(self.frames) - 1
        return [
            index
            for index, number in enumerate(self.numbers)
            if number % period == 0 or index == last
        ]


class RecordedClock:
    """
    The number and the time of frames in a recording.

    :ivar recorded: time of the last frame [ns]
    """

    def __init__(self) -> None:
        self._count = 0
        self.recorded = 0
        self._before: Frame | None = None

    def batches(self, frames: Sequence[Frame]) -> Iterator[FrameBatch]:
        """Yield frames in batches of one scene each."""
        for _, group in groupby(frames, key=lambda frame: id(frame.snapshot.scene)):
            run = list(group)
            recorded = np.array([self._advance(frame) for frame in run], dtype=np.int64)
            numbers = range(self._count, self._count + len(run))
            self._count = numbers.stop
            yield FrameBatch(run, numbers, recorded)

    def _advance(self, frame: Frame) -> int:
        """Return the time of the next frame [ns]."""
        if self._before is not None:
            elapsed = abs(frame.snapshot.stamp - self._before.snapshot.stamp)
            period = elapsed / abs(frame.speed) if frame.speed and elapsed else _PERIOD
            self.recorded += round(min(max(period, _SHORTEST), _LONGEST))
        self._before = frame
        return self.recorded


class _StripBatch:
    """
    Line strips as an Arrow array: `LineStrip3DBatch` (Rerun 0.41) is a loop in Python.

    :param corners: (c, 3) float32: of all strips [m]
    :param counts: (s,) intp: number of corners of each strip
    """

    def __init__(self, corners: Singles, counts: NDArray[np.intp]) -> None:
        self._corners, self._counts = corners, counts

    def as_arrow_array(self) -> pa.Array:
        """Return a list of corners for each strip."""
        offsets = np.concatenate(([0], np.cumsum(self._counts))).astype(np.int32)
        vectors = pa.FixedSizeListArray.from_arrays(pa.array(self._corners.ravel()), type=_VECTOR)
        return pa.ListArray.from_arrays(pa.array(offsets), vectors, type=_STRIP)


def strip_column(
    corners: Singles, counts: NDArray[np.intp] | int, lengths: Sequence[int]
) -> rr.ComponentColumn:
    """
    Return line strips as a column.

    :param corners: (c, 3) float32: of all strips [m]
    :param counts: (s,) intp: number of corners of each strip; or that of every strip
    :param lengths: number of strips of each row
    """
    each = np.broadcast_to(counts, sum(lengths)).astype(np.intp)
    batch = _StripBatch(corners, each)
    return rr.ComponentColumn(rr.LineStrips3D.descriptor_strips(), batch, lengths=lengths)


class Track(Protocol):
    """A part of the picture: it sends its entities of each batch."""

    def send(self, batch: FrameBatch, change: Change) -> None:
        """Send what has changed."""
