# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The timeline: a world with its history, which goes on, back, and along another course.

Laws: a world that goes on from a moment of the past makes the same bits as it did from there
before, until a request changes its course; a request that is refused changes nothing.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from physsim_ros.model.errors import OutOfHistory, Refusal
from physsim_ros.model.requests import Request
from physsim_ros.model.snapshot import Answer
from physsim_ros.simulation.past.courses import Courses
from physsim_ros.simulation.past.history import History
from physsim_ros.simulation.past.records import Entry, Mark, Tail
from physsim_ros.simulation.past.seekable_replay import SeekableReplay
from physsim_ros.simulation.world import World

# The share of the time between two checkpoints in which the bodies for the next one are made
# ready, so that no frame makes them all.
_AHEAD = 0.75


class Timeline(SeekableReplay):
    """
    A world and its history, which new steps and requests are added to.

    :param world: at its beginning
    :param length: steps that are kept
    :param spacing: steps from one checkpoint to the next, at least
    :param log_limit: memory of requests from which on the next checkpoint is due [bytes]
    :param courses: numbers of its courses

    :ivar courses: those that were left
    """

    def __init__(
        self,
        world: World,
        *,
        length: int,
        spacing: int,
        log_limit: int,
        courses: Iterator[int],
    ) -> None:
        self.courses = Courses(courses)
        first = Mark(world.step_count, 0, world.renew(), world.digest())
        super().__init__(
            world, History(first, length=length, spacing=spacing, log_limit=log_limit)
        )
        self._resumed = first.moment
        self._spacing = spacing

    def watch_contacts(self, watching: bool) -> None:  # noqa: FBT001 - a state, not a mode
        """Record contacts from now on, or not."""
        self._world.watching = watching

    def apply(self, request: Request, gesture: int) -> tuple[str, str]:
        """
        Carry out a request; where it changes anything and something lay ahead, a course begins.

        :return: the body concerned, or '', and a sentence that says what was done
        :raises Refusal: and nothing is changed
        """
        self.continue_seek()
        # As it will be carried out again.
        self._enter_checkpoint()
        done = self.world.apply(request)
        if not self.world.changed:
            return done
        # The courses that part in what was undone go with it.
        self.courses.drop_after(self.history.end)
        if self.history.lies_ahead(*self.moment):
            left = self.courses.branch(
                self.moment, self.history.cut(*self.moment, now=self.moment)
            )
            seconds = self.world.step_count * self.world.dt
            message = f'course {self.courses.current} begins at {seconds:.3f} s; {left} is kept'
            self._reports.append(Answer(topic='branch', message=message))
        step = self.world.step_count
        self.history.add_entry(Entry(step, request, gesture, subject=done[0]))
        self.serial += 1
        if self.history.is_log_long:
            # A paused world, too, can drop what is old.
            self.add_checkpoint()
        return done

    @property
    def is_newest(self) -> bool:
        """Whether nothing lies ahead of this moment."""
        return self.moment == self.history.end

    def note_shown(self) -> None:
        """Note that this moment is shown, with all requests until now."""
        self.history.log.note_shown(*self.moment)

    def advance(self, steps: int) -> None:
        """Advance by so many steps: by replay up to the head, and further."""
        end = self.world.step_count + steps
        while self.world.step_count < end:
            if self.world.step_count < self.history.head:
                self._replay_to_stop(min(end, self.history.head))
            else:
                self._apply_logged(self.history.log.serial_at(self.world.step_count))
                self._make_checkpoint()
                self._make_steps(end)
                self.history.note_step(self.world.step_count)

    def keep_within(self, length: int, log_limit: int) -> bool:
        """
        Keep so many steps from now on, with a checkpoint after so many bytes of requests.

        :return: whether the world is at the same moment as before, as of `enter_history`
        """
        # Before what it goes through is dropped.
        self.continue_seek()
        self.history.log_limit = log_limit
        self.history.length = length
        return self.enter_history()

    def enter_history(self) -> bool:
        """
        Go to the oldest step if the world is before it.

        :return: whether the world is at the same moment as before
        """
        history = self.history
        if (
            self.world.step_count >= history.oldest
            and self.moment >= history.checkpoints[0].moment
        ):
            return True
        self.seek(history.oldest)
        return False

    def undo(self) -> Tail:
        """
        Go back to the moment before the last gesture.

        :return: the tail that `redo` needs, the undone gesture first
        :raises OutOfHistory: there is none
        """
        now = self.moment
        undone = self.history.log.last_gesture(now[1])
        if undone is None:
            raise OutOfHistory('there is nothing to undo', field='history')
        step, serial = undone[0].step, now[1] - undone[1]
        tail = self.history.cut(step, serial, now=now)
        self.seek_moment(step, serial)
        return tail

    def return_to_course(self, number: int) -> int:
        """
        Return to a course that was left, at this time or its last.

        :return: the step from which on things go differently
        :raises OutOfHistory: the course is kept no more; nothing is changed
        """
        path = self.courses.path_to(number, self.history)
        if not path:
            return self.history.head
        now = self.moment
        for course in path:
            tail = self.history.exchange(course.tail, course.begins, now=now)
            self.courses.exchange(course, tail)
        history = self.history
        step = max(history.oldest, min(now[0], history.head))
        moment = step, history.log.serial_shown_at(step)
        # Not from here: these steps may be of the course that is left.
        self.resume(history.checkpoint_before(*moment))
        self.seek_moment(*moment)
        return min(course.begins for course in path)[0]

    def amend(
        self, gestures: Sequence[int], requests: Sequence[Request]
    ) -> tuple[int, list[tuple[str, str] | Refusal]]:
        """
        Replace the requests of earlier gestures, and simulate again up to this moment.

        Later requests that the amended past refuses are dropped; so is what lay ahead. Gestures
        that changed nothing, or are kept no more, are left out; without any, the requests are made
        now.

        :param gestures: their numbers, at least one; the requests get the first of them
        :param requests: that take the place of theirs, at their first step
        :return: that step; and for each request what `apply` returns, or its refusal
        """
        now = self.moment
        starts = [self.history.log.gesture_start(each, now[1]) for each in gestures]
        found = [start for start in starts if start is not None]
        step, serial = min(found, key=lambda start: start[1], default=now)
        gesture = gestures[0]
        self.courses.drop_after((step, serial))
        later = [
            each
            for each in self.history.log.entries_between(serial, now[1])
            if each.gesture not in gestures
        ]
        self.history.cut(step, serial, now=now)
        self.seek_moment(step, serial)
        done = [self._try_apply(request, gesture) for request in requests]
        for entry in later:
            self.advance(entry.step - self.world.step_count)
            self._try_apply(entry.request, entry.gesture)
        self.advance(now[0] - self.world.step_count)
        self.world.clear_contacts()
        return step, done

    def _try_apply(self, request: Request, gesture: int) -> tuple[str, str] | Refusal:
        try:
            return self.apply(request, gesture)
        except Refusal as refusal:
            return refusal

    def redo(self, tail: Tail) -> None:
        """
        Return to where something was undone, and to how things went on from there.

        :raises OutOfHistory: it is kept no more
        """
        self.history.splice(tail)
        # Steps made since then are discarded: the world goes on from a checkpoint, not from here.
        self.resume(self.history.checkpoint_before(tail.step, tail.serial))
        self.seek_moment(tail.step, tail.serial)

    def _make_checkpoint(self) -> None:
        """Make a checkpoint where one is due, or where a request followed the last one."""
        self._enter_checkpoint()
        step = self.world.step_count
        changed = self._resumed is not None and self._resumed[0] == step
        due = changed or self.history.is_checkpoint_due(step)
        if due and self.history.checkpoint_at(*self.moment) is None:
            self.add_checkpoint()

    def add_checkpoint(self) -> None:
        """Make a checkpoint now, the last of the history, and go on from it."""
        mark = Mark(*self.moment, self.world.renew(), self.world.digest())
        self.history.add_checkpoint(mark)
        self._resumed = mark.moment

    def build_ahead(self, steps: int) -> None:
        """Build the share of bodies for the next checkpoint that falls to so many steps."""
        bodies = len(self.world)
        self.world.build_bodies(-(-bodies * steps // max(1, int(self._spacing * _AHEAD))))
