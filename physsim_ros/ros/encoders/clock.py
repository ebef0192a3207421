# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`clock`: rosgraph_msgs/Clock, simulation time."""

from __future__ import annotations

from physsim_ros.model.snapshot import Frame
from physsim_ros.ros.encoders.cdr import CdrWriter, MessageTemplate, START


class ClockEncoder:
    """
    Encodes simulation time; nothing before the first step.

    A node that uses simulation time takes 0 for a clock that has not begun. A world that comes
    back to its beginning sends 1 ns instead.
    """

    def __init__(self) -> None:
        self._began = False
        writer = CdrWriter(START)
        writer.stamp()
        self._template = MessageTemplate(writer)

    def encode(self, frame: Frame) -> bytes | None:
        """Return the serialised message of a frame; None before the first step."""
        stamp = frame.snapshot.stamp
        self._began = self._began or stamp > 0
        return self._template.stamped(max(1, stamp)) if self._began else None
