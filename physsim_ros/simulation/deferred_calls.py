# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Calls among requests: carried out at once, or when a seek under way is done.

Law: a call that waits is carried out between the requests before and after it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from enum import Enum

from physsim_ros.model.snapshot import Answer
from physsim_ros.simulation.request_queue import RequestQueue


class Wait(Enum):
    """
    The time at which a call may come.

    :cvar NONE: at once; it does not concern what the requests change
    :cvar BEHIND_REQUESTS: behind the requests that wait, which wait for the end of a seek; at once
        where there are none: it ends a seek, or does not concern it
    :cvar FOR_SEEK: at the end of a seek, as requests do: it reads or replaces the world
    """

    NONE = 'none'
    BEHIND_REQUESTS = 'behind requests'
    FOR_SEEK = 'for seek'


class DeferredCalls:
    """
    Calls that may have to wait.

    :param requests: the queue of requests and answers
    :param apply_up_to_seek: applies the requests before a seek; returns whether none is under way
    """

    def __init__(self, requests: RequestQueue, apply_up_to_seek: Callable[[], bool]) -> None:
        self._requests = requests
        self._apply_up_to_seek = apply_up_to_seek

    def submit(self, call: Callable[[], Iterable[Answer]], wait: Wait) -> None:
        """
        Call something when it may come, and tell its answers.

        :param wait: time at which it may come
        :raises Busy: too many requests wait
        """
        waits = wait is Wait.FOR_SEEK or (
            wait is Wait.BEHIND_REQUESTS and self._requests.has_requests
        )
        if waits and not self._apply_up_to_seek():
            self._requests.submit_call(call)
        else:
            self.tell(call())

    def tell(self, answers: Iterable[Answer]) -> None:
        """Tell answers at once."""
        for answer in answers:
            self._requests.tell(answer)
