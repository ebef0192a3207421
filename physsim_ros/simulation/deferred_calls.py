# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Calls that read or replace the world, in the order of requests.

Law: a call is carried out after the requests before it, and before those after it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from enum import Enum

from physsim_ros.model.snapshot import Answer
from physsim_ros.simulation.request_queue import RequestQueue


class Wait(Enum):
    """
    The time at which a call is carried out.

    :cvar NONE: at once: it does not depend on requests
    :cvar BEHIND_REQUESTS: after the requests that wait, which wait for the end of a seek; without
        any, at once, also during a seek
    :cvar FOR_SEEK: after the end of a seek, as requests: it reads or replaces the world
    """

    NONE = 'none'
    BEHIND_REQUESTS = 'behind requests'
    FOR_SEEK = 'for seek'


class DeferredCalls:
    """
    Carries out calls, or queues them among the requests.

    :param requests: queue of requests and answers
    :param apply_up_to_seek: applies the requests before a seek; returns whether none is under way
    """

    def __init__(self, requests: RequestQueue, apply_up_to_seek: Callable[[], bool]) -> None:
        self._requests = requests
        self._apply_up_to_seek = apply_up_to_seek

    def submit(self, call: Callable[[], Iterable[Answer]], wait: Wait) -> None:
        """
        Carry out a call, and tell its answers.

        :param wait: time at which it is carried out
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
