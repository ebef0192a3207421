# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Entries of the request queue: requests, seeks, calls, refusals and answers that wait."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import (
    ChangeBody,
    Command,
    Delete,
    Join,
    Request,
    Spawn,
    Unjoin,
)
from physsim_ros.model.snapshot import Answer
from physsim_ros.simulation.past.memory_size import names_size, request_size


@dataclass(frozen=True, slots=True)
class Seek:
    """
    Go to a simulation time.

    :param stamp: of it [ns]
    """

    stamp: int


@dataclass(frozen=True, slots=True)
class Amend:
    """
    Replace the requests of earlier gestures, as if these had been made then, in one gesture.

    The world is simulated again from there up to this moment. Each request is answered.

    :param gestures: numbers of these, as `RequestQueue.gesture` was after each was submitted
    :param requests: that take their place
    """

    gestures: tuple[int, ...]
    requests: tuple[Request, ...]


@dataclass(frozen=True, slots=True)
class Call:
    """
    Call something that reads or replaces the world, between the requests before and after it.

    :param call: returns the answers to whoever asked for it
    """

    call: Callable[[], Iterable[Answer]]


_NO_REQUESTS = Seek | Refusal | Answer


@dataclass(slots=True)
class Waiting:
    """
    A request that waits, the refusal of a message that is no request, or an answer.

    :param request: to be applied, gestures to amend, a time to go to, a call, a refusal, or an
        answer without a request
    :param topic: that it came from
    :param subject: name of the body or joint that it names, or ''
    :param gesture: requests of one gesture are undone together
    :param field: the only field of the message, to be named by a refusal; '' if it has several
    :param asker: key of the message that asks, which the answer names; '' for none
    :param size: memory of the request [bytes]
    """

    request: Request | Amend | Seek | Call | Refusal | Answer
    topic: str
    subject: str
    gesture: int
    field: str = ''
    asker: str = ''
    size: int = 0

    @property
    def is_for_world(self) -> bool:
        """Return whether it is applied to the world."""
        return not isinstance(self.request, _NO_REQUESTS)


def size_of(request: Request | Amend) -> int:
    """Return the memory that a request takes [bytes]."""
    if isinstance(request, Amend):
        return sum(map(size_of, request.requests))
    names = names_size(request.names) if isinstance(request, Command) else 0
    return request_size(request) + names


def subject_of(request: Request | Amend) -> str:
    """Return the one body or joint that a request names, or ''."""
    match request:
        case (
            Spawn(name=name)
            | ChangeBody(name=name)
            | Delete(name=name)
            | Join(name=name)
            | Unjoin(name=name)
            | Command(names=(name,))
        ):
            return name
    return ''
