# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The past: the cursor on the tree of all lines, and what people do with time.

Laws: undo takes the last gesture first, and redo reverts the last undo first, until another
request is applied. After each frame the past is within its budget of memory: the oldest entries
are dropped, in this order of kinds: frames of the course in force, which a replay makes again;
those of courses that were left; these courses; lines that were undone; lines before resets; last,
the oldest checkpoint of the course in force, with the requests up to the next one. The last
checkpoint, the requests after it, and the frames beside the one that is shown always remain.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from functools import partial

from physsim_ros.model.answer import Answer
from physsim_ros.model.checkpoint import Checkpoint, WorldState
from physsim_ros.model.checks import LONGEST, Within
from physsim_ros.model.errors import Failed, OutOfHistory, Refusal
from physsim_ros.model.requests import Request
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.translation import Text
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.runtime.slices import finish
from physsim_ros.simulation.past.cursor import Cursor, Replay
from physsim_ros.simulation.past.frames import FrameCache
from physsim_ros.simulation.past.line import CachedFrame, Line, LineInForce, Moment
from physsim_ros.simulation.past.tree import Budget, Tree
from physsim_ros.simulation.world import Beginning, Change, World

# Check of the times of a past [s].
_SPAN = Within(0.0, LONGEST, 's')


class Past:
    """
    The cursor on the line in force, the cached frames of that line, and all other lines.

    Requests, undo and redo apply to the moment of the cursor. While a cached frame of another
    moment is shown, `Playback.send_cursor` comes first.

    :param physics_rate: steps a second of simulation time [Hz]
    :param frame_steps: number of steps in a frame at speed 1
    :param settings: of the empty world at the start
    :param length: of the past that is kept [s of simulation time]
    :param checkpoints: from one checkpoint to the next [s]
    :param memory: the budget [MB]
    :param boundary: of the requests
    :raises BadProperty: the memory or a time is out of range
    :raises Malformed: one of them is not finite

    :ivar boundary: of the requests
    :ivar budget: of all that is kept
    :ivar line: in force
    :ivar tree: of all lines
    :ivar cursor: the world at a moment of the line in force
    :ivar frames: that are cached of that line
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
        memory: float,
        boundary: ErrorBoundary,
    ) -> None:
        self.physics_rate = physics_rate
        self.frame_steps = frame_steps
        self.boundary = boundary
        self.budget = Budget(memory)
        self.reports: list[Answer] = []
        self.line = LineInForce(
            length=self.steps_of('history', length),
            spacing=self.steps_of('checkpoints', checkpoints),
        )
        self.tree = Tree(self.line, self.budget)
        # The world of the cursor, and the one that replays cached frames.
        self._worlds = tuple(
            World(physics_rate=physics_rate, frame_steps=frame_steps) for _ in range(2)
        )
        present, shown = self._worlds
        self.cursor = Cursor(present, self.tree, self.reports)
        replay = Replay(shown, self.line, self.reports)
        self.frames = FrameCache(replay, shown, self.line, self.budget)
        self.cursor.begin(WorldState(settings=settings))

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

    def steps_of(self, name: str, seconds: float) -> int:
        """
        Return the number of steps in a setting of the past [s].

        :param name: of the setting, for the refusal
        :raises BadProperty: it is out of range
        :raises Malformed: it is not finite
        """
        return self.steps_in(_SPAN(seconds, name))

    def take_reports(self) -> tuple[Answer, ...]:
        """Return the events without a request since the last call."""
        reports = tuple(self.reports)
        self.reports.clear()
        return reports

    def report_oldest(self, step: int, more: str = '') -> None:
        """Add the event that a step is the oldest that is kept."""
        time = f'{step / self.physics_rate:.3f} s'
        message = Text('{time} is the oldest that is kept{more}', time=time, more=more)
        self.reports.append(Answer(topic='history', message=message))

    def free_slice(self) -> None:
        """Free a part of what worlds were before they were replaced."""
        for world in self._worlds:
            world.free_slice()

    def course_snapshot(self, course: int, seconds: float) -> Snapshot | None:
        """
        Return the last snapshot of a course that was left, up to a simulation time.

        :param course: number of the course
        :param seconds: simulation time [s]
        :return: None if it is not kept
        """
        return self.tree.course_snapshot(course, self.steps_in(seconds))

    def saver_of_run(self) -> Callable[[], WorldState]:
        """
        Return a function that returns, on any thread, the state with which the run began.

        That is the state after the last request of the line, or at the first that is kept.
        """
        line, rate, frame_steps = self.line, self.physics_rate, self.frame_steps
        moment = max(Moment(line.tip.step, line.tip.serial), line.keyframes[0].moment)
        keyframe = line.keyframe_before(*moment)
        # Not the nodes: one that becomes the root has another request from then on.
        nodes = line.nodes_between(keyframe.serial, moment.serial)
        requests = [(node.step, node.request) for node in nodes]

        def save() -> WorldState:
            # In a world of its own, since this one goes on meanwhile.
            run = World(physics_rate=rate, frame_steps=frame_steps)
            run.resume(keyframe.checkpoint)
            for step, request in requests:
                run.step(step - run.step_count)
                # A replay reports a refusal as a divergence.
                with suppress(Refusal):
                    finish(run.slices_of_reapplying(request))
            run.step(moment.step - run.step_count)
            return run.save()

        return save

    def fit_memory(self, shown: Moment) -> None:
        """
        Drop the oldest entries until everything fits into the budget; report it, once.

        :param shown: the moment that is shown, which is kept
        """
        tree, frames, budget = self.tree, self.frames, self.budget
        tree.drop_lost()
        is_full = self._is_full()
        budget.note_relief()
        if not is_full:
            return
        # Frames come back by a replay, and are no loss.
        frames.shrink(budget.size - tree.size)
        is_lost = False
        for drop in (
            tree.drop_oldest_frames,
            tree.drop_oldest_line,
            partial(tree.drop_oldest_checkpoint, shown),
        ):
            while self._is_full() and drop():
                is_lost = True
        if is_lost and budget.note_loss():
            oldest = self.line.oldest / self.physics_rate
            message = Text(
                'the past would take more than {most:g} MB (history_memory): the oldest goes, '
                '{time:.3f} s is the oldest that is kept',
                most=budget.megabytes,
                time=oldest,
            )
            self.reports.append(Answer(topic='history', message=message, code='history'))

    def _is_full(self) -> bool:
        """Count the memory, and return whether it exceeds the budget."""
        return self.budget.count(self.frames.size + self.tree.size)

    # Requests

    def apply(self, request: Request, gesture: int, author: str = '') -> Answer:
        """
        Apply a request to the world; in the past it begins a course.

        :param gesture: number of its gesture
        :param author: name of the person who did it; '' is nobody
        :raises Refusal: and nothing is changed
        """
        change = self._apply(request, gesture, author)
        if change.has_changed:
            self.tree.drop_undone()
        return change.answer

    def apply_unasked(self, request: Request) -> None:
        """
        Apply a request that nobody has made, as the release of a hand that is gone.

        It is in the gesture before it, and is undone with that; what there is to redo stays.

        :raises Refusal: and nothing is changed
        """
        self._apply(request, self.line.node(self.cursor.serial).gesture)

    def _apply(self, request: Request, gesture: int, author: str = '') -> Change:
        cursor = self.cursor
        change = self.carry_out(request)
        if change.has_changed:
            if not cursor.is_newest:
                self._begin_course()
            cursor.log(request, change, gesture, author)
        return change

    def carry_out(self, request: Request) -> Change:
        """
        Carry out a request, in the space in which a replay will carry it out.

        :raises Refusal: the request is refused; where half of it is done, the world is rebuilt
        :raises Failed: in place of an unexpected error; the world is rebuilt
        """
        cursor, world = self.cursor, self.cursor.arrive()
        finish(cursor.slices_of_entering())
        try:
            with self.boundary.message(type(request).__name__):
                return world.apply(request)
        except Refusal as refusal:
            if refusal.is_half_done or isinstance(refusal, Failed):
                cursor.seek_moment(*cursor.moment, elsewhere=True)
            raise

    def _begin_course(self) -> None:
        """Begin a course at this moment, and keep the line that is in force."""
        moment = self.cursor.moment
        left = self.tree.begin_course(moment, self.frames.drop_from(moment.step))
        message = Text(
            'course {course} begins at {time:.3f} s; {left} is kept',
            course=self.tree.course,
            time=moment.step / self.physics_rate,
            left=left.course,
        )
        self.reports.append(Answer(topic='branch', message=message))

    def added_by(self, author: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """Return the bodies and the joints in the world that a person has added, by name."""
        return self.line.added_by(author, self.cursor.arrive().scene)

    # Moves of the cursor

    def begin(self, state: WorldState) -> None:
        """
        Begin a timeline with a state, at time 0, on course 1.

        Nothing before it can be undone or returned to.

        :raises Refusal: it is too large, or cannot be simulated; nothing is changed
        """
        self.cursor.begin(state)
        self._forget()

    def restore(self, checkpoint: Checkpoint, loaded: WorldState) -> None:
        """
        Begin at a checkpoint, on course 1; nothing before it can be returned to.

        :param loaded: the state that was loaded last
        """
        self.cursor.restore(checkpoint, loaded)
        self._forget()

    def _forget(self) -> None:
        """Forget all lines but the one in force, which has begun."""
        self.tree.forget()
        self.frames.drop_from(0)

    def keep_built(self, beginning: Beginning) -> None:
        """Have the cursor's world, when it next begins with the state of a beginning, use that."""
        self._worlds[0].keep_built(beginning)

    def reset(self, seed: int | None = None, ahead: Beginning | None = None) -> bool:
        """
        Return to the state that was loaded last, at time 0.

        :param seed: of all noise; None is that of the state
        :param ahead: the beginning of the state, if it is built already
        :return: whether anything had happened since
        :raises BadProperty: the seed is out of range
        """
        state = self.line.tip.loaded.state
        if seed is not None:
            state = replace(state, settings=replace(state.settings, seed=seed))
        is_begun = self.line.head == 0 and self.cursor.moment.serial == 0
        if is_begun and state.settings.seed == self.cursor.settings.seed:
            # Nothing has happened since the beginning.
            return False
        if ahead is not None:
            self.keep_built(ahead)
        self._begin_anew(state, Text('reset'))
        return True

    def open_world(self, state: WorldState) -> None:
        """
        Begin with another state, at time 0; undo reverts it.

        :raises Refusal: it is too large, or cannot be simulated; nothing is changed
        """
        self._begin_anew(state, Text('open world'))

    def _begin_anew(self, state: WorldState, words: str) -> None:
        """
        Put a line in force that begins with a state, at time 0.

        :param words: phrase for it, which undo has
        :raises Refusal: the state is refused; nothing is changed
        """
        tree = self.tree
        before = tree.line_left_at(self.cursor.moment)
        try:
            self.cursor.begin(state)
        except Refusal:
            tree.drop(before)
            raise
        tree.keep_before_reset(before, words)
        self.frames.drop_from(0)

    def words(self, moment: Moment) -> tuple[str, str]:
        """
        Return the phrases for what undo and redo would change at a moment; '' is nothing.

        :param moment: that is shown
        """
        tree, (_, serial) = self.tree, moment
        redo = tree.undone[-1].words if tree.can_redo else ''
        if gesture := self.line.last_gesture(serial):
            first, count = gesture
            return first.phrase(count), redo
        return tree.resets[-1].words if tree.undoes_reset(serial) else '', redo

    def undo(self) -> str:
        """
        Go back to the moment before the last gesture, and return the phrase for it.

        :raises OutOfHistory: there is none that is kept
        """
        tree, line, moment = self.tree, self.line, self.cursor.moment
        words, _ = self.words(moment)
        if not words:
            raise OutOfHistory('there is nothing to undo', field='history')
        if gesture := line.last_gesture(moment.serial):
            first, _ = gesture
            before = line.node(first.serial - 1)
            goal = tree.line_to(before, first.step, Moment(first.step, before.serial))
        else:
            # The requests since a reset are undone before it, though they are no longer kept.
            goal = tree.resets[-1]
        left, _ = self.go_to(goal)
        tree.undone.append(replace(left, words=words))
        return words

    def redo(self) -> str:
        """
        Return to the moment of the last undo.

        :return: the phrase for what was redone
        :raises OutOfHistory: nothing was undone, or another request was applied since
        """
        tree, resets = self.tree, self.tree.reset_count
        if not tree.can_redo:
            raise OutOfHistory('there is nothing to redo', field='history')
        words = tree.undone[-1].words
        left, _ = self.go_to(tree.undone[-1])
        if tree.reset_count == resets:
            tree.drop(left)
        else:
            tree.resets.append(replace(left, words=words))
        return words

    def return_to_course(self, number: int) -> bool:
        """
        Return to a course that was left, at this time or its last one.

        :return: whether it is another course than before
        :raises OutOfHistory: the course is no longer kept; nothing is changed
        """
        tree, moment = self.tree, self.cursor.moment
        self.line.mark_shown(*moment)
        if number == tree.course:
            return False
        line = next((line for line, _ in tree.courses_left() if line.course == number), None)
        if line is None:
            raise OutOfHistory('course {number} is not kept', field='course', number=number)
        tree.keep_course(*self.go_to(line, (min(moment.step, line.head), None)))
        self.tree.drop_undone()
        return True

    def go_to(
        self, line: Line, moment: tuple[int, int | None] | None = None
    ) -> tuple[Line, list[CachedFrame]]:
        """
        Put a line in force; return the line before, and the frames that only that has shown.

        :param moment: step and serial; a serial of None is that with which the step was shown;
            None is the moment at which the line was left
        """
        tree, cursor, moment = self.tree, self.cursor, moment or line.moment
        left = tree.line_left_at(cursor.moment)
        frames = self.frames.drop_from(cursor.follow(line.tip, line.head, moment))
        reached = cursor.moment.step
        if reached != moment[0]:
            self.report_oldest(reached)
        for frame in line.frames:
            self.frames.add_frame(frame)
        tree.put_in_force(line)
        return left, frames
