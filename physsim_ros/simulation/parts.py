# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Work in parts: what takes seconds and does not concern the world is done elsewhere.

Law: a part ends where the work waits for that, as for a file that another thread reads. Until then
the world's thread steps the world and handles messages.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from concurrent.futures import Future, wait
from typing import Any, TypeAlias, TypeVar

_Result = TypeVar('_Result')
# Work on the world's thread that yields each future for whose result it waits, and returns its own
# result.
Parts: TypeAlias = Generator[Future[Any], None, _Result]
# A function whose work may have parts.
Parted: TypeAlias = Callable[[], _Result | Parts[_Result]]


def in_parts(function: Parted[_Result]) -> Parts[_Result]:
    """Return the result of a function whose work may have parts."""
    result = function()
    return (yield from result) if isinstance(result, Generator) else result


def at_once(parts: Parts[_Result]) -> _Result:
    """Carry out all parts now, wait for their threads, and return the result."""
    while True:
        try:
            wait((next(parts),))
        except StopIteration as end:
            result: _Result = end.value
            return result
