# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The timeline: a world on the line of events in force, and the cursor, its moment.

Laws: a world that continues from a moment of the past makes the same bits as before, until a
request changes its course; a refused request changes nothing. A seek under way counts as done:
moment and settings are those of its goal, a reader of the world finishes it, and another seek
replaces it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

from physsim_ros.model.checkpoint import Checkpoint, WorldState
from physsim_ros.model.error_boundary import ErrorBoundary
from physsim_ros.model.errors import Failed, OutOfHistory, Refusal
from physsim_ros.model.requests import Request
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Answer
from physsim_ros.simulation.past.history import History
from physsim_ros.simulation.past.replay import Replay
from physsim_ros.simulation.past.tree import Moment, Node
from physsim_ros.simulation.world import Done, World

# Share of the time between two checkpoints in which the bodies for the next one are built [1], so
# that no frame builds all.
_AHEAD = 0.75


class _Seek(NamedTuple):
    """
    A seek that is under way.

    :ivar begin: first moment of the frame of the goal, from which its contacts are summed; None if
        it is reached
    :ivar goal: moment that is shown
    :ivar with_contacts: whether the contacts of that frame are still to be shown
    """

    begin: Moment | None
    goal: Moment
    with_contacts: bool


class Amended(NamedTuple):
    """
    The result of an amendment of the past.

    :ivar step: the first one that differs
    :ivar done: for each new request its result or its refusal
    :ivar refused: whether a later request was refused, and dropped
    """

    step: int
    done: list[Done | Refusal]
    refused: bool


