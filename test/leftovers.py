# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Threads, connections and participants of DDS that this process has."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
import threading

import psutil

from .outside import PATIENCE

TASKS = Path('/proc/self/task')


class Open:
    """What this process has open when this object is made."""

    def __init__(self) -> None:
        self.threads = {*threading.enumerate()}
        self.participants = self._participants()
        self.connections = self._connections()

    def check_same(self) -> None:
        """Check that nothing more is open now; a thread that is about to end may do so."""
        for thread in {*threading.enumerate()} - self.threads:
            thread.join(PATIENCE)
            assert not thread.is_alive(), thread.name
        assert self._participants() <= self.participants
        assert self._connections() <= self.connections

    @staticmethod
    def _participants() -> set[str]:
        """Return the threads that receive for participants, which end with these."""
        participants = set()
        for task in TASKS.iterdir():
            # It may have ended since it was listed.
            with suppress(OSError):
                if 'dds.udp' in (task / 'comm').read_text():
                    participants.add(task.name)
        return participants

    @staticmethod
    def _connections() -> set[tuple[object, object]]:
        connections = psutil.Process().net_connections('tcp')
        return {(each.laddr, each.raddr) for each in connections}
