# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The past: the timeline in force, and all that was shown, left or undone.

Laws: a cached frame is one of the course in force, a ghost one of a course that was left; after
each frame all of them, with what undo and redo need, are within one budget of memory.
"""

from __future__ import annotations

from collections.abc import Sequence
import itertools

from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import Request, Restore
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Answer, Snapshot
from physsim_ros.model.timeline import TimelineStatus
from physsim_ros.simulation.past.frame_cache import FrameCache
from physsim_ros.simulation.past.ghosts import Ghosts
from physsim_ros.simulation.past.history_memory import HistoryMemory
from physsim_ros.simulation.past.records import Moment
from physsim_ros.simulation.past.timeline import Timeline
from physsim_ros.simulation.past.timeline_status import status_of
from physsim_ros.simulation.past.undo import Undo
from physsim_ros.simulation.world import World


class Past:
    """
    The timeline in force, with its cached frames, ghosts, and what undo and redo need.

    Requests, undo and redo apply to the moment at which the timeline is. A cached frame may be
    shown at another one, so `Playback.seek_shown` comes first.

    :param physics_rate: steps a second of simulation time [Hz]
    :param frame_steps: number of steps in a frame at speed 1
    :param settings: of the empty world at the start
    :param length: how far back it reaches [s of simulation time]
    :param checkpoints: from one checkpoint to the next [s]
    :param memory: budget in bytes

    :ivar frame_cache: frames of the course in force
    """

    def __init__(
        self,
        *,
        physics_rate: float,
        frame_steps: int,
        settings: WorldSettings,
        length: float,
        checkpoints: float,
        memory: HistoryMemory,
    ) -> None:
        self.physics_rate = physics_rate
        self.frame_steps = frame_steps
        self.memory = memory
        self._length = length
        self._checkpoints = checkpoints
        self._watching = False
        self._course_numbers = itertools.count(1)
        self._ghosts = Ghosts()
        self._undo = Undo(self._timeline_of, WorldState(settings=settings))
        self.frame_cache = self._new_frame_cache()

    @property
    def timeline(self) -> Timeline:
        """Return the timeline in force."""
        return self._undo.timeline

    @property
    def watching(self) -> bool:
        """Return whether contacts are recorded."""
        return self._watching

    @watching.setter
    def watching(self, watching: bool) -> None:
        self._watching = watching
        self.timeline.watch_contacts(watching)

    def steps_in(self, seconds: float) -> int:
        """Return the number of steps in a simulation time [s]."""
        return round(seconds * self.physics_rate)

    def status(self, shown: Moment, *, speed: float) -> TimelineStatus:
        """
        Return the status of the timeline in force.

        :param shown: the moment that is shown
        :param speed: simulation seconds a second
        """
        return status_of(self._undo, shown, speed=speed, dt=1.0 / self.physics_rate)

    def ghost(self, course: int, seconds: float) -> Snapshot | None:
        """
        Return the snapshot that a course that was left has shown at a simulation time.

        :param course: number of the course
        :param seconds: simulation time [s]
        :return: the last snapshot until then; None where none is kept
        """
        return self._ghosts.snapshot_at(course, self.steps_in(seconds))

    def take_answers(self) -> list[Answer]:
        """Return the reports of events without a request since the last call."""
        return self.timeline.take_answers() + self.frame_cache.take_answers()

    # Limits

    @property
    def length(self) -> float:
        """Return how far back it reaches [s of simulation time]."""
        return self._length

    def limit_length(self, seconds: float) -> bool:
        """
        Set how far back it reaches [s of simulation time].

        :return: whether the timeline is at the same moment as before
        """
        self._length = seconds
        return self._limit_timeline()

    def limit_memory(self, megabytes: float) -> None:
        """
        Set the budget [MB]; the excess is dropped by the next `fit_memory`.

        :raises Refusal: it is out of range
        """
        self.memory.megabytes = megabytes
        self.frame_cache.budget = self.memory.frame_limit
        self._limit_timeline()

    def fit_memory(self, shown: Moment) -> list[Answer]:
        """
        Drop the oldest until everything fits into the budget.

        :param shown: the moment that is shown, which remains
        :return: the report of that, once
        """
        history = self.timeline.history
        history.shown = shown
        if self.memory.fit(self.frame_cache, (self._ghosts, *self._undo.stores)):
            return [self.memory.report(history.oldest / self.physics_rate)]
        return []

    def _limit_timeline(self) -> bool:
        """Limit the timeline in force, and return whether it is at the same moment as before."""
        return self.timeline.keep_within(self.steps_in(self._length), self.memory.log_limit)

    # Changes of the course in force

    def apply(self, request: Request, gesture: int) -> tuple[str, str]:
        """
        Apply a request to the world.

        :param gesture: that it is part of
        :return: the body or joint concerned, or '', and a sentence that says what was done
        :raises Refusal: and nothing is changed
        """
        courses = self.timeline.courses
        before = courses.current
        done = self.timeline.apply(request, gesture)
        if self.timeline.world.changed:
            self._undo.clear_undone()
        if courses.current != before:
            self._keep_ghost(before, self.timeline.moment[0])
        return done

    def amend(
        self, gestures: Sequence[int], requests: Sequence[Request]
    ) -> list[tuple[str, str] | Refusal]:
        """
        Replace the requests of earlier gestures, and simulate again up to this moment.

        :return: for each request what `apply` returns, or its refusal
        """
        step, done = self.timeline.amend(gestures, requests)
        self._undo.clear_undone()
        self.frame_cache.drop_from(step)
        return done

    def begin(self, state: WorldState) -> None:
        """
        Begin a timeline with a state, at time 0, on course 1.

        Nothing before it can be undone or returned to.
        """
        self._course_numbers = itertools.count(1)
        self._ghosts = Ghosts()
        self._undo.begin(state)
        self.frame_cache = self._new_frame_cache()

    def reset(self) -> bool:
        """
        Return to the state that was loaded last, at time 0.

        :return: whether anything had happened since
        """
        if not self._undo.reset():
            return False
        self.frame_cache = self._new_frame_cache()
        return True

    def undo(self) -> str:
        """
        Go back to the moment before the last gesture, and return the phrase for it.

        :raises OutOfHistory: there is none in the history
        """
        undone, step = self._undo.undo()
        self._drop_frames(step)
        return undone

    def redo(self) -> None:
        """
        Return to the moment at which the last undo was asked for.

        :raises OutOfHistory: nothing was undone, or another request was applied since
        """
        self._drop_frames(self._undo.redo())

    def return_to_course(self, number: int) -> bool:
        """
        Return to a course that was left, at this time or its last.

        :return: whether it is another course than before
        :raises OutOfHistory: it is kept no more; nothing is changed
        """
        self.timeline.note_shown()
        left = self.timeline.courses.current
        step = self.timeline.return_to_course(number)
        if number == left:
            return False
        self._keep_ghost(left, step)
        for frame in self._ghosts.take_course(number):
            self.frame_cache.add_frame(frame)
        self._undo.clear_undone()
        return True

    def _drop_frames(self, step: int | None) -> None:
        """
        Drop the cached frames that another course makes invalid.

        :param step: from which on; None is all, with another timeline in force
        """
        if step is not None:
            self.frame_cache.drop_from(step)
            return
        self.frame_cache = self._new_frame_cache()
        self.timeline.watch_contacts(self._watching)
        if self._limit_timeline():
            # With the contacts of the frame that was shown.
            self.timeline.seek_moment(*self.timeline.moment)

    def _keep_ghost(self, left: int, step: int) -> None:
        """Keep the frames of a course that was left, from the step on where it ends."""
        self._ghosts.add_course(left, self.frame_cache.drop_from(step))
        kept = self.timeline.courses.reachable(self.timeline.history)
        self._ghosts.retain({course.number for course in kept})

    def _timeline_of(self, state: WorldState) -> Timeline:
        """Return a timeline that begins with a state."""
        world = World(
            physics_rate=self.physics_rate, frame_steps=self.frame_steps, settings=state.settings
        )
        world.apply(Restore(state=state))
        world.watching = self._watching
        return Timeline(
            world,
            length=self.steps_in(self._length),
            spacing=self.steps_in(self._checkpoints),
            log_limit=self.memory.log_limit,
            courses=self._course_numbers,
        )

    def _new_frame_cache(self) -> FrameCache:
        """Return an empty frame cache of the timeline."""
        return FrameCache(
            self.timeline.history,
            physics_rate=self.physics_rate,
            frame_steps=self.frame_steps,
            budget=self.memory.frame_limit,
        )