class Timeline(Replay):
    """
    A world and its history, to which new steps and requests are added.

    :param world: that begins with a state
    :param history: of the world
    :param reports: of events without a request, to which it adds
    :param state: at time 0
    :param boundary: of the requests
    """

    def __init__(
        self,
        world: World,
        history: History,
        reports: list[Answer],
        state: WorldState,
        boundary: ErrorBoundary,
    ) -> None:
        super().__init__(world, history, reports)
        self._boundary = boundary
        self._seek: _Seek | None = None
        self.begin(state)

    def begin(self, state: WorldState) -> None:
        """
        Begin with another state, at time 0.

        :raises Refusal: it is too large, or cannot be simulated; nothing is changed
        """
        self._world.begin(state, 0)
        self._begin_history(state, self._world.renew())

    def restore(self, checkpoint: Checkpoint, loaded: WorldState) -> None:
        """
        Begin at a checkpoint, at its time.

        :param loaded: the state that was loaded last
        """
        self._world.resume(checkpoint)
        self._begin_history(loaded, checkpoint)

    def _begin_history(self, loaded: WorldState, checkpoint: Checkpoint) -> None:
        self._seek, self.serial = None, 0
        self.history.begin(loaded, checkpoint, self._world.digest())
        self._resumed = self.moment

    # The cursor

    @property
    def world(self) -> World:
        """Return the world, at this moment."""
        self.continue_seek()
        return self._world

    @property
    def is_seeking(self) -> bool:
        """Whether a seek is under way."""
        return self._seek is not None

    @property
    def settings(self) -> WorldSettings:
        """Return the settings of the world at this moment."""
        return self.history.node(self.moment[1]).settings

    @property
    def moment(self) -> Moment:
        """Return step and serial, those of the goal while a seek is under way."""
        return super().moment if self._seek is None else self._seek.goal

    def seek(self, step: int, *, with_contacts: bool = True) -> None:
        """
        Go to a step of the history, as it was shown.

        :param with_contacts: whether the contacts of its frame are still to be shown
        :raises OutOfHistory: the time is no longer kept, or in the future
        """
        history, dt = self.history, self._world.dt
        if not history.oldest <= step <= history.head:
            raise OutOfHistory(
                f'{step * dt:.3f} s is not in the history, which reaches from '
                f'{history.oldest * dt:.3f} to {history.head * dt:.3f} s',
                field='clock',
            )
        moment = step, history.serial_shown_at(step)
        self.seek_moment(*moment, with_contacts=with_contacts)

    def seek_moment(
        self, step: int, serial: int, *, with_contacts: bool = True, elsewhere: bool = False
    ) -> None:
        """
        Go to a moment of the past, from the checkpoint before it or from this moment.

        :param elsewhere: whether the world is on another line now
        """
        history, frame = self.history, self._world.frame_steps
        # Contacts are those of one frame, as they were the first time.
        begin = max(history.oldest, step - (step % frame or frame))
        start = begin, history.serial_shown_at(begin)
        first = (step, serial)
        if self._world.reports_contacts:
            first = min(first, start)
        keyframe = history.keyframe_before(*first)
        # A seek that this one replaces has also come to a moment of the history.
        if elsewhere or not keyframe.moment <= super().moment <= first:
            self.resume(keyframe)
        self._seek = _Seek(min(start, (step, serial)), (step, serial), with_contacts)

    def continue_seek(self, is_overdue: Callable[[], bool] = lambda: False) -> bool:
        """
        Replay towards the goal of a seek.

        :param is_overdue: whether the replay is to continue in another call
        :return: whether the goal is reached
        """
        seek, self._seek = self._seek, None
        if seek is None:
            return True
        done = seek.begin is None or self.replay_to(*seek.begin, is_overdue)
        if done and seek.begin is not None:
            self._world.clear_contacts()
            seek = seek._replace(begin=None)
        if not done or not self.replay_to(*seek.goal, is_overdue):
            self._seek = seek
            return False
        if not seek.with_contacts:
            self._world.clear_contacts()
        return True

    # Going on

    def apply(self, request: Request, gesture: int, author: str = '') -> Done:
        """
        Carry out a request; if it changes anything, it is the new tip.

        :param author: name of the person whose doing it is; '' is nobody's
        :raises Refusal: and nothing is changed
        """
        self.continue_seek()
        # A replay will carry it out in that space, too.
        self._enter_checkpoint()
        try:
            with self._boundary.message(type(request).__name__):
                done = self.world.apply(request)
        except Failed:
            # Half of it may be done: the world is built again from the checkpoint before it.
            self.seek_moment(*self.moment, elsewhere=True)
            raise
        if self.world.changed:
            self.history.add_request(
                self.moment,
                request,
                gesture=gesture,
                author=author,
                subject=done.subject,
                settings=self.world.settings,
            )
            self.serial += 1
            if self.history.is_log_long:
                # So that a paused world can drop its oldest requests.
                self.add_keyframe()
        return done

    @property
    def is_newest(self) -> bool:
        """Whether nothing lies ahead of this moment."""
        return self.moment == self.history.end

    def note_shown(self) -> None:
        """Note that this moment is shown, with all requests up to it."""
        self.history.note_shown(*self.moment)

    def advance(self, steps: int) -> None:
        """Advance by a number of steps: by replay up to the head, then by new steps."""
        history = self.history
        end = self.world.step_count + steps
        while self.world.step_count < end:
            if self.world.step_count < history.head:
                self._replay_to_stop(min(end, history.head))
            else:
                self._apply_logged(history.serial_at(self.world.step_count))
                self._make_checkpoint()
                self._make_steps(end)
                history.note_step(self.world.step_count)

    def keep_within(self, length: int) -> bool:
        """
        Limit the history; if the world is before the oldest step that is kept then, go to it.

        :param length: steps that are kept
        :return: whether the world is at the same moment as before
        """
        # Before the steps that it replays are dropped.
        self.continue_seek()
        history = self.history
        history.limit_length(length)
        if self.world.step_count >= history.oldest and self.moment >= history.keyframes[0].moment:
            return True
        self.seek(history.oldest)
        return False

    def follow(self, tip: Node, head: int, moment: tuple[int, int | None]) -> int:
        """
        Put another line in force, and go to a moment of it, or to the oldest that is kept.

        :param tip: of the line
        :param head: the last step that it has reached
        :param moment: step and serial; a serial of None is that with which the step was shown
        :return: the first step at which the lines differ
        """
        differs = self.history.follow(tip, head)
        step, serial = max(moment[0], self.history.oldest), moment[1]
        first = self.history.keyframes[0]
        if serial is None or step != moment[0] or (step, serial) < first.moment:
            serial = self.history.serial_shown_at(step)
        self.seek_moment(step, serial, elsewhere=True)
        return differs

    def amend(
        self, gestures: Sequence[int], requests: Sequence[Request], author: str = ''
    ) -> Amended:
        """
        Replace the requests of earlier gestures, and simulate again up to this moment.

        Later requests that the amended past refuses are dropped, and so is the future of this
        moment. Gestures that changed nothing or are no longer kept are ignored; without any other,
        the requests are applied now.

        :param gestures: their numbers, at least one; the requests get the first number
        :param requests: that replace theirs, at their first step
        :param author: name of the person whose doing it is; '' is nobody's
        """
        now, history = self.moment, self.history
        starts = [history.gesture_start(each, now[1]) for each in gestures]
        found = [start for start in starts if start is not None]
        step, serial = min(found, key=lambda start: start[1], default=now)
        gesture = gestures[0]
        # Commands of robots join the gesture before them, whose author is another one.
        later = [
            each
            for each in history.nodes_between(serial, now[1])
            if each.gesture not in gestures or each.author != history.node(each.opening).author
        ]
        self.follow(history.node(serial), step, (step, serial))
        done = [self._try_apply(request, gesture, author) for request in requests]
        refused = False
        for node in later:
            self.advance(node.step - self.world.step_count)
            again = self._try_apply(node.request, node.gesture, node.author)
            refused |= isinstance(again, Refusal)
        self.advance(now[0] - self.world.step_count)
        self.world.clear_contacts()
        return Amended(step, done, refused)

    def _try_apply(self, request: Request, gesture: int, author: str) -> Done | Refusal:
        try:
            return self.apply(request, gesture, author)
        except Refusal as refusal:
            return refusal

    def _make_checkpoint(self) -> None:
        """Make a checkpoint if one is due, or if a request followed the last one at its step."""
        self._enter_checkpoint()
        step = self.world.step_count
        # Another line has run from this node before: its checkpoints are used.
        if step < self.history.tip.end:
            return
        due = self.history.is_checkpoint_due(step) or (
            self._resumed is not None and self._resumed[0] == step
        )
        if due and self.history.keyframe_at(*self.moment) is None:
            self.add_keyframe()

    def add_keyframe(self) -> Checkpoint:
        """Make a checkpoint now, the last of the history, continue from it, and return it."""
        checkpoint, digest = self.world.renew(), self.world.digest()
        self._resumed = self.history.add_keyframe(self.moment, checkpoint, digest).moment
        return checkpoint

    def build_ahead(self, steps: int) -> None:
        """Build the share of the bodies for the next checkpoint that is due in some steps."""
        bodies, spacing = len(self.world), self.history.spacing
        self.world.build_bodies(-(-bodies * steps // max(1, int(spacing * _AHEAD))))
