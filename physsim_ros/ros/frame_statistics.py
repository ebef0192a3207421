# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The cost of frames, and the pace of simulation time: figures of `/diagnostics`."""

from __future__ import annotations

# Time constant of the smoothed real-time factor, in wall time [s]: legible to a person.
_SMOOTHING = 1.0


class FrameStatistics:
    """
    The cost of frames and the real-time factor; it reads no clock.

    :ivar real_time_factor: smoothed [1]; None before the first frame
    :ivar frames: number of frames in this second
    """

    def __init__(self) -> None:
        self.real_time_factor: float | None = None
        self._last: tuple[int, int] | None = None
        self.begin_second()

    def begin_second(self) -> None:
        """Begin the counts of a second anew."""
        self.frames = 0
        self._step_ns = self._frame_ns = 0
        # Time between frames of this second: steady, and simulated [ns].
        self._elapsed_ns = self._simulated_ns = 0

    @property
    def factor(self) -> float:
        """Return the real-time factor of this second [1]."""
        return self._simulated_ns / self._elapsed_ns if self._elapsed_ns else 0.0

    @property
    def step_cost(self) -> float:
        """Return the mean cost of the steps of a frame in this second [s]."""
        return self._step_ns / max(1, self.frames) * 1e-9

    @property
    def frame_cost(self) -> float:
        """Return the mean cost of the tick of a frame in this second [s]."""
        return self._frame_ns / max(1, self.frames) * 1e-9

    def add(self, *, now_ns: int, stamp: int, step_ns: int, frame_ns: int) -> None:
        """
        Add a frame.

        :param now_ns: steady time of the frame [ns]
        :param stamp: simulation time of the frame [ns]
        :param step_ns: cost of its steps [ns]
        :param frame_ns: cost of its tick: messages, requests, steps and publishing [ns]
        """
        self.frames += 1
        self._step_ns += step_ns
        self._frame_ns += frame_ns
        known = self.real_time_factor = self.real_time_factor or 0.0
        if self._last is not None and now_ns > self._last[0]:
            elapsed, simulated = now_ns - self._last[0], stamp - self._last[1]
            self._elapsed_ns += elapsed
            self._simulated_ns += simulated
            # The first factor is not smoothed.
            share = min(1.0, elapsed * 1e-9 / _SMOOTHING) if known else 1.0
            self.real_time_factor = known + share * (simulated / elapsed - known)
        self._last = (now_ns, stamp)

    def reset_pace(self) -> None:
        """Reset the real-time factor: the world is paused, or time has jumped."""
        self._last = None
        if self.real_time_factor is not None:
            self.real_time_factor = 0.0
