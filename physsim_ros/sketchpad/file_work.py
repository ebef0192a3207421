# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Work on the files of a world, which a slow disk delays.

Laws: the world's thread never waits for the disk; one thread does one piece of work after the
other, in the order of the messages; the end of the process waits for all of them.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

from physsim_ros.files import finish_before_end
from physsim_ros.model.errors import Busy
from physsim_ros.model.slices import wrap_future

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
        # It ends with this object.
        self._thread = ThreadPoolExecutor(1, 'files')
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
        future = finish_before_end(self._thread.submit(work))
        future.add_done_callback(lambda _: self._wake())
        return future
