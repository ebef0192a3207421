# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Undo, redo and reset: the timeline in force, and those from before each reset.

Law: gestures are undone last first, and redone first first, until another request is applied.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Generic, NamedTuple, TypeVar

from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import OutOfHistory
from physsim_ros.simulation.past.gesture_phrase import gesture_phrase
from physsim_ros.simulation.past.history_memory import Store
from physsim_ros.simulation.past.memory_size import world_size
from physsim_ros.simulation.past.records import Tail
from physsim_ros.simulation.past.timeline import Timeline

_Stored = TypeVar('_Stored', bound='Tail | _StoredTimeline')


class UndoStack(Generic[_Stored]):
    """
    Tails and timelines that an undo or a reset replaced, the last of them on top.

    :ivar size: memory that it takes [bytes]
    """

    def __init__(self) -> None:
        self.size = 0
        self._stored: deque[tuple[_Stored, int]] = deque()

    def __len__(self) -> int:
        return len(self._stored)

    @property
    def last(self) -> _Stored:
        """Return the tail or timeline on top."""
        return self._stored[-1][0]

    def add(self, stored: _Stored) -> None:
        """Put a tail or timeline on top."""
        size = stored.size
        self.size += size
        self._stored.append((stored, size))

    def pop(self) -> _Stored:
        """Remove and return the tail or timeline on top."""
        stored, size = self._stored.pop()
        self.size -= size
        return stored

    def drop_oldest(self) -> int:
        """Drop the lowest tail or timeline; return the memory that it took [bytes]."""
        if not self._stored:
            return 0
        _, size = self._stored.popleft()
        self.size -= size
        return size

    def clear(self) -> None:
        """Drop all tails and timelines."""
        self._stored.clear()
        self.size = 0


class Undo:
    """
    The timeline in force, and the tails and timelines that undo and redo put in its place.

    :param begin: makes a timeline that begins with a state
    :param state: that the first one begins with
    :ivar timeline: the one in force
    :ivar before_resets: the timeline before each reset
    :ivar undone: the tail that each undo cut off, or the timeline that it left
    """

    def __init__(self, begin: Callable[[WorldState], Timeline], state: WorldState) -> None:
        self._begin = begin
        self.before_resets = UndoStack[_StoredTimeline]()
        self.undone = UndoStack[Tail | _StoredTimeline]()
        # The state that this timeline began with.
        self._beginning = state
        self.timeline = begin(state)

    @property
    def stores(self) -> tuple[Store, ...]:
        """Return the stores of the past, in the order in which they drop their oldest."""
        timeline = self.timeline
        return timeline.courses, self.undone, self.before_resets, timeline.history

    def begin(self, state: WorldState) -> None:
        """Begin a timeline with a state; nothing before it can be undone."""
        self.before_resets.clear()
        self.undone.clear()
        self._beginning, self.timeline = state, self._begin(state)

    def clear_undone(self) -> None:
        """Drop what was undone: another request was applied, so that there is no redo."""
        self.undone.clear()

    def reset(self) -> bool:
        """
        Return to the state that was loaded last, at time 0.

        :return: whether anything had happened since
        """
        history = self.timeline.history
        if history.head == 0 and self.timeline.moment[1] == 0:
            # Nothing has happened since the beginning.
            return False
        self._store_timeline(self.before_resets)
        self.undone.clear()
        self._beginning = history.log.last_loaded or self._beginning
        self.timeline = self._begin(self._beginning)
        return True

    def undo(self) -> tuple[str, int | None]:
        """
        Go back to the moment before the last request that changed the world.

        :return: the phrase for the undone gesture, and the step from which on frames differ; None
            is all
        :raises OutOfHistory: there is none in the history
        """
        try:
            tail = self.timeline.undo()
        except OutOfHistory:
            # Before the reset come the requests since then, though they are kept no more.
            if not (self.before_resets and self._is_begun):
                raise
            self._store_timeline(self.undone)
            self.timeline, self._beginning = self.before_resets.pop()
            return 'reset', None
        self.undone.add(tail)
        return self._described_tail(tail), tail.entries[0].step

    def undo_words(self, serial: int) -> str:
        """
        Return the phrase for the gesture that `undo` would undo; '' if there is none.

        :param serial: number of requests made until the moment that is shown
        """
        undone = self.timeline.history.log.last_gesture(serial)
        if undone is not None:
            return f'undo {gesture_phrase(*undone)}'
        return 'undo reset' if self.before_resets and self._is_begun else ''

    @property
    def redo_words(self) -> str:
        """Return the phrase for the gesture that `redo` would repeat; '' if there is none."""
        if not self.undone:
            return ''
        undone = self.undone.last
        return f'redo {self._described_tail(undone)}' if isinstance(undone, Tail) else 'redo reset'

    @property
    def _is_begun(self) -> bool:
        """Whether nothing has been done since the beginning, as far as the history reaches."""
        return self.timeline.moment[1] == 0 and self.timeline.history.oldest == 0

    def _described_tail(self, tail: Tail) -> str:
        """Return the phrase for the gesture that was undone with the tail on top."""
        entry = tail.entries[0]
        return gesture_phrase(entry, tail.serial - self.timeline.moment[1])

    def redo(self) -> int | None:
        """
        Return to the moment at which the last undo was asked for.

        :return: the step from which on frames differ; None is all
        :raises OutOfHistory: nothing was undone, or another request was applied since
        """
        if not self.undone:
            raise OutOfHistory('there is nothing to redo', field='history')
        undone = self.undone.last
        if isinstance(undone, Tail):
            self.timeline.redo(undone)
            self.undone.pop()
            return undone.entries[0].step
        self.undone.pop()
        self._store_timeline(self.before_resets)
        self.timeline, self._beginning = undone
        return None

    def _store_timeline(
        self, to: UndoStack[_StoredTimeline] | UndoStack[Tail | _StoredTimeline]
    ) -> None:
        """Store the timeline in force, before another one replaces it."""
        to.add(_StoredTimeline(self.timeline, self._beginning))


class _StoredTimeline(NamedTuple):
    """
    A timeline that was left by a reset, or by undoing one.

    :ivar timeline: at the moment that was shown then
    :ivar beginning: the state that it began with
    """

    timeline: Timeline
    beginning: WorldState

    @property
    def size(self) -> int:
        """Return the memory that it takes [bytes]."""
        timeline = self.timeline
        world = world_size(timeline.world.scene)
        return timeline.history.size + timeline.courses.size + world
