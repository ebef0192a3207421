# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Lockstep: the world waits for the commands that answer the last scans.

So a controller in another process acts at the same simulation time in every run. Only robots whose
commands are stamped are waited for, and no longer than parameter `lockstep` by the wall.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
import time
from typing import Any

from physsim_ros.ros.robots.drive_topic import DriveTopic


class Lockstep:
    """
    The wait for commands.

    :param values: of the parameters of the node, by name, always up to date
    :param topics: returns the topics of the robots that have a drive
    """

    def __init__(
        self, values: Mapping[str, Any], topics: Callable[[], Sequence[DriveTopic]]
    ) -> None:
        self._values = values
        self._topics = topics
        # Steady time since which a command is waited for [s]; None is none.
        self._since: float | None = None

    @property
    def is_on(self) -> bool:
        """Whether time goes on by single publish periods, each of which robots may answer."""
        return bool(self._values['lockstep'] and self._topics())

    def waits(self) -> bool:
        """
        Return whether the world waits for commands that answer the last scans.

        The time begins when it is first asked; after it, no answer to these scans is expected.
        """
        longest = self._values['lockstep']
        if not longest or not any(topic.is_awaited for topic in self._topics()):
            self._since = None
            return False
        now = time.monotonic()
        if self._since is None:
            self._since = now
        if now < self._since + longest:
            return True
        self.expect_no_answers()
        return False

    def expect_no_answers(self) -> None:
        """End the wait for commands that answer the scans up to now."""
        self._since = None
        for topic in self._topics():
            topic.awaited = None

    def note_frame(self) -> None:
        """Begin the time of the wait anew: there is another frame to answer."""
        self._since = None
