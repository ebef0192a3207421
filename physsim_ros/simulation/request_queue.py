# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The queue of requests that wait for the next frame.

Laws: what is submitted is taken in the order of its arrival and answered once; of the moves of a
hand that wait with no requests but of hands that move or stay between them, and of seeks that wait
with no request between them, the last is carried out; too many requests are refused, in count and
in memory, and too many answers are counted by the last.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from physsim_ros.model.errors import Busy, Refusal
from physsim_ros.model.requests import (
    ChangeBody,
    Command,
    Delete,
    Join,
    KeepHand,
    MoveHand,
    Request,
    Spawn,
    Unjoin,
)
from physsim_ros.model.snapshot import Answer
from physsim_ros.simulation.past.memory_size import names_size, request_size

# Requests that wait, at most, and memory that they may take [bytes]: five worlds of 20,000 bodies.
# Answers are told one by one up to twice that count.
MOST_WAITING, MOST_BYTES = 100_000, 256 * 10**6


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


class RequestQueue:
    """
    Requests, refusals and answers that wait.

    :ivar gesture: number of the last gesture that was submitted
    """

    def __init__(self) -> None:
        self.gesture = 0
        self._waiting: deque[Waiting] = deque()
        # Memory of the requests that wait [bytes].
        self._size = 0
        self._is_taken = False
        # The last move of each hand, and the last seek; a later one takes its place.
        self._moves: dict[str, Waiting] = {}
        self._seek: Waiting | None = None
        # Answers that the last entry counts.
        self._untold = 0

    def __len__(self) -> int:
        return len(self._waiting)

    @property
    def has_requests(self) -> bool:
        """Return whether a request of the world is among what waits."""
        return any(each.is_for_world for each in self._waiting)

    def begin_gesture(self) -> int:
        """Return the number of a new gesture."""
        self.gesture += 1
        return self.gesture

    def submit(
        self,
        request: Request | Amend,
        *,
        topic: str,
        joined: bool = False,
        field: str = '',
        asker: str = '',
    ) -> None:
        """
        Add a request; nothing moves until the next frame, which carries the answer.

        :param topic: that it comes from
        :param joined: whether it belongs to the one before, and is undone together with it
        :param field: the one field that it was made of, to be named by a refusal; '' is none
        :param asker: key of the message that asks, which the answer names; '' for none
        """
        if isinstance(request, MoveHand) and request.hand in self._moves:
            self._moves[request.hand].request = request
            return
        subject, size = subject_of(request), size_of(request)
        if busy := self._busy(size):
            self.refuse(
                busy, topic=topic, subject=subject, joined=joined, field=field, asker=asker
            )
            return
        gesture = self.gesture if joined else self.begin_gesture()
        waiting = Waiting(request, topic, subject, gesture, field, asker, size)
        self._waiting.append(waiting)
        self._size += size
        self._seek = None
        match request:
            case MoveHand(hand=hand):
                self._moves[hand] = waiting
            case KeepHand():
                pass
            case _:
                self._moves.clear()

    def submit_seek(self, stamp: int, *, topic: str) -> None:
        """
        Add a seek to a simulation time [ns]; of those in a row the last is carried out.

        :param topic: that it comes from
        """
        if busy := self._busy():
            self.refuse(busy, topic=topic, subject='', joined=True)
            return
        if self._seek is not None:
            message = f'superseded by a seek to {stamp * 1e-9:.3f} s'
            self._seek.request = Answer(topic=self._seek.topic, message=message)
        self._moves.clear()
        self._seek = Waiting(Seek(stamp), topic, '', self.gesture)
        self._waiting.append(self._seek)

    def submit_call(self, call: Callable[[], Iterable[Answer]]) -> None:
        """
        Add a call, which waits for the end of a seek as a request does.

        :raises Busy: too many wait
        """
        if busy := self._busy():
            raise busy
        self._moves.clear()
        self._seek = None
        # Its answers have their own topics.
        self._waiting.append(Waiting(Call(call), '', '', self.begin_gesture()))

    def refuse(
        self,
        refusal: Refusal,
        *,
        topic: str,
        subject: str,
        joined: bool = False,
        field: str = '',
        asker: str = '',
    ) -> None:
        """
        Add the refusal of a message that is no request; other parameters are those of `submit`.

        :param subject: name of the body or joint that the message names, or ''
        """
        gesture = self.gesture if joined else self.begin_gesture()
        self._add_answer(Waiting(refusal, topic, subject, gesture, field, asker))

    def tell(self, answer: Answer) -> None:
        """Add an answer without a request, so that answers keep their order."""
        self._add_answer(Waiting(answer, answer.topic, answer.subject, self.gesture))

    def _busy(self, size: int = 0) -> Busy | None:
        """Return the refusal of a request of that memory [bytes], where too many wait."""
        if len(self) < MOST_WAITING and self._size + size <= MOST_BYTES:
            return None
        return Busy(f'{len(self)} requests wait; this one was one too many')

    def _add_answer(self, waiting: Waiting) -> None:
        """Add an answer or a refusal; where too many wait, the last one counts the others."""
        self._untold = self._untold + 1 if len(self) >= 2 * MOST_WAITING else 0
        if self._untold > 1:
            self._waiting.pop()
        if self._untold:
            waiting.request = Busy(f'{self._untold} more answers are not told, too many wait')
        self._waiting.append(waiting)

    def take(self, is_there: Callable[[], bool] = lambda: True) -> Iterator[Waiting]:
        """
        Remove and yield the waiting requests, in order.

        Not re-entrant: a call among them that takes requests too is yielded none, since those
        that wait come behind it.

        :param is_there: whether the next may be applied to the world; else it waits, and all
            behind it
        """
        if self._is_taken:
            return
        self._is_taken = True
        try:
            while self._waiting and (not self._waiting[0].is_for_world or is_there()):
                waiting = self._waiting.popleft()
                self._size -= waiting.size
                match waiting.request:
                    case MoveHand(hand=hand) if self._moves.get(hand) is waiting:
                        del self._moves[hand]
                    case Seek() if self._seek is waiting:
                        self._seek = None
                yield waiting
        finally:
            self._is_taken = False
