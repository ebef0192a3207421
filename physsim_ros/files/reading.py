# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A file is read or written on a thread of its own: requests wait for it, and time goes on."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future, wait
from threading import Thread
from typing import Any, TypeVar

from physsim_ros.runtime.slices import wrap_future

_Result = TypeVar('_Result')
# The work under way for whose end the process waits.
_awaited: set[Future[Any]] = set()


async def on_thread(work: Callable[[], _Result], *, finishes: bool = False) -> _Result:
    """
    Return what a function returns that is called on a thread of its own, or raise its error.

    :param finishes: whether the end of the process waits for it, as for a file that is written
    """
    future: Future[_Result] = Future()
    if finishes:
        finish_before_end(future)
    Thread(target=fulfil, args=(future, work), name='file', daemon=not finishes).start()
    return await wrap_future(future)


def fulfil(future: Future[_Result], work: Callable[[], _Result]) -> None:
    """Call a function, and give a future what it returns or raises."""
    try:
        future.set_result(work())
    except BaseException as error:  # noqa: BLE001 - the world's thread raises it
        future.set_exception(error)


def finish_before_end(future: Future[_Result]) -> Future[_Result]:
    """Have the end of the process wait for a future, which is returned."""
    _awaited.add(future)
    future.add_done_callback(_awaited.discard)
    return future


def finish_files() -> None:
    """Wait until all work is done that finishes before the end of the process."""
    wait(_awaited)
