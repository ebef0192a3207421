# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The calls in slices that are under way: each goes on when it has what it waits for.

Law: a slice of a call is carried out on the world's thread, and only when it is asked for.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from typing import Any, NamedTuple

from physsim_ros.model.answer import Answer
from physsim_ros.runtime.slices import in_slices, Slices
from physsim_ros.simulation.entries import Call, Wait


class _UnderWay(NamedTuple):
    """
    A call in slices that is under way.

    :ivar call: the entry
    :ivar slices: of it
    :ivar awaited: for which its next slice waits
    """

    call: Call
    slices: Slices[Sequence[Answer]]
    awaited: Future[Any]


class CallsUnderWay:
    """
    The calls in slices that are under way.

    :param on_end: called with a call that has ended, and its answers
    """

    def __init__(self, on_end: Callable[[Call, Sequence[Answer]], object]) -> None:
        self._on_end = on_end
        self._calls: list[_UnderWay] = []

    @property
    def hold_requests(self) -> bool:
        """Return whether requests wait for one of them."""
        return any(each.call.wait.holds_requests for each in self._calls)

    @property
    def are_reading(self) -> bool:
        """Return whether one of them has read the world, for which other calls wait."""
        return any(each.call.wait is Wait.TO_READ for each in self._calls)

    def begin(self, call: Call) -> None:
        """Carry out the first slice of a call."""
        self._carry_out(call, in_slices(call.function))

    def go_on(self) -> bool:
        """Carry out a slice of each that has what it waits for; return whether there is any."""
        return self._go_on(self._calls)

    def go_on_beside_requests(self) -> None:
        """Do so with those for which no request waits."""
        self._go_on(each for each in self._calls if not each.call.wait.holds_requests)

    def wait_for_any(self) -> None:
        """Wait until one of them can go on."""
        wait([each.awaited for each in self._calls], return_when=FIRST_COMPLETED)

    def _go_on(self, calls: Iterable[_UnderWay]) -> bool:
        ready = [each for each in calls if each.awaited.done()]
        for each in ready:
            self._calls.remove(each)
            self._carry_out(each.call, each.slices)
        return bool(ready)

    def _carry_out(self, call: Call, slices: Slices[Sequence[Answer]]) -> None:
        try:
            self._calls.append(_UnderWay(call, slices, slices.send(None)))
        except StopIteration as end:
            self._on_end(call, end.value)
