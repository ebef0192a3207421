# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The inbox: messages of all pages on their way to the world's thread.

Laws: its length is bounded for each page, and a page that sends much does not delay the others:
the pages take turns.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from threading import Lock
from typing import NamedTuple

from physsim_ros.sketchpad.access import Role
from physsim_ros.sketchpad.messages import Message

# Messages of one page that wait: a second of a moving hand at 60 Hz.
CAPACITY = 64
# Number of the server itself among the pages.
SERVER = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Opened:
    """A page has been opened."""

    role: Role


@dataclass(frozen=True, slots=True, kw_only=True)
class Closed:
    """A page has been closed."""


class Incoming(NamedTuple):
    """
    A message, and the page that sent it.

    :ivar page: number of the page
    :ivar request: identifier of the message; '' for the server's own
    :ivar message: of the page, checked
    """

    page: int
    request: str
    message: Message | Opened | Closed


class Inbox:
    """A queue for each page, filled by the server's thread, emptied by the world's."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._queues: dict[int, deque[Incoming]] = {}
        # The pages with messages, the next one first.
        self._turns: deque[int] = deque()

    def put(self, incoming: Incoming) -> bool:
        """
        Queue a message; return whether there was room for it.

        A page that is opened or closed is always told.
        """
        with self._lock:
            queue = self._queues.setdefault(incoming.page, deque())
            own = isinstance(incoming.message, Opened | Closed)
            if len(queue) >= CAPACITY and not own:
                return False
            if not queue:
                self._turns.append(incoming.page)
            queue.append(incoming)
            return True

    def take(self) -> Incoming | None:
        """Return the next message, of each page in turn; None where none waits."""
        with self._lock:
            if not self._turns:
                return None
            page = self._turns.popleft()
            queue = self._queues[page]
            incoming = queue.popleft()
            if queue:
                self._turns.append(page)
            elif isinstance(incoming.message, Closed):
                del self._queues[page]
            return incoming
