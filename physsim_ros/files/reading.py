# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The reading of a file, on a thread of its own: others wait for it, and time goes on."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from threading import Thread
from typing import TypeVar

from physsim_ros.simulation.parts import wrap_future

_Result = TypeVar('_Result')


async def on_thread(read: Callable[[], _Result]) -> _Result:
    """Return what a function returns that is called on a thread of its own, or raise its error."""
    future: Future[_Result] = Future()

    def call() -> None:
        try:
            future.set_result(read())
        except BaseException as error:  # noqa: BLE001 - the world's thread raises it
            future.set_exception(error)

    # The end of the process does not wait for it.
    Thread(target=call, name='reading', daemon=True).start()
    return await wrap_future(future)
