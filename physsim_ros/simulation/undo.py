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
Undo, redo and reset: the timeline in force, and those from before each reset.

Law: gestures are undone last first, and redone first first, until another request is applied.
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
    The timeline in force, and what undo, redo and reset need to replace it.

    :param begin: makes a timeline that begins with a state
    :param state: that the first one begins with
    :ivar timeline: the one in force
    """

    def __init__(self, begin: Callable[[WorldState], Timeline], state: WorldState) -> None:
        self._begin = begin
        # The timeline before each reset; the tail that each undo cut off, or the timeline it left.
        self._before_resets: deque[_StoredTimeline] = deque(maxlen=MOST_RESETS)
        self._undone: deque[Tail | _StoredTimeline] = deque(maxlen=MOST_UNDONE)
        # The state that this timeline began with.
        self._beginning = state
        self.timeline = begin(state)

    def begin(self, state: WorldState) -> None:
        """Begin a timeline with a state; nothing before it can be undone."""
        self._before_resets.clear()
        self._undone.clear()
        self._beginning, self.timeline = state, self._begin(state)

    def clear_undone(self) -> None:
        """Drop what could be redone: another request was applied."""
        self._undone.clear()

    def reset(self) -> bool:
        """Return to the state that was loaded last, at time 0, and whether it was not there."""
        history = self.timeline.history
        if history.head == 0 and self.timeline.serial == 0:
            # Nothing has happened since the beginning.
            return False
        self._store_timeline(self._before_resets)
        self._undone.clear()
        self._beginning = history.last_loaded or self._beginning
        self.timeline = self._begin(self._beginning)
        return True

    def undo(self) -> tuple[str, int | None]:
        """
        Go back to the moment before the last request that changed the world.

        :return: the undone gesture in words, and the step from which on frames differ; None is all
        :raises OutOfHistory: there is none in the history
        """
        try:
            tail = self.timeline.undo()
        except OutOfHistory:
            # Before the reset come the requests since then, though they are kept no more.
            if not (self._before_resets and self._is_begun):
                raise
            self._store_timeline(self._undone)
            self.timeline, self._beginning = self._before_resets.pop()
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
        return 'undo reset' if self._before_resets and self._is_begun else ''

    @property
    def redo_words(self) -> str:
        """Return the words for the request that `redo` would repeat; '' if there is none."""
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

        :return: the step from which on frames differ; None is all
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
        self._store_timeline(self._before_resets)
        self.timeline, self._beginning = undone
        return None

    def _store_timeline(self, to: deque[_StoredTimeline] | deque[Tail | _StoredTimeline]) -> None:
        """Store the timeline in force, before another one replaces it."""
        to.append(_StoredTimeline(self.timeline, self._beginning))


class _StoredTimeline(NamedTuple):
    """
    A timeline that was left by a reset, or by undoing one.

    :ivar timeline: at the moment that was shown then
    :ivar beginning: the state that it began with
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
