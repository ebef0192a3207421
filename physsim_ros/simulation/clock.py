# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The clock: a steady time that is handed in becomes steps; no clock of the machine is read here.

Law: steps are never skipped: where the machine is too slow, simulation time slows down, and the
late frames are counted.
"""

from __future__ import annotations

import math

from physsim_ros.model.checks import Within

# Check of a speed [simulation seconds a second].
SPEED = Within(-64.0, 64.0)
# Steady time by which simulation may be late, and at least two frames, before it slows down [s]:
# longer than most collections of garbage, and hardly seen.
LATEST = 0.1


class Clock:
    """
    Turns a steady time into steps.

    :param physics_rate: steps a second at speed 1 [Hz]
    :param frame_steps: steps in a publish period
    :param speed: simulation seconds a second
    :raises BadProperty: the speed is out of range
    :raises Malformed: it is not finite

    :ivar late_frames: count of frames that were due and could not be made in time
    """

    def __init__(self, *, physics_rate: float, frame_steps: int, speed: float = 1.0) -> None:
        self._physics_rate = physics_rate
        self._frame_steps = frame_steps
        self._speed = SPEED(speed, 'speed')
        # Steady time [ns] and step from which steps are counted.
        self._anchor: tuple[int, float] | None = None
        self.late_frames = 0

    @property
    def speed(self) -> float:
        """Return simulation seconds a second; 0 is paused."""
        return self._speed

    @speed.setter
    def speed(self, speed: float) -> None:
        self._speed = SPEED(speed, 'speed')
        self._anchor = None

    def restart(self) -> None:
        """Forget what is due: count from the next call on."""
        self._anchor = None

    def due(self, now_ns: int, step: int) -> int:
        """
        Return the number of steps of the next frame, negative in a rewind; 0 if none is due yet.

        At whole speeds a frame ends on a multiple of the publish period, and a timer's jitter of
        less than half a period changes nothing.

        :param now_ns: steady time, never going back [ns]
        :param step: the world's step
        """
        if self._speed < 0.0:
            # A rewind is playback on the mirrored time line.
            return -self._due(now_ns, -step, -self._speed)
        return self._due(now_ns, step, self._speed) if self._speed > 0.0 else 0

    def _due(self, now_ns: int, step: int, speed: float) -> int:
        if self._anchor is None:
            self._anchor = (now_ns, step)
        quota = self._frame_steps * speed
        anchor_ns, anchor_step = self._anchor
        target = anchor_step + (now_ns - anchor_ns) * 1e-9 * self._physics_rate * speed
        # At the slowest speeds a frame is a fraction of a step, and is not late before that step.
        frame = max(quota, 1.0)
        behind = (target - step) / frame
        if target - step > max(2.0 * frame, LATEST * self._physics_rate * speed):
            self.late_frames += math.floor(behind) - 1
            target, behind = step + frame, 1.0
            self._anchor = (now_ns, target)
        if not speed.is_integer():
            return max(0, min(math.floor(target), step + math.ceil(quota)) - step)
        if behind < 0.5:
            return 0
        end = int((step + quota) // self._frame_steps) * self._frame_steps
        if step % self._frame_steps:
            # Back to multiples of the period after a fractional speed, and count from there.
            self._anchor = (now_ns, end)
        return max(0, end - step)
