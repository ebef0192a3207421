# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The past: the timeline in force with its cached frames, all other lines, and their budget.

Laws: undo takes the last gesture first, and redo reverts the last undo first, until another
request is applied. After each frame the past is within its budget of memory. See `tree` for the
theory of operation.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

from physsim_ros.model.checkpoint import Checkpoint, WorldState
from physsim_ros.model.error_boundary import ErrorBoundary
from physsim_ros.model.errors import InPast, NotAlone, OutOfHistory, Refusal
from physsim_ros.model.requests import Request
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Answer, Snapshot
from physsim_ros.model.timeline import CourseSpan, TimelineStatus
from physsim_ros.simulation.past.frame_cache import CachedFrame, FrameCache
from physsim_ros.simulation.past.gesture_phrase import gesture_phrase
from physsim_ros.simulation.past.history import History
from physsim_ros.simulation.past.history_memory import HistoryMemory
from physsim_ros.simulation.past.lines import Line, Lines, MOST_COURSES
from physsim_ros.simulation.past.replay import Replay
from physsim_ros.simulation.past.timeline import Timeline
from physsim_ros.simulation.past.tree import Moment, Node, Tree
from physsim_ros.simulation.world import Done, World

# Greatest simulation time that is simulated again where a gesture is taken back [s].
LONGEST_AGAIN = 60.0


