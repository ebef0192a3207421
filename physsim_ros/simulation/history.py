# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
History: the log of the requests to a world, and the checkpoints from which it is replayed.

Laws: a moment is a step and the number of requests made until then; the same log from the same
checkpoint leads to the same bits; what is dropped is dropped from one end.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from functools import lru_cache

from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import OutOfHistory
from physsim_ros.model.requests import Command, Request, Restore
from physsim_ros.simulation.memory_size import checkpoint_size, names_size, request_size
from physsim_ros.simulation.records import Entry, Mark, Moment, Tail, total_size

# Number of tuples of names that commands of the log share: one a publisher.
_SHARED_NAMES = 16


class History:
    """
    The log and the checkpoints of one course of events.

    :param first: checkpoint of the beginning
    :param length: steps that are kept, at least
    :param spacing: steps from one checkpoint to the next, at least

    :ivar log_limit: memory of the requests after the last checkpoint, from which on the next one
        is due [bytes]: what lies after a checkpoint can be dropped only together with it
    :ivar size: memory that the log and the checkpoints take [bytes]
    :ivar shown: the moment that is shown; the checkpoint that it is replayed from is not dropped
        for want of memory
    """

    def __init__(self, first: Mark, *, length: int, spacing: int, log_limit: int) -> None:
        self.log_limit = log_limit
        self._spacing = spacing
        self._length = length
        self._entries: list[Entry] = []
        # Number of requests that were dropped from the log.
        self._dropped = first.serial
        # The state that was loaded last among those.
        self._loaded: WorldState | None = None
        # The number of requests up to the last that loaded anything.
        self._restored = 0
        # The number of requests before the first one of each gesture.
        self._gestures: dict[int, int] = {}
        self._marks = [first._replace(size=checkpoint_size(first.key))]
        self.shown = first.moment
        # Whether the oldest step was shown without requests that were dropped with it.
        self._begins_later = False
        # Memory of the requests after the last checkpoint [bytes].
        self._since = 0
        self._count_size()
        # The last step that was reached.
        self.head = first.step
        # Returns the names of an earlier command that are equal: publishers command the same
        # bodies again and again.
        self._shared_names = lru_cache(maxsize=_SHARED_NAMES)(_same_names)

    # Reading

    @property
    def length(self) -> int:
        """Return how many steps are kept."""
        return self._length

    @length.setter
    def length(self, length: int) -> None:
        self._length = length
        self._drop_old()

    @property
    def oldest(self) -> int:
        """Return the oldest step that can be gone back to."""
        first = self._marks[0].step + self._begins_later
        return min(self.head, max(first, self.head - self._length))

    @property
    def end(self) -> Moment:
        """Return the last moment that was reached."""
        return self.head, self._dropped + len(self._entries)

    @property
    def checkpoints(self) -> list[Mark]:
        """Return the checkpoints, oldest first."""
        return self._marks

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

    def checkpoint_before(self, step: int, serial: int) -> Mark:
        """Return the last checkpoint from which a moment can be reached."""
        place = bisect_right(self._marks, (step, serial), key=lambda each: each.moment)
        return self._marks[place - 1]

    def checkpoint_at(self, step: int, serial: int) -> Mark | None:
        """Return the checkpoint of exactly that moment; None is none."""
        mark = self.checkpoint_before(step, serial)
        return mark if mark.moment == (step, serial) else None

    def segment(self, step: int) -> tuple[Mark, int]:
        """Return the checkpoint before a step, and the step of the next one, or the last step."""
        place = bisect_left(self._marks, step, key=lambda each: each.step)
        first = self._marks[max(0, place - 1)]
        end = self._marks[place].step if place < len(self._marks) else self.head
        return first, max(step, end)

    def next_stop(self, step: int, end: int) -> int:
        """Return the next step at which there is a request or a checkpoint, or the end."""
        entry = bisect_right(self._entries, step, key=lambda each: each.step)
        mark = bisect_right(self._marks, step, key=lambda each: each.step)
        stops = [end]
        if entry < len(self._entries):
            stops.append(self._entries[entry].step)
        if mark < len(self._marks):
            stops.append(self._marks[mark].step)
        return min(stops)

    def is_checkpoint_due(self, step: int) -> bool:
        """Return whether a checkpoint is due at a step; a loaded state begins with one."""
        last = self._marks[-1]
        long = step - last.step >= self._spacing or self.is_log_long
        return long or self._restored > last.serial

    @property
    def is_log_long(self) -> bool:
        """Whether the requests after the last checkpoint take so much that the next is due."""
        return self._since > self.log_limit

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

    def note_step(self, step: int) -> None:
        """Note that the world has reached a step."""
        if step > self.head:
            self.head = step
            self._drop_old()

    def lies_ahead(self, step: int, serial: int) -> bool:
        """Return whether there are steps or requests after a moment."""
        return self.head > step or serial < self._dropped + len(self._entries)

    def add_entry(self, entry: Entry) -> None:
        """Add a request that changed the world, as the last."""
        entry.size = entry.size or self._entry_size(entry.request)
        self.size += entry.size
        self._since += entry.size
        self._gestures.setdefault(entry.gesture, self._dropped + len(self._entries))
        self._entries.append(entry)
        if isinstance(entry.request, Restore):
            self._restored = self._dropped + len(self._entries)

    def _entry_size(self, request: Request) -> int:
        """Return the memory of a request; equal names of commands are in memory once."""
        if not isinstance(request, Command):
            return request_size(request)
        names = request.names
        request.share_names(self._shared_names(names))
        return request_size(request) + (names_size(names) if request.names is names else 0)

    def note_shown(self, step: int, serial: int) -> None:
        """Note that a step has been shown, with the requests up to a serial."""
        place = serial - self._dropped
        while place > 0 and self._entries[place - 1].step == step:
            place -= 1
            if self._entries[place].shown:
                break
            self._entries[place].shown = True

    def add_checkpoint(self, mark: Mark) -> None:
        """Add a checkpoint, as the last."""
        mark = mark._replace(size=checkpoint_size(mark.key, self._marks[-1].key))
        self._marks.append(mark)
        self.size += mark.size
        self._since = 0

    def cut(self, step: int, serial: int, *, now: Moment) -> Tail:
        """
        Cut off what came after a moment.

        :param now: the moment at which that is asked
        """
        head, entries, marks = self.head, tuple(self._entries), tuple(self._marks)
        self._truncate(step, serial)
        after, done, left = self._marks[-1].moment, len(self._entries), len(self._marks)
        return Tail(after, entries[done:], marks[left:], head, *now)

    def exchange(self, tail: Tail, begins: Moment, *, now: Moment) -> Tail:
        """
        Cut off what came after a moment, and append another tail instead.

        :param begins: the moment at which the two part
        :param now: the moment that is shown
        :return: the tail that is cut off
        :raises OutOfHistory: the beginning is too long ago; nothing is changed
        """
        self._check_splice(tail)
        own = self.cut(*begins, now=now)
        # Checkpoints that only this course has made, at that very moment.
        common = bisect_right(self._marks, tail.after, key=lambda each: each.moment)
        marks = (*self._marks[common:], *own.marks)
        own = own._replace(after=self._marks[common - 1].moment, marks=marks)
        self.splice(tail)
        return own

    def splice(self, tail: Tail) -> None:
        """
        Append a tail that was cut off.

        :raises OutOfHistory: that is too long ago
        """
        self._check_splice(tail)
        while self._marks[-1].moment > tail.after:
            self._marks.pop()
        for entry in tail.entries:
            self.add_entry(entry)
        self._marks += tail.marks
        self._count_size()
        self.head = tail.head
        self._drop_old()

    def _check_splice(self, tail: Tail) -> None:
        if self._marks[0].moment > tail.after:
            raise OutOfHistory('what was undone is kept no more', field='history')

    def _truncate(self, step: int, serial: int) -> None:
        left = serial - self._dropped
        del self._entries[left:]
        self._index_gestures()
        self._restored = min(self._restored, serial)
        while self._marks[-1].step > step or self._marks[-1].serial > serial:
            self._marks.pop()
        self._count_size()
        self.head = step

    def _drop_old(self) -> None:
        """Drop what is older than `length`, but the checkpoint before the oldest step."""
        old = bisect_right(self._marks, self.head - self._length, key=lambda each: each.step) - 1
        if old > 0:
            self._drop_before(old)

    def drop_oldest(self) -> int:
        """
        Drop the oldest checkpoint and the requests up to the next one.

        :return: memory that they took [bytes]; 0 where that checkpoint is still needed
        """
        if len(self._marks) == 1 or self._marks[1].moment > self.shown:
            return 0
        before = self.size
        self._drop_before(1)
        return before - self.size

    def _drop_before(self, place: int) -> None:
        """Drop the checkpoints before one of them, and the requests up to it."""
        del self._marks[:place]
        first = self._marks[0]
        count = first.serial - self._dropped
        dropped = self._entries[:count]
        del self._entries[:count]
        for entry in dropped:
            if isinstance(entry.request, Restore):
                self._loaded = entry.request.state
        last = dropped[-1] if dropped else None
        self._begins_later = last is not None and last.step == first.step and not last.shown
        self._dropped = first.serial
        # Of a gesture that began before, the beginning remains known.
        kept = {entry.gesture for entry in self._entries}
        self._gestures = {each: at for each, at in self._gestures.items() if each in kept}
        self._count_size()

    def _count_size(self) -> None:
        """Count the memory of all requests and checkpoints, and of those requests at the end."""
        last = self._marks[-1].serial - self._dropped
        self._since = total_size(self._entries[last:])
        # The scene of the first checkpoint was counted with one that is dropped.
        first = self._marks[0]
        scene = checkpoint_size(first.key) - first.size
        self.size = total_size(self._entries) + total_size(self._marks) + scene

    def _index_gestures(self) -> None:
        self._gestures = {each: at for each, at in self._gestures.items() if at < self._dropped}
        for place, entry in enumerate(self._entries):
            self._gestures.setdefault(entry.gesture, self._dropped + place)


def _same_names(names: tuple[str, ...]) -> tuple[str, ...]:
    return names
