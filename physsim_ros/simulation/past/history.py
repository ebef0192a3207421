# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
History: the log of the requests to a world, and the checkpoints from which it is replayed.

Laws: a moment is a step and the number of requests made until then; the same log from the same
checkpoint leads to the same bits; what is dropped is dropped from one end.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right

from physsim_ros.model.errors import OutOfHistory
from physsim_ros.simulation.past.memory_size import checkpoint_size
from physsim_ros.simulation.past.records import Entry, Mark, Moment, Tail, total_size
from physsim_ros.simulation.past.request_log import RequestLog


class History:
    """
    The log and the checkpoints of one course of events.

    :param first: checkpoint of the beginning
    :param length: steps that are kept, at least
    :param spacing: steps from one checkpoint to the next, at least

    :ivar log: the requests
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
        self.log = RequestLog(first.serial)
        self._marks = [first._replace(size=checkpoint_size(first.key))]
        self.shown = first.moment
        # Whether the oldest step was shown without requests that were dropped with it.
        self._begins_later = False
        # Memory of the requests after the last checkpoint [bytes].
        self._since = 0
        self._count_size()
        # The last step that was reached.
        self.head = first.step

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
        return self.head, self.log.end

    @property
    def checkpoints(self) -> list[Mark]:
        """Return the checkpoints, oldest first."""
        return self._marks

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
        mark = bisect_right(self._marks, step, key=lambda each: each.step)
        if mark < len(self._marks):
            end = min(end, self._marks[mark].step)
        return self.log.next_stop(step, end)

    def is_checkpoint_due(self, step: int) -> bool:
        """Return whether a checkpoint is due at a step; a loaded state begins with one."""
        last = self._marks[-1]
        long = step - last.step >= self._spacing or self.is_log_long
        return long or self.log.restored > last.serial

    @property
    def is_log_long(self) -> bool:
        """Whether the requests after the last checkpoint take so much that the next is due."""
        return self._since > self.log_limit

    # Changing

    def note_step(self, step: int) -> None:
        """Note that the world has reached a step."""
        if step > self.head:
            self.head = step
            self._drop_old()

    def lies_ahead(self, step: int, serial: int) -> bool:
        """Return whether there are steps or requests after a moment."""
        return self.head > step or serial < self.log.end

    def add_entry(self, entry: Entry) -> None:
        """Add a request that changed the world, as the last."""
        self.log.add_entry(entry)
        self.size += entry.size
        self._since += entry.size

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
        head, marks = self.head, tuple(self._marks)
        entries = self.log.cut(serial)
        while self._marks[-1].step > step or self._marks[-1].serial > serial:
            self._marks.pop()
        left = len(self._marks)
        self._count_size()
        self.head = step
        return Tail(self._marks[-1].moment, entries, marks[left:], head, *now)

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

    def _drop_old(self) -> None:
        """Drop checkpoints older than `length`, but for the last one before the oldest step."""
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
        last = self.log.drop_before(first.serial)
        self._begins_later = last is not None and last.step == first.step and not last.shown
        self._count_size()

    def _count_size(self) -> None:
        """Count the memory of all requests and checkpoints, and of those requests at the end."""
        since = self.log.entries_between(self._marks[-1].serial, self.log.end)
        self._since = total_size(since)
        # The scene of the first checkpoint was counted with one that is dropped.
        first = self._marks[0]
        scene = checkpoint_size(first.key) - first.size
        self.size = self.log.size + total_size(self._marks) + scene
