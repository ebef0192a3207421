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
Undo, redo and reset: the course of events that is followed, and the ways to those that were left.

Law: what was done is undone last first, and redone first first, until something else is done.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import NamedTuple

from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import OutOfHistory
from physsim_ros.model.requests import Grab
from physsim_ros.simulation.history import Entry, Tail
from physsim_ros.simulation.replay import Timeline

# So many steps back can be redone, and so many resets undone.
MOST_UNDONE, MOST_RESETS = 100, 10

# What requests are called whose classes' names are no words for it.
_WORDS = {
    'changebody': 'change',
    'configure': 'settings',
    'deletebodies': 'delete of several',
    'grab': 'drag',
    'grabtoplace': 'place',
    'movebodies': 'move',
    'restore': 'load',
    'deleteall': 'delete of many',
    'unjoin': 'delete',
    'unjoinall': 'delete of many',
}


class Undo:
    """
    The course of events that is followed.

    :param begin: makes a timeline that begins with a state
    :param state: what the first one begins with
    :ivar timeline: the one that is followed
    """

    def __init__(self, begin: Callable[[WorldState], Timeline], state: WorldState) -> None:
        self._begin = begin
        # What was before each reset, and what is ahead of each undo.
        self._left: deque[_Left] = deque(maxlen=MOST_RESETS)
        self._undone: deque[Tail | _Left] = deque(maxlen=MOST_UNDONE)
        # What this course began with.
        self._beginning = state
        self.timeline = begin(state)

    def begin(self, state: WorldState) -> None:
        """Begin with a state, and without a way back."""
        self._left.clear()
        self._undone.clear()
        self._beginning, self.timeline = state, self._begin(state)

    def do(self) -> None:
        """Note that something else is done: what was undone stays so."""
        self._undone.clear()

    def reset(self) -> bool:
        """Return to what was loaded last, at time 0; tell whether that is another moment."""
        history = self.timeline.history
        if history.head == 0 and self.timeline.serial == 0:
            # It has just begun: there is nothing to come back to.
            return False
        self._leave(self._left)
        self._undone.clear()
        self._beginning = history.loaded or self._beginning
        self.timeline = self._begin(self._beginning)
        return True

    def undo(self) -> tuple[str, int | None]:
        """
        Go back to the moment before the last request that changed the world.

        :return: what is undone, in words, and the step from which on things go differently; None
            where all of it does
        :raises OutOfHistory: there is none in the history
        """
        try:
            tail = self.timeline.undo()
        except OutOfHistory:
            # Before the reset come the requests since then, though they are kept no more.
            if not (self._left and self._is_begun):
                raise
            self._leave(self._undone)
            self.timeline, self._beginning = self._left.pop()
            return 'reset', None
        self._undone.append(tail)
        return self._described_tail(tail), tail.entries[0].step

    def undo_words(self, serial: int) -> str:
        """
        Return what `undo` would do, in words; '' if nothing.

        :param serial: number of requests made until the moment that is shown
        """
        undone = self.timeline.history.last_gesture(serial)
        if undone is not None:
            return f'undo {_described(*undone)}'
        return 'undo reset' if self._left and self._is_begun else ''

    @property
    def redo_words(self) -> str:
        """Return what `redo` would do, in words; '' if nothing."""
        if not self._undone:
            return ''
        undone = self._undone[-1]
        return f'redo {self._described_tail(undone)}' if isinstance(undone, Tail) else 'redo reset'

    @property
    def _is_begun(self) -> bool:
        """Whether nothing has been done since the beginning, as far as the history reaches."""
        return self.timeline.serial == 0 and self.timeline.history.oldest == 0

    def _described_tail(self, tail: Tail) -> str:
        """Return the gesture in words that was undone with a tail, the last one."""
        entry = tail.entries[0]
        return _described(entry, tail.serial - self.timeline.serial)

    def redo(self) -> int | None:
        """
        Return to where the last undo was asked for.

        :return: the step from which on things go differently; None where all of it does
        :raises OutOfHistory: nothing was undone, or something else was done since
        """
        if not self._undone:
            raise OutOfHistory('there is nothing to redo', field='history')
        undone = self._undone[-1]
        if isinstance(undone, Tail):
            self.timeline.redo(undone)
            self._undone.pop()
            return undone.entries[0].step
        self._undone.pop()
        self._leave(self._left)
        self.timeline, self._beginning = undone
        return None

    def _leave(self, to: deque[_Left] | deque[Tail | _Left]) -> None:
        """Keep this course, for another is to be followed."""
        to.append(_Left(self.timeline, self._beginning))


class _Left(NamedTuple):
    """
    A course of events that was left, by a reset or by undoing one.

    :ivar timeline: it, at the moment that was shown then
    :ivar beginning: what it began with
    """

    timeline: Timeline
    beginning: WorldState


def _described(entry: Entry, count: int) -> str:
    """
    Return a gesture in words.

    :param entry: its first request
    :param count: of its requests
    """
    kind = type(entry.request).__name__.lower()
    words = f'{_WORDS.get(kind, kind)} {entry.subject}'.rstrip()
    # All moves of a hand are one drag.
    more = count > 1 and not isinstance(entry.request, Grab)
    return f'{words} and {count - 1} more' if more else words
