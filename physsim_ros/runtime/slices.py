# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Work in slices: between two of them the world's thread handles messages, and may step the world.

Laws: a generator ends a slice where a tick may end, as in a replay. A coroutine (`Slices`) ends
one where it waits for another thread, as for a file that is read, or by `end_slice`. `finish`
carries out either without a pause.
"""

from __future__ import annotations

from collections.abc import Callable, Coroutine, Generator
from concurrent.futures import Future, wait
from types import coroutine
from typing import Any, TypeAlias, TypeVar

_Result = TypeVar('_Result')
# Work on the world's thread: a coroutine that awaits results of other threads by `wrap_future`.
Slices: TypeAlias = Coroutine[Future[Any], None, _Result]
# A function whose work may have slices.
Sliced: TypeAlias = Callable[[], _Result | Slices[_Result]]
# A future that is done, for a slice that waits for nothing.
_NOTHING: Future[None] = Future()
_NOTHING.set_result(None)


async def in_slices(function: Sliced[_Result]) -> _Result:
    """Return the result of a function whose work may have slices."""
    result = function()
    return await result if isinstance(result, Coroutine) else result


@coroutine
def wrap_future(future: Future[_Result]) -> Generator[Future[_Result], None, _Result]:
    """Return the result of a future when that is done, or raise its error (as in asyncio)."""
    yield future
    return future.result()


async def end_slice() -> None:
    """End a slice; the next one waits for nothing."""
    await wrap_future(_NOTHING)


async def with_checks(function: Sliced[_Result], check: Callable[[], object]) -> _Result:
    """Return the result of a function; what a check raises before a slice is raised in that."""
    return await _checked(in_slices(function), check)


@coroutine
def _checked(
    slices: Slices[_Result], check: Callable[[], object]
) -> Generator[Future[Any], None, _Result]:
    while True:
        try:
            try:
                check()
            except Exception as refusal:  # noqa: BLE001 - the function undoes what it has begun
                awaited = slices.throw(refusal)
            else:
                awaited = slices.send(None)
        except StopIteration as end:
            result: _Result = end.value
            return result
        yield awaited


def finish(slices: Generator[object, None, _Result] | Slices[_Result]) -> _Result:
    """Carry out all slices, wait for the threads that they wait for, and return the result."""
    while True:
        try:
            awaited = slices.send(None)
        except StopIteration as end:
            result: _Result = end.value
            return result
        if isinstance(awaited, Future):
            wait((awaited,))
