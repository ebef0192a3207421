# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The queue of requests that wait for the next frame, and its entries.

Laws: entries are taken in the order of their arrival, and each is answered once. A move of a hand
replaces the waiting move of that hand, unless a request of another kind came between them; so does
a seek the waiting seek. Requests beyond a limit, in count and in memory, are refused; answers
beyond twice that count are only counted.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from enum import Enum

from physsim_ros.model.errors import Busy, Refusal
from physsim_ros.model.requests import (
    ChangeBody,
    Command,
    Delete,
    DriveRobot,
    Join,
    KeepHand,
    MoveHand,
    Request,
    Spawn,
    Unjoin,
)
from physsim_ros.model.snapshot import Answer
from physsim_ros.simulation.past import request_size

# Greatest number of requests that wait, and their greatest memory [bytes]: five worlds of 20,000
# bodies. Up to twice that number of answers are told one by one.
MOST_WAITING, MOST_BYTES = 100_000, 256 * 10**6
# Memory of a marker as rclpy decodes it [bytes].
_UNREAD = 2500


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
    A request in a message that is converted when its turn comes, as of an array of thousands.

    :param subject: name of the body or joint that it names
    :param convert: returns the request; raises a Refusal
    """

    subject: str
    convert: Callable[[], Request]


class Wait(Enum):
    """
    The time at which a call is carried out.

    :cvar NONE: at once: it does not depend on requests
    :cvar BEHIND_REQUESTS: after the requests that wait; also during a seek, which it replaces, but
        not during an amendment
    :cvar FOR_SEEK: after the requests and the end of a seek: it reads or replaces the world
    """

    NONE = 'none'
    BEHIND_REQUESTS = 'behind requests'
    FOR_SEEK = 'for seek'


@dataclass(frozen=True, slots=True)
class Call:
    """
    Call a function that reads or replaces the world.

    :param call: the function; it returns answers
    :param wait: the time at which it is called
    """

    call: Callable[[], Iterable[Answer]]
    wait: Wait


@dataclass(slots=True)
class Waiting:
    """
    An entry of the queue.

    :param request: to be applied; or a change of the past, a seek, a call, the refusal of a
        message that is no request, an answer without a request
    :param topic: its source
    :param subject: name of the body or joint that it names, or ''
    :param gesture: number of its gesture; requests of one gesture are undone together
    :param field: the only field of the message, which a refusal names; '' if it has several
    :param asker: key of the message that asks, which the answer names; '' for none
    :param size: memory of the request [bytes]
    :param author: name of the person who did it; '' is nobody
    """

    request: Request | Unread | Amend | TakeBack | Seek | Call | Refusal | Answer
    topic: str
    subject: str
    gesture: int
    field: str = ''
    asker: str = ''
    size: int = 0
    author: str = ''

    @property
    def is_for_world(self) -> bool:
        """Return whether it is applied to the world, and so waits for the end of a seek."""
        match self.request:
            case Call(wait=wait):
                return wait is Wait.FOR_SEEK
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
        return _UNREAD
    if isinstance(request, Amend):
        return sum(map(size_of, request.requests))
    if isinstance(request, TakeBack):
        return 0
    return request_size(request)


def subject_of(request: Request | Unread | Amend | TakeBack) -> str:
    """Return the one body or joint that a request names, or ''."""
    match request:
        case (
            Spawn(name=name)
            | ChangeBody(name=name)
            | Delete(name=name)
            | Join(name=name)
            | Unjoin(name=name)
            | DriveRobot(name=name)
            | Command(names=(name,))
            | Unread(subject=name)
        ):
            return name
    return ''


class RequestQueue:
    """
    The entries that wait.

    :ivar gesture: number of the last gesture
    """

    def __init__(self) -> None:
        self.gesture = 0
        self._waiting: deque[Waiting] = deque()
        # Memory of the requests that wait [bytes].
        self._size = 0
        self._is_taken = False
        # Gesture of the last request that was taken.
        self._taken = 0
        # The waiting move of each hand, and the waiting seek, which a later one replaces.
        self._moves: dict[str, Waiting] = {}
        self._seek: Waiting | None = None
        # Number of answers that the last entry stands for.
        self._untold = 0

    def __len__(self) -> int:
        return len(self._waiting)

    @property
    def has_requests(self) -> bool:
        """Return whether an entry waits that is applied to the world."""
        return any(each.is_for_world for each in self._waiting)

    @property
    def is_in_gesture(self) -> bool:
        """
        Return whether the next request belongs to the gesture of the last one that was taken.

        Commands of robots join a gesture for an undo alone.
        """
        following = next((each for each in self._waiting if each.is_for_world), None)
        if following is None or isinstance(following.request, DriveRobot):
            return False
        return following.gesture == self._taken

    def begin_gesture(self) -> int:
        """Return the number of a new gesture."""
        self.gesture += 1
        return self.gesture

    def submit(
        self,
        request: Request | Unread | Amend | TakeBack,
        *,
        topic: str,
        joined: bool = False,
        gesture: int | None = None,
        field: str = '',
        asker: str = '',
        author: str = '',
    ) -> None:
        """
        Add a request; the next frame applies and answers it.

        :param topic: its source
        :param joined: whether it is in the gesture of the entry before, and is undone with it
        :param gesture: number of an earlier gesture that it is in, whatever came between
        :param field: the only field of its message, which a refusal names; '' if it has several
        :param asker: key of the message that asks, which the answer names; '' for none
        :param author: name of the person who did it; '' is nobody
        """
        if isinstance(request, MoveHand) and request.hand in self._moves:
            self._moves[request.hand].request = request
            return
        size = size_of(request)
        if gesture is None:
            gesture = self.gesture if joined else self.begin_gesture()
        subject = subject_of(request)
        waiting = Waiting(request, topic, subject, gesture, field, asker, size, author)
        if busy := self._busy(size):
            self._add_answer(replace(waiting, request=busy, size=0))
            return
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
        Add a seek to a simulation time [ns], in place of one that is the last entry.

        :param topic: its source
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

    def submit_call(self, call: Callable[[], Iterable[Answer]], wait: Wait) -> None:
        """
        Make a call now, or add it to the requests.

        :param wait: the time at which it is called
        :raises Busy: too many requests wait
        """
        if wait is Wait.NONE:
            for answer in call():
                self.tell(answer)
            return
        if busy := self._busy():
            raise busy
        self._moves.clear()
        self._seek = None
        # Its answers have their own topics.
        self._waiting.append(Waiting(Call(call, wait), '', '', self.begin_gesture()))

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
        Add the refusal of a message that is no request; see `submit` for other parameters.

        :param subject: name of the body or joint that the message names, or ''
        """
        gesture = self.gesture if joined else self.begin_gesture()
        self._add_answer(Waiting(refusal, topic, subject, gesture, field, asker))

    def tell(self, answer: Answer) -> None:
        """Add an answer without a request, in the order of entries."""
        self._add_answer(Waiting(answer, answer.topic, answer.subject, self.gesture))

    def _busy(self, size: int = 0) -> Busy | None:
        """Return a refusal if a request of a size [bytes] exceeds the limits."""
        if len(self) < MOST_WAITING and self._size + size <= MOST_BYTES:
            return None
        return Busy(f'{len(self)} requests wait; this one was one too many')

    def _add_answer(self, waiting: Waiting) -> None:
        """Add an answer or a refusal; where too many wait, the last entry counts them."""
        self._untold = self._untold + 1 if len(self) >= 2 * MOST_WAITING else 0
        if self._untold > 1:
            self._waiting.pop()
        if self._untold:
            waiting.request = Busy(f'{self._untold} more answers are not told, too many wait')
        self._waiting.append(waiting)

    def take(
        self,
        is_ready: Callable[[Waiting], bool] = lambda _: True,
        is_spent: Callable[[], bool] = lambda: False,
    ) -> Iterator[Waiting]:
        """
        Remove and yield the entries in order.

        Not re-entrant: a call among them that takes entries too gets none, since they come after
        it.

        :param is_ready: whether an entry can be carried out; else it and all entries after it wait
        :param is_spent: whether there is no time for a further entry; asked after each
        """
        if self._is_taken:
            return
        self._is_taken = True
        try:
            while self._waiting and is_ready(self._waiting[0]):
                waiting = self._waiting.popleft()
                self._size -= waiting.size
                match waiting.request:
                    case MoveHand(hand=hand) if self._moves.get(hand) is waiting:
                        del self._moves[hand]
                    case Seek() if self._seek is waiting:
                        self._seek = None
                if waiting.is_for_world:
                    self._taken = waiting.gesture
                yield waiting
                if is_spent():
                    return
        finally:
            self._is_taken = False
