# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The entries that wait in the queue of requests, within limits of count and memory.

Laws: entries leave in the order in which they came. A move of a hand replaces the waiting move of
that hand, unless a request of another kind came between them; so does a seek the waiting seek.
Requests beyond a limit, in count and in memory, are refused; beyond twice that count, answers are
dropped and only counted.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator

from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Busy
from physsim_ros.model.requests import KeepHand, MoveHand
from physsim_ros.model.translation import Text
from physsim_ros.simulation.entries import Entry, Seek

# Greatest number of requests that wait, and their greatest memory [bytes]: five worlds of 20,000
# bodies. Up to twice that number of answers are kept one by one.
MOST_WAITING, MOST_BYTES = 100_000, 256 * 10**6


class WaitingEntries:
    """The entries that wait, the oldest first."""

    def __init__(self) -> None:
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

    def busy(self, size: int = 0, count: int = 1) -> Busy | None:
        """Return a refusal if as many requests of a size together [bytes] exceed the limits."""
        if len(self) + count <= MOST_WAITING and self._size + size <= MOST_BYTES:
            return None
        return Busy(
            Text(
                '{waiting} requests wait; {more} more were too many',
                waiting=str(len(self)),
                more=str(count),
            )
        )

    def replace_move(self, move: MoveHand) -> bool:
        """Have a move of a hand replace the one that waits, and return whether one does."""
        waiting = self._moves.get(move.hand)
        if waiting is not None:
            waiting.request = move
        return waiting is not None

    def add(self, entry: Entry) -> None:
        """Add a request or a call; what came before it is replaced no more."""
        self._entries.append(entry)
        self._size += entry.size
        self._seek = None
        if not isinstance(entry.request, MoveHand | KeepHand):
            self._moves.clear()
        if isinstance(entry.request, MoveHand):
            self._moves[entry.request.hand] = entry

    def add_seek(self, entry: Entry, seek: Seek) -> None:
        """Add a seek; the one that waits as the last entry is answered as superseded."""
        if (waiting := self._seek) is not None:
            time = f'{seek.stamp * 1e-9:.3f} s'
            message = Text('superseded by a {by} to {time}', by='seek', time=time)
            topic, asker = waiting.origin.topic, waiting.origin.asker
            waiting.request = Answer(topic=topic, message=message, asker=asker)
        self.add(entry)
        self._seek = entry

    def add_answer(self, entry: Entry) -> None:
        """Add an answer or a refusal; where too many wait, the last entry counts them."""
        self._untold = self._untold + 1 if len(self) >= 2 * MOST_WAITING else 0
        if self._untold > 1:
            self._entries.pop()
        if self._untold:
            entry.request = Busy(f'{self._untold} more answers are not told, too many wait')
        self._entries.append(entry)

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

    @property
    def first(self) -> Entry | None:
        """Return the oldest entry; None if none waits."""
        return self._entries[0] if self._entries else None
