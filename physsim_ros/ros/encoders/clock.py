# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`clock`: rosgraph_msgs/Clock, simulation time."""

from __future__ import annotations

from physsim_ros.model.snapshot import Frame
from rclpy.time import Time
from rosgraph_msgs.msg import Clock


class ClockEncoder:
    """
    Encodes simulation time; nothing before the first step.

    A node that uses simulation time takes 0 for a clock that has not begun. A world that comes
    back to its beginning sends 1 ns instead.
    """

    def __init__(self) -> None:
        self._began = False

    def encode(self, frame: Frame) -> Clock | None:
        """Return the message of a frame; None before the first step."""
        stamp = frame.snapshot.stamp
        self._began = self._began or stamp > 0
        return Clock(clock=Time(nanoseconds=max(1, stamp)).to_msg()) if self._began else None
