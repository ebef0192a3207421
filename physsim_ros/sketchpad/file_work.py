# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Work on files that messages ask for, and that a slow disk delays.

Laws: the world's thread never waits for the disk; one piece of work is done after the other, in
the order of the messages; the end of the process waits for all of them.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future, wait

from physsim_ros.files import begin_on_thread
from physsim_ros.model.errors import Busy

# Pieces of work that wait, each on a thread: twice the greatest class.
MOST_WORK = 128


class FileWork:
    """
    The work on the files of one world; its methods are those of the world's thread.

    :param wake: called on any thread when a piece of work has ended
    """

    def __init__(self, wake: Callable[[], None]) -> None:
        self._wake = wake
        # The work that has not been noted as ended, each with what notes its end.
        self._waiting: deque[tuple[Future[str], Callable[[Future[str]], None]]] = deque()

    def begin(self, work: Callable[[], str], on_end: Callable[[Future[str]], None]) -> None:
        """
        Have a thread do a piece of work after those that wait.

        :param work: returns a message about what was done
        :param on_end: called on the world's thread with the work that has ended
        :raises Busy: too much waits; nothing is done
        """
        if len(self._waiting) >= MOST_WORK:
            raise Busy('too many files wait to be written; nothing was done')
        before = self._waiting[-1][0] if self._waiting else None

        def work_in_order() -> str:
            if before is not None:
                wait((before,))
            return work()

        future = begin_on_thread(work_in_order, finishes=True)
        self._waiting.append((future, on_end))
        future.add_done_callback(lambda _: self._wake())

    def note_ends(self) -> None:
        """Note the end of the work that has ended."""
        while self._waiting and self._waiting[0][0].done():
            done, on_end = self._waiting.popleft()
            on_end(done)