class Past:
    """
    The timeline in force, with its cached frames, and the lines that are not in force.

    Requests, undo and redo apply to the moment of the timeline. While a cached frame of another
    moment is shown, `Playback.seek_shown` comes first.

    :param physics_rate: steps a second of simulation time [Hz]
    :param frame_steps: number of steps in a frame at speed 1
    :param settings: of the empty world at the start
    :param length: of the past that is kept [s of simulation time]
    :param checkpoints: from one checkpoint to the next [s]
    :param memory: the budget
    :param boundary: of the requests

    :ivar timeline: the world on the line in force
    :ivar frame_cache: frames of that line
    :ivar course: number of that line
    :ivar reports: of events without a request, for the next frame
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
        boundary: ErrorBoundary,
    ) -> None:
        self.physics_rate = physics_rate
        self.frame_steps = frame_steps
        self.memory = memory
        self._tree = Tree()
        self._lines = Lines(self._tree)
        history = History(
            self._tree,
            memory,
            length=self.steps_in(length),
            spacing=self.steps_in(checkpoints),
        )
        self.reports: list[Answer] = []
        # The world of the timeline, and the one that replays cached frames.
        self._worlds = tuple(
            World(physics_rate=physics_rate, frame_steps=frame_steps) for _ in range(2)
        )
        self.timeline = Timeline(
            self._worlds[0], history, self.reports, WorldState(settings=settings), boundary
        )
        self.frame_cache = FrameCache(Replay(self._worlds[1], history, self.reports), memory)
        self.course = self._courses = 1
        self._era = 0
        # The oldest keyframe when lines that part before it were dropped last.
        self._oldest = history.keyframes[0]

    @property
    def reports_contacts(self) -> bool:
        """Return whether contacts are reported."""
        return self._worlds[0].reports_contacts

    @reports_contacts.setter
    def reports_contacts(self, reports_contacts: bool) -> None:
        for world in self._worlds:
            world.reports_contacts = reports_contacts

    def steps_in(self, seconds: float) -> int:
        """Return the number of steps in a simulation time [s]."""
        return round(seconds * self.physics_rate)

    def status(self, shown: Moment, *, speed: float) -> TimelineStatus:
        """
        Return the status of the timeline in force.

        :param shown: the moment that is shown
        :param speed: simulation seconds a second
        """
        history, rate = self.timeline.history, self.physics_rate
        if speed < 0.0:
            state = 'rewinding'
        elif shown != history.end:
            state = 'in the past'
        else:
            state = 'playing' if speed else 'paused'
        gesture, undo = history.last_gesture(shown[1]), ''
        if gesture is not None:
            undo = gesture_phrase(*gesture)
        elif self._undoes_reset(shown[1]):
            undo = 'reset'
        redo = self._lines.undone[-1].words if self._is_undone else ''
        return TimelineStatus(
            state=state,
            speed=speed,
            oldest=history.oldest / rate,
            now=shown[0] / rate,
            newest=history.head / rate,
            course=self.course,
            undo=undo and f'undo {undo}',
            redo=redo and f'redo {redo}',
            courses=tuple(
                CourseSpan(line.course, min(step, line.head) / rate, line.head / rate)
                for line, step in sorted(self._courses_left(), key=lambda each: each[0].course)
            ),
        )

    def ghost(self, course: int, seconds: float) -> Snapshot | None:
        """
        Return the last snapshot of a course that was left, up to a simulation time.

        :param course: number of the course
        :param seconds: simulation time [s]
        :return: None if it is not kept
        """
        return self._lines.ghost_at(course, self.steps_in(seconds))

    def fit_memory(self, shown: Moment) -> None:
        """
        Drop the oldest entries until everything fits into the budget; report it, once.

        :param shown: the moment that is shown, which is kept
        """
        history, lines, frames = self.timeline.history, self._lines, self.frame_cache
        history.shown = shown
        self._drop_lost()
        kinds = (
            frames.drop_oldest,
            lines.drop_oldest_ghost,
            lines.drop_oldest,
            history.drop_oldest,
        )
        if self.memory.fit(lambda: frames.size + self._tree.size, kinds):
            self.reports.append(self.memory.report(history.oldest / self.physics_rate))

    # Requests

    def apply(self, request: Request, gesture: int, author: str = '') -> Done:
        """
        Apply a request to the world; in the past it begins a course.

        :param gesture: number of its gesture
        :param author: name of the person whose doing it is; '' is nobody's
        :raises Refusal: and nothing is changed
        """
        timeline = self.timeline
        left = self._line() if not timeline.is_newest else None
        try:
            done = timeline.apply(request, gesture, author)
        finally:
            if left is not None and not timeline.world.changed:
                self._lines.drop(left)
        if timeline.world.changed:
            if left is not None:
                self._begin_course(left)
            self._lines.clear_undone(self._era)
        return done

    def _begin_course(self, left: Line) -> None:
        """Begin a course at this moment, and keep the line that was in force."""
        step, _ = self.timeline.moment
        self._keep_course(left, self.frame_cache.drop_from(step))
        self._courses += 1
        self.course = self._courses
        message = f'course {self.course} begins at {step / self.physics_rate:.3f} s'
        self.reports.append(Answer(topic='branch', message=f'{message}; {left.course} is kept'))

    def amend(
        self, gestures: Sequence[int], requests: Sequence[Request], author: str = ''
    ) -> list[Done | Refusal]:
        """
        Replace the requests of earlier gestures, and simulate again up to this moment.

        :param author: name of the person whose doing it is; '' is nobody's
        :return: for each request what `apply` returns, or its refusal
        """
        amended = self.timeline.amend(gestures, requests, author)
        self._lines.clear_undone(self._era)
        self.frame_cache.drop_from(amended.step)
        return amended.done

    def take_back(self, author: str) -> str:
        """
        Take back the last gesture of a person, and simulate again up to this moment.

        What others have done since is done again as it was asked.

        :param author: name of the person
        :return: the phrase for it
        :raises InPast: the past is shown
        :raises OutOfHistory: the person has done nothing that is kept
        :raises NotAlone: what was done since needs it, or is too much to be done again; nothing is
            changed
        """
        timeline, history = self.timeline, self.timeline.history
        if not timeline.is_newest:
            raise InPast('the past is shown; go to its end first', field='history')
        first = history.last_gesture_of(author)
        if first is None:
            raise OutOfHistory(f'there is nothing by {author} to undo', field='history')
        if timeline.moment[0] - first.step > self.steps_in(LONGEST_AGAIN):
            raise NotAlone(f'that was more than {LONGEST_AGAIN:g} s ago; delete it instead')
        before = self._line()
        before.words = gesture_phrase(first, 1)
        amended = timeline.amend((first.gesture,), ())
        if amended.refused:
            left, _ = self._go_to(before)
            self._lines.drop(left)
            raise NotAlone('somebody has used it since; delete it instead')
        self.frame_cache.drop_from(amended.step)
        self._lines.clear_undone(self._era)
        self._lines.undone.append(before)
        return before.words

    def doings_of(self, author: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Return the bodies and the joints in the world that a person has added, by name."""
        return self.timeline.history.added_by(author, self.timeline.world.scene)

    # Moves of the cursor

    def begin(self, state: WorldState) -> None:
        """
        Begin a timeline with a state, at time 0, on course 1.

        Nothing before it can be undone or returned to.

        :raises Refusal: it is too large, or cannot be simulated; nothing is changed
        """
        self.timeline.begin(state)
        self._forget()

    def restore(self, checkpoint: Checkpoint, loaded: WorldState) -> None:
        """
        Begin a timeline at a checkpoint, on course 1; nothing before it can be returned to.

        :param loaded: the state that was loaded last
        """
        self.timeline.restore(checkpoint, loaded)
        self._forget()

    def _forget(self) -> None:
        """Forget all lines but the one in force, which has begun."""
        self._lines.drop_where(lambda _: True)
        self.frame_cache.drop_from(0)
        self.course = self._courses = 1

    def reset(self, seed: int | None = None) -> bool:
        """
        Return to the state that was loaded last, at time 0.

        :param seed: of all noise; None is that of the state
        :return: whether anything had happened since
        :raises BadProperty: the seed is out of range
        """
        history = self.timeline.history
        state = history.tip.loaded.state
        if seed is not None:
            state = replace(state, settings=replace(state.settings, seed=seed))
        if (
            history.head == 0
            and self.timeline.moment[1] == 0
            and state.settings.seed == self.timeline.settings.seed
        ):
            # Nothing has happened since the beginning.
            return False
        self._lines.clear_undone(self._era)
        self._lines.resets.append(self._line())
        self.timeline.begin(state)
        self.frame_cache.drop_from(0)
        self._courses += 1
        self.course, self._era = self._courses, self._era + 1
        return True

    def undo(self) -> str:
        """
        Go back to the moment before the last gesture, and return the phrase for it.

        :raises OutOfHistory: there is none in the history
        """
        history, lines = self.timeline.history, self._lines
        serial = self.timeline.moment[1]
        gesture = history.last_gesture(serial)
        if gesture is not None:
            first, count = gesture
            words, before = gesture_phrase(first, count), history.node(first.serial - 1)
            goal = self._line_to(before, first.step, (first.step, before.serial))
        elif self._undoes_reset(serial):
            # The requests since a reset are undone before it, though they are no longer kept.
            words, goal = 'reset', lines.resets[-1]
        else:
            raise OutOfHistory('there is nothing to undo', field='history')
        left, _ = self._go_to(goal)
        left.words = words
        lines.undone.append(left)
        return words

    def redo(self) -> None:
        """
        Return to the moment of the last undo.

        :raises OutOfHistory: nothing was undone, or another request was applied since
        """
        if not self._is_undone:
            raise OutOfHistory('there is nothing to redo', field='history')
        era = self._era
        left, _ = self._go_to(self._lines.undone[-1])
        if self._era == era:
            self._lines.drop(left)
        else:
            self._lines.resets.append(left)

    def return_to_course(self, number: int) -> bool:
        """
        Return to a course that was left, at this time or its last one.

        :return: whether it is another course than before
        :raises OutOfHistory: the course is no longer kept; nothing is changed
        """
        self.timeline.note_shown()
        if number == self.course:
            return False
        line = next((line for line, _ in self._courses_left() if line.course == number), None)
        if line is None:
            raise OutOfHistory(f'course {number} is not kept', field='course')
        line.moment = min(self.timeline.moment[0], line.head), None
        self._keep_course(*self._go_to(line))
        self._lines.clear_undone(self._era)
        return True

    @property
    def _is_undone(self) -> bool:
        """Whether there is anything to redo."""
        self._drop_lost()
        return bool(self._lines.undone)

    def _undoes_reset(self, serial: int) -> bool:
        """Return whether an undo at a serial reverts a reset: all since the reset is undone."""
        kept = self.timeline.history.oldest == 0
        return serial == 0 and kept and bool(self._lines.resets)

    def _courses_left(self) -> Iterator[tuple[Line, int]]:
        """Yield the courses that can be returned to, each with the step at which it parts."""
        for line in self._lines.left.values():
            step = self.timeline.history.parting(line.tip, line.head)
            if step is not None:
                yield line, step

    def _line(self) -> Line:
        """Return the line in force, kept from now on, at its moment."""
        history = self.timeline.history
        return self._line_to(history.tip, history.head, self.timeline.moment)

    def _line_to(self, tip: Node, head: int, moment: Moment) -> Line:
        """Return a line of the course in force up to a node, kept from now on, at a moment."""
        self._tree.hold(tip)
        return Line(tip=tip, head=head, moment=moment, course=self.course, era=self._era)

    def _go_to(self, line: Line) -> tuple[Line, list[CachedFrame]]:
        """Put a line in force; return the line before, and the frames that only that has shown."""
        left, timeline = self._line(), self.timeline
        frames = self.frame_cache.drop_from(timeline.follow(line.tip, line.head, line.moment))
        reached, _ = timeline.moment
        if reached != line.moment[0]:
            message = f'{reached / self.physics_rate:.3f} s is the oldest that is kept'
            self.reports.append(Answer(topic='history', message=message))
        self.course, self._era = line.course, line.era
        for frame in line.ghost:
            self.frame_cache.add_frame(frame)
        self._lines.drop(line)
        return left, frames

    def _keep_course(self, left: Line, frames: list[CachedFrame]) -> None:
        """Keep a line as a course that was left, with the frames that only it has shown."""
        self._lines.keep_ghost(left, frames)
        courses = self._lines.left
        courses[left.course] = left
        of_era = [line for line in courses.values() if line.era == left.era]
        if len(of_era) > MOST_COURSES:
            self._lines.drop(of_era[0])

    def _drop_lost(self) -> None:
        """Drop lines that part from the line in force before the oldest checkpoint."""
        history = self.timeline.history
        if self._oldest is not history.keyframes[0]:
            self._oldest = history.keyframes[0]
            self._lines.drop_where(
                lambda line: line.era == self._era and history.parting(line.tip, line.head) is None
            )
