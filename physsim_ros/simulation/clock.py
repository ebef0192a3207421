# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
How many steps are due: play, pause and speed, against a time that is handed in.

Laws: no clock is read here. Steps are never skipped: what the machine cannot do in time is given
up, so that simulation time slows down, and is counted.
"""

from __future__ import annotations

import math

# As many frames may be made up for in a row before simulation time slows down instead: a tenth of
# a second at 60 Hz, longer than a garbage collection, shorter than a person's patience.
MOST_BEHIND = 6


class Clock:
    """
    Turns a steady time into steps.

    :param physics_rate: steps a second at speed 1 [Hz]
    :param frame_steps: steps in a publish period
    :param speed: simulation seconds a second
    """

    def __init__(self, *, physics_rate: float, frame_steps: int, speed: float = 1.0) -> None:
        self._physics_rate = physics_rate
        self._frame_steps = frame_steps
        self._speed = float(speed)
        # The steady time [ns] and the step from which steps are counted.
        self._anchor: tuple[int, float] | None = None
        # Frames that were due and could not be made in time.
        self.late_frames = 0

    @property
    def speed(self) -> float:
        """Return simulation seconds a second; 0 is paused."""
        return self._speed

    @speed.setter
    def speed(self, speed: float) -> None:
        self._speed = float(speed)
        self._anchor = None

    def restart(self) -> None:
        """Count from the next call on, whatever was due."""
        self._anchor = None

    def due(self, now_ns: int, step: int) -> int:
        """
        Return how many steps the next frame has, negative ones back; 0 where none is due yet.

        At whole speeds a frame ends on a multiple of the publish period, and a timer's jitter of
        less than half a period changes nothing.

        :param now_ns: steady time, never going back [ns]
        :param step: the world's step
        """
        if self._speed < 0.0:
            # Back in time is forward on a mirrored line.
            return -self._due(now_ns, -step, -self._speed)
        return self._due(now_ns, step, self._speed) if self._speed > 0.0 else 0

    def _due(self, now_ns: int, step: int, speed: float) -> int:
        if self._anchor is None:
            self._anchor = (now_ns, step)
        quota = self._frame_steps * speed
        anchor_ns, anchor_step = self._anchor
        target = anchor_step + (now_ns - anchor_ns) * 1e-9 * self._physics_rate * speed
        # At the slowest speeds a frame is less than a step: before that is due nothing is late.
        frame = max(quota, 1.0)
        behind = (target - step) / frame
        if behind > MOST_BEHIND:
            self.late_frames += math.floor(behind) - 1
            target, behind = step + frame, 1.0
            self._anchor = (now_ns, target)
        if not speed.is_integer():
            return max(0, min(math.floor(target), step + math.ceil(quota)) - step)
        if behind < 0.5:
            return 0
        end = int((step + quota) // self._frame_steps) * self._frame_steps
        if step % self._frame_steps:
            # Onto the multiples, from where the speed was none; the time line with it.
            self._anchor = (now_ns, end)
        return max(0, end - step)
