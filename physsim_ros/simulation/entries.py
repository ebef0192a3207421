# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Entries of the queue of requests: changes of the world and of the past, seeks, calls."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import Request
from physsim_ros.model.sizes import request_size
from physsim_ros.model.translation import Text
from physsim_ros.runtime.slices import Sliced


@dataclass(frozen=True, slots=True)
class Seek:
    """
    Go to a simulation time.

    :param stamp: of it [ns]
    """

    stamp: int


def superseded(by: str, time: str) -> Text:
    """Return the answer to a seek that something else has replaced, which goes to a time."""
    return Text('superseded by a {by} to {time}', by=by, time=time)


@dataclass(frozen=True, slots=True)
class Amend:
    """
    Replace the requests of earlier gestures by others, in one gesture.

    The world is simulated again from there up to this moment. Each new request is answered.

    :param gestures: their numbers: `RequestQueue.gesture` after each was submitted
    :param requests: that replace them
    """

    gestures: tuple[int, ...]
    requests: tuple[Request, ...]


@dataclass(frozen=True, slots=True)
class TakeBack:
    """Take back the last gesture of the author of the entry, at this moment."""


@dataclass(frozen=True, slots=True)
class Unread:
    """
    A request that is made when its turn comes: of an array of thousands, or of what there then is.

    :param subject: name of the body or joint that it names
    :param convert: returns the request, at the moment that is shown; raises a Refusal
    :param size: memory of what it is made of [bytes]
    """

    subject: str
    convert: Callable[[], Request]
    size: int = 0


class Wait(Enum):
    """
    The time at which a call is carried out.

    :cvar NONE: at once: it does not depend on requests
    :cvar BEHIND_REQUESTS: after the requests that wait; also during a seek, which it replaces, but
        not during an amendment
    :cvar FOR_SEEK: after the requests and the end of a seek: it reads or replaces the world
    :cvar TO_READ: as `FOR_SEEK`; only its first slice reads the world, so that while a thread
        writes a file, requests are applied, and only other calls wait

    :ivar is_for_world: whether it waits for the end of a seek, as requests do
    :ivar holds_requests: whether requests wait while it is under way
    """

    is_for_world: bool
    holds_requests: bool

    NONE = False, False
    BEHIND_REQUESTS = False, True
    FOR_SEEK = True, True
    TO_READ = True, False

    def __init__(self, *facts: bool) -> None:
        self.is_for_world, self.holds_requests = facts


@dataclass(frozen=True, slots=True)
class Call:
    """
    Call a function that reads or replaces the world.

    :param function: returns answers, and may have slices
    :param wait: the time at which it is called
    :param on_told: called when its answers are told
    """

    function: Sliced[Sequence[Answer]]
    wait: Wait
    on_told: Callable[[], object]


class Origin(NamedTuple):
    """
    The message from which an entry comes.

    :ivar topic: that its answers name
    :ivar field: the only field of the message, which a refusal names; '' if it has several
    :ivar asker: key of a page and its message, which the answers carry; '' for none
    :ivar author: name of the person who did it; '' is nobody
    :ivar check: raises a Refusal where the author has lost the right since; called in the turn of
        the entry
    """

    topic: str
    field: str = ''
    asker: str = ''
    author: str = ''
    check: Callable[[], object] = lambda: None


# Origin of a call whose answers have their own topics, and which no page asks for.
UNKNOWN = Origin('')


@dataclass(slots=True)
class Entry:
    """
    What waits in the queue.

    :param request: to be applied; or a change of the past, a seek, a call, the refusal of a
        message that is no request, an answer without a request
    :param origin: the message from which it comes
    :param subject: name of the body or joint that it names, or ''
    :param gesture: number of its gesture; requests of one gesture are undone together
    :param size: memory of the request [bytes]
    """

    request: Request | Unread | Amend | TakeBack | Seek | Call | Refusal | Answer
    origin: Origin
    subject: str
    gesture: int
    size: int = 0

    @property
    def is_for_world(self) -> bool:
        """Return whether it is applied to the world, and so waits for the end of a seek."""
        match self.request:
            case Call(wait=wait):
                return wait.is_for_world
            case Seek() | Refusal() | Answer():
                return False
        return True

    @property
    def is_answer(self) -> bool:
        """Return whether it only answers."""
        return isinstance(self.request, Refusal | Answer)


def size_of(request: Request | Unread | Amend | TakeBack) -> int:
    """Return the memory that a request takes [bytes]."""
    if isinstance(request, Unread):
        return request.size
    if isinstance(request, Amend):
        return sum(map(size_of, request.requests))
    if isinstance(request, TakeBack):
        return 0
    return request_size(request)
