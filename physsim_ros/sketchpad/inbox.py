# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The inbox: messages of all pages on their way to the world's thread.

Laws: the number of waiting messages is bounded for each page; the pages take turns, so that a page
that sends much does not delay the others.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from threading import Lock
from typing import Any, NamedTuple

from physsim_ros.model.answer import Answer
from physsim_ros.sketchpad.message import Message
from physsim_ros.sketchpad.rights import Role

# Waiting messages of one page: a second of a moving hand at 60 Hz.
CAPACITY = 64
# Number among the pages of those who upload worlds.
UPLOADERS = 0


@dataclass(frozen=True, slots=True, kw_only=True)
class Opened:
    """
    A page has been opened.

    :ivar role: its rights
    :ivar person: number of the person at it
    :ivar key: with which a page is that person again
    :ivar received: identifier of the last message of that person's page before; '' where there
        was none
    :ivar goes_on: whether it was connected before, and goes on as that person left it
    :ivar watches: whether it is a teacher's page of a class, which is nobody in this world
    """

    role: Role
    person: int
    key: str
    received: str = ''
    goes_on: bool = False
    watches: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Closed:
    """A page has been closed."""


class Upload(NamedTuple):
    """
    Replace the world by that of a file.

    :ivar content: of the world file
    :ivar role: of who uploads it
    :ivar reply: receives the answer, on the world's thread
    """

    content: Mapping[Any, Any]
    role: Role
    reply: Callable[[Answer], None]


Entry = Message | Opened | Closed | Upload


class Inbox:
    """
    A queue for each page, filled by the server's thread and emptied by the world's thread.

    :param wake: called on the server's thread after an entry has come
    """

    def __init__(self, wake: Callable[[], None]) -> None:
        self._wake = wake
        self._lock = Lock()
        self._queues: dict[int, deque[Entry]] = {}
        # The pages with entries, the next one first.
        self._turns: deque[int] = deque()

    def put(self, page: int, entry: Entry) -> bool:
        """
        Queue an entry of a page; return whether there was room for it.

        There is always room for the opening and closing of a page.
        """
        with self._lock:
            queue = self._queues.setdefault(page, deque())
            if len(queue) >= CAPACITY and not isinstance(entry, Opened | Closed):
                return False
            if not queue:
                self._turns.append(page)
            queue.append(entry)
        self._wake()
        return True

    def take(self) -> tuple[int, Entry] | None:
        """Return the next entry with the number of its page; None where there is no entry."""
        with self._lock:
            if not self._turns:
                return None
            page = self._turns.popleft()
            queue = self._queues[page]
            entry = queue.popleft()
            if queue:
                self._turns.append(page)
            elif isinstance(entry, Closed):
                del self._queues[page]
            return page, entry
