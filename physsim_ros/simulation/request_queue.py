# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The queue of requests: entries wait in it for the next frame, within limits of count and memory.

Laws: entries leave in the order in which they came. A move of a hand replaces the waiting move of
that hand, unless a request of another kind came between them; so does a seek the waiting seek.
Requests beyond a limit, in count and in memory, are refused; beyond twice that count, answers are
dropped and only counted. `Applier` takes the entries, and applies them.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import replace

from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Busy, Refusal
from physsim_ros.model.requests import KeepHand, MoveHand, Request
from physsim_ros.simulation.entries import (
    Amend,
    Call,
    Entry,
    Origin,
    Seek,
    size_of,
    superseded,
    TakeBack,
    Unread,
)

# Greatest number of requests that wait, and their greatest memory [bytes]: five worlds of 20,000
# bodies. Up to twice that number of answers are kept one by one.
MOST_WAITING, MOST_BYTES = 100_000, 256 * 10**6


class RequestQueue:
    """
    The entries that wait, the oldest first.

    :ivar gesture: number of the last gesture
    """

    def __init__(self) -> None:
        self.gesture = 0
        self._entries: deque[Entry] = deque()
        # Memory of the requests that wait [bytes].
        self._size = 0
        # Entries that a later one replaces: the waiting move of each hand, by its name, and a
        # waiting seek that no request has followed.
        self._moves: dict[str, Entry] = {}
        self._seek: Entry | None = None
        # Count of dropped answers that the last entry reports.
        self._untold = 0

    def __len__(self) -> int:
        return len(self._entries)

    def __iter__(self) -> Iterator[Entry]:
        return iter(self._entries)

    # Submitting

    def begin_gesture(self) -> int:
        """Return the number of a new gesture."""
        self.gesture += 1
        return self.gesture

    def submit(
        self,
        request: Request | Unread | Amend | TakeBack,
        origin: Origin | None = None,
        *,
        topic: str = '',
        joined: bool = False,
    ) -> None:
        """
        Add a request; the next frame applies and answers it.

        :param origin: the message from which it comes; None is one of `topic`
        :param topic: its source, where nothing else is known of the message
        :param joined: whether it is in the gesture of the entry before, and is undone with it
        """
        if isinstance(request, MoveHand) and (waiting := self._moves.get(request.hand)):
            waiting.request = request
            return
        gesture = self.gesture if joined else None
        self.submit_gesture((request,), origin or Origin(topic), gesture)

    def submit_gesture(
        self,
        requests: Sequence[Request | Unread | Amend | TakeBack],
        origin: Origin,
        gesture: int | None = None,
    ) -> int:
        """
        Add requests that are undone together, and return the number of their gesture.

        Where they are too many beside those that wait, each of them is refused.

        :param requests: at least one
        :param gesture: number of an earlier gesture that they are in, whatever came between
        """
        gesture = self.begin_gesture() if gesture is None else gesture
        sizes = [size_of(each) for each in requests]
        busy = self._busy(sum(sizes), len(sizes))
        for request, size in zip(requests, sizes, strict=True):
            subject = request.subject if isinstance(request, Request | Unread) else ''
            entry = Entry(request, origin, subject, gesture, size)
            if busy:
                self._add_answer(replace(entry, request=busy, size=0))
            else:
                self._add(entry)
        return gesture

    def submit_seek(self, stamp: int, origin: Origin) -> None:
        """Add a seek to a simulation time [ns], in place of one that waits."""
        if busy := self._busy():
            self.refuse(busy, origin)
            return
        if (waiting := self._seek) is not None:
            message = superseded('seek', f'{stamp * 1e-9:.3f} s')
            topic, asker = waiting.origin.topic, waiting.origin.asker
            waiting.request = Answer(topic=topic, message=message, asker=asker)
        entry = Entry(Seek(stamp), origin, '', self.gesture)
        self._add(entry)
        self._seek = entry

    def submit_call(self, call: Call, origin: Origin) -> None:
        """
        Add a call.

        :param origin: the message from which it comes; its answers have their own topics
        :raises Busy: too many requests wait
        """
        if busy := self._busy():
            raise busy
        self._add(Entry(call, origin, '', self.begin_gesture()))

    def refuse(self, refusal: Refusal, origin: Origin, *, subject: str = '') -> None:
        """
        Add the refusal of a message that is no request.

        :param subject: name of the body or joint that the message names, or ''
        """
        self._add_answer(Entry(refusal, origin, subject, self.gesture))

    def tell(self, answer: Answer) -> None:
        """Add an answer without a request, in the order of entries."""
        entry = Entry(answer, Origin(answer.topic), answer.subject, self.gesture)
        self._add_answer(entry)

    def _busy(self, size: int = 0, count: int = 1) -> Busy | None:
        """Return a refusal if as many requests of a size together [bytes] exceed the limits."""
        if len(self) + count <= MOST_WAITING and self._size + size <= MOST_BYTES:
            return None
        template = '{waiting} requests wait; {more} more were too many'
        return Busy(template, waiting=str(len(self)), more=str(count))

    def _add(self, entry: Entry) -> None:
        """Add a request or a call; what came before it is replaced no more."""
        self._entries.append(entry)
        self._size += entry.size
        self._seek = None
        if not isinstance(entry.request, MoveHand | KeepHand):
            self._moves.clear()
        if isinstance(entry.request, MoveHand):
            self._moves[entry.request.hand] = entry

    def _add_answer(self, entry: Entry) -> None:
        """Add an answer or a refusal; where too many wait, the last entry counts them."""
        self._untold = self._untold + 1 if len(self) >= 2 * MOST_WAITING else 0
        if self._untold > 1:
            self._entries.pop()
        if self._untold:
            template = '{untold} more answers are not told, too many wait'
            entry.request = Busy(template, untold=self._untold)
        self._entries.append(entry)

    # Taking

    @property
    def first(self) -> Entry | None:
        """Return the oldest entry; None if none waits."""
        return self._entries[0] if self._entries else None

    def take(self) -> Entry:
        """Remove and return the oldest entry."""
        entry = self._entries.popleft()
        self._size -= entry.size
        request = entry.request
        if isinstance(request, MoveHand) and self._moves.get(request.hand) is entry:
            del self._moves[request.hand]
        if entry is self._seek:
            self._seek = None
        return entry
