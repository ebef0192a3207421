# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The log of the requests that changed a world, each with a serial: how many were made before it.

Laws: serials are counted from the beginning of the world, and never change, whichever requests are
dropped from the front of the log; requests of one gesture need not follow each other.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from functools import lru_cache

from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.requests import Command, Request, Restore
from physsim_ros.simulation.past.memory_size import names_size, request_size
from physsim_ros.simulation.past.records import Entry, Moment, total_size

# Number of tuples of names that commands of the log share: one a publisher.
_SHARED_NAMES = 16


class RequestLog:
    """
    The log of requests.

    :param dropped: number of requests that were made before

    :ivar restored: number of requests up to the last that loaded anything
    """

    def __init__(self, dropped: int) -> None:
        self.restored = 0
        self._entries: list[Entry] = []
        # Number of requests that are no more in the log.
        self._dropped = dropped
        # The state that was loaded last among those.
        self._loaded: WorldState | None = None
        # The number of requests before the first one of each gesture.
        self._gestures: dict[int, int] = {}
        # Returns the names of an earlier command that are equal: publishers command the same
        # bodies again and again.
        self._shared_names = lru_cache(maxsize=_SHARED_NAMES)(_same_names)

    # Reading

    @property
    def end(self) -> int:
        """Return the number of all requests that were made."""
        return self._dropped + len(self._entries)

    @property
    def size(self) -> int:
        """Return the memory that the log takes [bytes]."""
        return total_size(self._entries)

    def serial_at(self, step: int) -> int:
        """Return the number of requests that were made until a step, and at it."""
        return self._dropped + bisect_right(self._entries, step, key=lambda each: each.step)

    def serial_shown_at(self, step: int) -> int:
        """Return the number of requests that were made until a step was shown last."""
        # Of a step those come first that have been shown.
        not_shown = (step, True)
        place = bisect_left(self._entries, not_shown, key=lambda each: (each.step, not each.shown))
        return self._dropped + place

    def entries_between(self, serial: int, end: int) -> list[Entry]:
        """Return the requests from one serial to another."""
        first, last = serial - self._dropped, end - self._dropped
        return self._entries[first:last]

    def next_stop(self, step: int, end: int) -> int:
        """Return the next step at which there is a request, or the end."""
        place = bisect_right(self._entries, step, key=lambda each: each.step)
        return min(end, self._entries[place].step) if place < len(self._entries) else end

    def last_gesture(self, serial: int) -> tuple[Entry, int] | None:
        """
        Return the first request of the last gesture before a serial; None where none is kept.

        :return: it, and the number of requests from it on; among them are those of other gestures
            that came in between, since time goes back before them; None also for a gesture of
            which the beginning is kept no more: it is undone as a whole or not at all
        """
        if serial <= self._dropped:
            return None
        first = self._gestures[self._entries[serial - self._dropped - 1].gesture]
        if first < self._dropped:
            return None
        return self._entries[first - self._dropped], serial - first

    def gesture_before(self, serial: int, default: int) -> int:
        """Return the gesture of the last request before a serial; a default where none is kept."""
        place = serial - self._dropped - 1
        return self._entries[place].gesture if place >= 0 else default

    def gesture_start(self, gesture: int, serial: int) -> Moment | None:
        """Return step and serial of the first request of a gesture before a serial, if kept."""
        first = self._gestures.get(gesture, serial)
        kept = self._dropped <= first < serial
        return (self._entries[first - self._dropped].step, first) if kept else None

    @property
    def last_loaded(self) -> WorldState | None:
        """Return the state that was loaded last; None where none was."""
        requests = (entry.request for entry in reversed(self._entries))
        return next((each.state for each in requests if isinstance(each, Restore)), self._loaded)

    # Changing

    def add_entry(self, entry: Entry) -> None:
        """Add a request, as the last."""
        entry.size = entry.size or self._entry_size(entry.request)
        self._gestures.setdefault(entry.gesture, self.end)
        self._entries.append(entry)
        if isinstance(entry.request, Restore):
            self.restored = self.end

    def note_shown(self, step: int, serial: int) -> None:
        """Note that a step has been shown, with the requests up to a serial."""
        place = serial - self._dropped
        while place > 0 and self._entries[place - 1].step == step:
            place -= 1
            if self._entries[place].shown:
                break
            self._entries[place].shown = True

    def cut(self, serial: int) -> tuple[Entry, ...]:
        """Cut off the requests from a serial on, and return them."""
        left = serial - self._dropped
        entries = tuple(self._entries[left:])
        del self._entries[left:]
        self._index_gestures()
        self.restored = min(self.restored, serial)
        return entries

    def drop_before(self, serial: int) -> Entry | None:
        """Drop the requests before a serial, and return the last of them; None is none."""
        count = serial - self._dropped
        dropped = self._entries[:count]
        del self._entries[:count]
        for entry in dropped:
            if isinstance(entry.request, Restore):
                self._loaded = entry.request.state
        self._dropped = serial
        # Of a gesture that began before, the beginning remains known.
        kept = {entry.gesture for entry in self._entries}
        self._gestures = {each: at for each, at in self._gestures.items() if each in kept}
        return dropped[-1] if dropped else None

    def _entry_size(self, request: Request) -> int:
        """Return the memory of a request; equal names of commands are in memory once."""
        if not isinstance(request, Command):
            return request_size(request)
        names = request.names
        request.share_names(self._shared_names(names))
        return request_size(request) + (names_size(names) if request.names is names else 0)

    def _index_gestures(self) -> None:
        self._gestures = {each: at for each, at in self._gestures.items() if at < self._dropped}
        for place, entry in enumerate(self._entries):
            self._gestures.setdefault(entry.gesture, self._dropped + place)


def _same_names(names: tuple[str, ...]) -> tuple[str, ...]:
    return names
