# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Work on the files of a world, which a slow disk delays.

Laws: the world's thread never waits for the disk; one thread does one piece of work after the
other, in the order of the messages, and ends with the last; the end of the process waits for all
of them.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from functools import partial
from threading import Lock, Thread
from typing import TypeVar

from physsim_ros.files import finish_before_end, fulfil
from physsim_ros.model.errors import Busy
from physsim_ros.runtime.slices import wrap_future

# Pieces of work that messages ask for and that wait: twice the greatest class.
MOST_WORK = 128
_Result = TypeVar('_Result')


class FileWork:
    """
    The work on the files of one world; its methods are those of the world's thread.

    :param wake: called on any thread when a piece of work has ended
    """

    def __init__(self, wake: Callable[[], None]) -> None:
        self._wake = wake
        # Work that is not done; while there is any, a thread does it.
        self._due: deque[Callable[[], None]] = deque()
        self._lock = Lock()
        # Number of pieces of work that messages wait for.
        self._awaited = 0

    async def do(self, work: Callable[[], _Result]) -> _Result:
        """
        Return the result of a piece of work that a message asks for, or raise its error.

        :raises Busy: too much waits; nothing is done
        """
        if self._awaited >= MOST_WORK:
            raise Busy('too many files wait to be written; nothing was done')
        self._awaited += 1
        try:
            return await wrap_future(self.submit(work))
        finally:
            self._awaited -= 1

    def submit(self, work: Callable[[], _Result]) -> Future[_Result]:
        """Have the thread do a piece of work, for whose end nobody here waits."""
        future: Future[_Result] = finish_before_end(Future())
        future.add_done_callback(lambda _: self._wake())
        with self._lock:
            self._due.append(partial(fulfil, future, work))
            begins = len(self._due) == 1
        if begins:
            try:
                Thread(target=self._run, name='files').start()
            except RuntimeError as error:
                # This process may have no more threads. The next work tries again.
                self._due.clear()
                future.set_exception(error)
        return future

    def _run(self) -> None:
        """Do all work, on the thread."""
        goes_on = True
        while goes_on:
            self._due[0]()
            with self._lock:
                self._due.popleft()
                goes_on = bool(self._due)
