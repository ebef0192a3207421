# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The simulation, the front of the core: requests and steady time go in, frames come out.

Laws: requests are applied in the order of their arrival and only between frames, in a paused world
too; a request in the past begins another course. Every request is answered, with the first frame
after it; a frame without a step shows what requests have changed.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
import math
from numbers import Integral

from physsim_ros.model.checkpoint import Checkpoint, WorldState
from physsim_ros.model.checks import shown, Within
from physsim_ros.model.error_boundary import ErrorBoundary
from physsim_ros.model.errors import BadProperty, InPast
from physsim_ros.model.requests import DriveRobot, Request, Restore
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Answer, Contacts, Frame, Snapshot
from physsim_ros.model.timeline import TimelineStatus
from physsim_ros.sensing import View
from physsim_ros.simulation.past import DEFAULT_MEMORY, Past
from physsim_ros.simulation.playback import Playback
from physsim_ros.simulation.request_queue import RequestQueue
from physsim_ros.simulation.world import forces_now, World
from physsim_ros.simulation.world.body_requests import is_driving

# Simulation time from one checkpoint to the next [s]: the most that is replayed to reach a step.
CHECKPOINTS = 3.0
# Check of the rates: the range that the node's parameters have.
_RATE = Within(1.0, 1e4, 'Hz')
# Frames in one call: the one that is due, and one to make up for a late one.
_FRAMES_A_CALL = 2


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SavedMoment:
    """
    A moment of a simulation, from which it and others continue with the same bits; it pickles.

    :param checkpoint: of the world
    :param loaded: the state that was loaded last, to which `reset` returns
    :param frame: that is shown
    :param before: the last snapshot of another time, which was shown before it; None is none
    :param held: what robots drive on with
    """

    checkpoint: Checkpoint
    loaded: WorldState
    frame: Frame
    before: Snapshot | None
    held: tuple[DriveRobot, ...]


class Simulation:
    """
    A world and its time.

    :param physics_rate: steps a second of simulation time [Hz], a multiple of publish_rate
    :param publish_rate: frames a second of simulation time at speed 1 [Hz]
    :param settings: of the empty world at the start
    :param speed: simulation seconds a second; 0 is paused, negative goes back
    :param history: length of the past that is kept [s of simulation time]; 0 caches no frame
    :param history_memory: budget of the past [MB]; when it is spent, the oldest is dropped
    :param checkpoints: from one checkpoint to the next [s]
    :param boundary: of the requests; None lets unexpected errors pass
    :raises BadProperty: a rate or the memory is out of range, or publish_rate does not divide
        physics_rate

    :ivar requests: queue of the requests that wait for the next frame, and what applies them
    :ivar past: the lines of events, cached frames, and their budget of memory
    :ivar playback: the moment that is shown
    :ivar held: the commands with which robots drive on, by the names of their bodies
    """

    def __init__(
        self,
        *,
        physics_rate: float = 240.0,
        publish_rate: float = 60.0,
        settings: WorldSettings | None = None,
        speed: float = 1.0,
        history: float = 600.0,
        history_memory: float = DEFAULT_MEMORY,
        checkpoints: float = CHECKPOINTS,
        boundary: ErrorBoundary | None = None,
    ) -> None:
        physics_rate = _RATE(physics_rate, 'physics_rate')
        publish_rate = _RATE(publish_rate, 'publish_rate')
        steps = physics_rate / publish_rate
        if steps < 1 or abs(steps - round(steps)) > 1e-9:
            raise BadProperty(
                f'publish_rate {publish_rate:g} Hz does not divide physics_rate '
                f'{physics_rate:g} Hz',
                field='publish_rate',
            )
        self.frame_steps = round(steps)
        self.physics_rate = physics_rate
        self.past = Past(
            physics_rate=physics_rate,
            frame_steps=self.frame_steps,
            settings=settings or WorldSettings(),
            length=history,
            checkpoints=checkpoints,
            memory=history_memory,
            boundary=boundary or ErrorBoundary(),
        )
        self.playback = Playback(self.past, speed=speed)
        self.requests = RequestQueue(self.past, self.playback)
        self._view: View | None = None
        self.held: dict[str, DriveRobot] = {}

    # Reading

    @property
    def world(self) -> World:
        """Return the world at the moment that is shown."""
        return self.playback.world

    @property
    def step(self) -> int:
        """Return the step that is shown."""
        return self.playback.step

    @property
    def settings(self) -> WorldSettings:
        """Return the settings of the world at the moment that is shown."""
        return self.playback.settings

    @property
    def speed(self) -> float:
        """Return simulation seconds a second; 0 is paused, negative goes back."""
        return self.playback.speed

    @speed.setter
    def speed(self, speed: float) -> None:
        if speed < 0.0:
            self.requests.hands.clear()
            self.let_go()
        self.playback.speed = speed

    @property
    def status(self) -> TimelineStatus:
        """Return the status of the timeline at the moment that is shown."""
        return self.past.status(self.playback.moment, speed=self.speed)

    @property
    def loaded(self) -> WorldState:
        """Return the state that was loaded last, to which `reset` returns."""
        return self.past.tree.tip.loaded.state

    def limit_history(self, seconds: float) -> None:
        """Set the length of the past that is kept [s of simulation time]."""
        self.playback.seek_shown()
        # The times of a paused world are told anew.
        self.playback.changed = True
        if not self.past.cursor.keep_within(self.past.steps_in(seconds)):
            self.playback.note_jump()
            self.requests.report_oldest()

    def limit_memory(self, megabytes: float) -> None:
        """
        Set the budget of the past [MB]; the excess is dropped with the next frame.

        :raises Refusal: it is out of range
        """
        self.past.budget.megabytes = megabytes
        self.playback.changed = True

    @property
    def reports_contacts(self) -> bool:
        """Return whether frames have contacts, which costs a tenth of a step."""
        return self.past.reports_contacts

    @reports_contacts.setter
    def reports_contacts(self, reports_contacts: bool) -> None:
        if reports_contacts != self.past.reports_contacts:
            self.past.reports_contacts = reports_contacts
            self.playback.note_reporting(reports_contacts)

    @property
    def view(self) -> View:
        """
        Return the frame of now as sensors see it.

        A frame is made when it is first read after steps or requests, so that steps whose frame
        nobody reads make none.
        """
        if self._view is None or self.playback.changed:
            shown = self._view and self._view.snapshot.step
            self._observe_frame(moved=shown != self.step)
        assert self._view is not None  # noqa: S101 - `_observe_frame` makes it
        return self._view

    @property
    def frame(self) -> Frame:
        """Return the frame of now, which is made when it is first read."""
        return self.view.frame

    # Requests

    def perform(self, request: Request, gesture: int | None = None) -> str:
        """
        Apply a request now, after those that wait, and return a message about it.

        :param gesture: its gesture; None is a new one
        :raises Refusal: and nothing is changed
        """
        self.requests.apply_waiting()
        gesture = self.requests.begin_gesture() if gesture is None else gesture
        message = self.requests.apply(request, gesture).message
        self.playback.changed = True
        return message

    def begin(self, state: WorldState) -> None:
        """Begin with a state, at time 0 and without a past; `reset` returns to it."""
        self.past.begin(state)
        self._note_beginning()

    def _note_beginning(self) -> None:
        """Note that the world is another one, which nobody holds or drives."""
        self.requests.hands.clear()
        self.let_go()
        self.playback.note_jump()

    def load(self, state: WorldState) -> str:
        """Replace the world by a state, to which `reset` returns; time goes on."""
        self.let_go()
        return self.perform(Restore(state=state))

    def save(self) -> WorldState:
        """
        Return the state of the world, to the bit; nothing is changed.

        All worlds that begin with the state have the same bits ever after. This world has them up
        to its next impact: the engine solves contacts in the order in which it found them, which
        is not in a state.
        """
        self.requests.apply_waiting()
        return self.world.save()

    def forces_now(self, snapshot: Snapshot) -> tuple[Contacts, Snapshot] | None:
        """
        Return the forces of contacts and joints of a world that has not stepped since a change.

        :param snapshot: of the world that is shown
        :return: contacts as of one step, and a snapshot with the joint forces; None where the
            world is at another moment, or too large
        """
        world = self.world
        if world.step_count != snapshot.step or world.scene is not snapshot.scene:
            return None
        return forces_now(world.save(), world.physics_rate)

    def checkpoint(self) -> SavedMoment:
        """
        Return this moment, to the bit, for `restore`.

        Requests that wait are applied before, and hands let go.

        This world continues from it as all do that restore it: it, too, moves into a space that
        is built from the checkpoint. Without the call its later bits may be others.

        :raises InPast: the past is shown
        """
        self.requests.apply_waiting()
        if self.frame.past:
            raise InPast('the past is shown; go to its end first', field='history')
        self.requests.hands.clear()
        self.requests.release_grips()
        frame = self.frame
        checkpoint = self.past.cursor.add_keyframe()
        return SavedMoment(
            checkpoint=checkpoint,
            loaded=self.loaded,
            frame=frame,
            before=self.view.before,
            held=tuple(self.held.values()),
        )

    def restore(self, saved: SavedMoment) -> None:
        """Continue from a moment, at its time and without a past."""
        self.past.restore(saved.checkpoint, saved.loaded)
        self._note_beginning()
        self.held = {drive.name: drive for drive in saved.held}
        self._view = View(saved.frame, saved.before)
        self.playback.changed = False

    def reset(self, seed: int | None = None) -> str:
        """
        Go to the state that was loaded last, at time 0; `undo` reverts it. Return a message.

        :param seed: of all noise from then on; None is that of the state
        :raises BadProperty: the seed is out of range
        """
        with self._jump():
            self.requests.hands.clear()
            self.let_go()
            done = self.past.reset(seed)
        return 'back at the beginning, time 0' if done else 'at the beginning, time 0'

    def undo(self) -> str:
        """
        Go back to before the last gesture that changed the world; return a message about it.

        :raises OutOfHistory: there is none in the history
        """
        with self._jump():
            undone = self.past.undo()
        return f'undid {undone}, back at {self.playback.time}'

    def take_back(self, author: str) -> str:
        """
        Take back the last gesture of a person, at this time; return a message about it.

        :param author: name of the person
        :raises Refusal: there is none, or it does not stand alone; nothing is changed
        """
        with self._jump():
            return f'undid {_result(self.past.take_back(author))}'

    def redo(self) -> str:
        """
        Return to the moment of the last undo; return a message about it.

        :raises OutOfHistory: nothing was undone, or a request was applied since
        """
        with self._jump():
            self.past.redo()
        return f'redid what was undone, at {self.playback.time}'

    def return_to_course(self, number: int) -> str:
        """
        Return to a course, at the time that is shown or its last one; return a message.

        :param number: of the course
        :raises OutOfHistory: the course is no longer kept; nothing is changed
        """
        with self._jump():
            if self.past.return_to_course(number):
                self.requests.hands.clear()
        return f'on course {number}, at {self.playback.time}'

    def seek(self, stamp: int) -> str:
        """
        Go to a simulation time [ns], and return a message about it.

        :raises OutOfHistory: the time is no longer kept, or in the future
        :raises BadProperty: it is no whole number, as of seconds
        """
        if not isinstance(stamp, Integral):
            raise BadProperty(f'a time is a whole number of ns, not {shown(stamp)}', field='clock')
        self.requests.apply_waiting()
        self.let_go()
        return self.requests.seek(stamp)

    def let_go(self) -> None:
        """End what `Robot.drive` has robots do; their last commands end with their timeouts."""
        self.held.clear()

    # Time

    def apply_waiting(self) -> None:
        """Apply the requests that wait, at whose seeks the world goes at once."""
        self.requests.apply_waiting()

    def apply_up_to_seek(self, is_spent: Callable[[], bool] = lambda: False) -> bool:
        """
        Apply the requests up to a seek.

        :param is_spent: whether there is no time for a further one
        :return: whether no seek is under way, and no request waits
        """
        self.requests.apply_up_to_seek(is_spent)
        return self.playback.is_there and not self.requests.has_requests

    def finish_seek(self, is_overdue: Callable[[], bool]) -> bool:
        """
        Replay up to the goal of a seek whose frame is not cached, or to the end of an amendment.

        Until then no step is due.

        :param is_overdue: whether the work is to continue in another call
        :return: whether it is done
        """
        while self.playback.continue_work():
            if is_overdue():
                # The time of this replay is not made up for.
                self.playback.clock.restart()
                return False
        return True

    def apply_requests(self) -> Frame | None:
        """Apply the requests that wait, without a step; return a frame if anything changed."""
        self.requests.apply_waiting()
        return self._observe_frame(moved=False) if self.playback.changed else None

    def take_answers(self) -> tuple[Answer, ...]:
        """Return the answers that no frame has taken, and drop them."""
        return self.requests.take_answers()

    def advance_frame(self) -> Frame:
        """Apply the requests that wait, and advance by one publish period, at any speed."""
        self._advance_period()
        return self._observe_frame(moved=True)

    def run(self, seconds: float) -> None:
        """
        Advance by simulated seconds, to the nearest publish period, at any speed.

        No frame is made but the last one, when it is read; its contacts are those of all steps
        since the one that was read before.

        :raises BadProperty: they are below 0, or not finite
        """
        periods = seconds * self.physics_rate / self.frame_steps
        if not 0.0 <= periods < math.inf:
            raise BadProperty(f'seconds must be finite and >= 0, not {seconds:g}', field='seconds')
        for _ in range(round(periods)):
            self._advance_period()

    def _advance_period(self) -> None:
        """Apply the requests that wait, and advance by one publish period."""
        self._hold_drives()
        self.requests.apply_waiting()
        self.requests.release_grips()
        self.playback.clock.restart()
        self._play(self.playback.steps_to_period)

    def advance(
        self,
        now_ns: int,
        *,
        is_overdue: Callable[[], bool] = lambda: False,
        is_spent: Callable[[], bool] = lambda: False,
    ) -> tuple[Frame, ...]:
        """
        Apply the requests that wait, and advance, or rewind, by the steps that are due.

        Where the time for requests is spent within a gesture, as in an array of thousands of
        bodies, time stands until a later call has applied the rest of the gesture.

        :param now_ns: steady time, never going back [ns]
        :param is_overdue: whether the call has taken too long; a frame that advances then ends at
            the next publish period, however many steps are due, so that requests do not wait
        :param is_spent: whether there is no time for a further request in this call
        :return: the frames, in the order in which they are shown; empty where nothing is due and
            nothing has changed
        """
        playback = self.playback
        if playback.is_world_due or self.requests.has_requests:
            playback.seek_shown()
        if not self.finish_seek(is_overdue):
            return ()
        if playback.speed > 0.0:
            self._hold_drives()
        self.requests.apply_up_to_seek(is_spent)
        if not self.finish_seek(is_overdue):
            return ()
        if self.requests.is_in_gesture or (playback.frames_due and self.requests.has_requests):
            playback.clock.restart()
            return ()
        if playback.frames_due:
            playback.frames_due -= 1
            return (self.advance_frame(),)
        self.requests.hands.note_time(now_ns, paused=playback.speed == 0)
        if playback.speed > 0:
            self.requests.release_grips()
        frames = tuple(self._due_frames(now_ns, is_overdue))
        if not frames and playback.changed:
            return (self._observe_frame(moved=False),)
        return frames

    def _due_frames(self, now_ns: int, is_overdue: Callable[[], bool]) -> Iterator[Frame]:
        """Yield the frames that are due at a steady time [ns], and make them."""
        playback = self.playback
        for _ in range(_FRAMES_A_CALL):
            steps = playback.clock.due(now_ns, playback.step)
            if steps == 0:
                return
            if steps > 0:
                self._play(steps, is_overdue)
                yield self._observe_frame(moved=True)
            elif frame := self._rewind_frame(-steps, is_overdue):
                yield frame
            else:
                return
            if playback.speed == 0 or is_overdue():
                return

    def _play(self, steps: int, is_overdue: Callable[[], bool] = lambda: False) -> None:
        """Advance by steps, whose frame is not made yet."""
        for _ in self.playback.play(steps):
            if is_overdue():
                break
        self.playback.changed = True

    def _hold_drives(self) -> None:
        """Have robots drive on as `Robot.drive` told them, unless they do up to the next frame."""
        for drive in self.held.values():
            if not is_driving(self.world, drive, self.frame_steps):
                # In the gesture before, with which it is undone: nobody undoes a tick.
                self.requests.apply(drive, self.requests.gesture)

    def _rewind_frame(self, steps: int, is_overdue: Callable[[], bool]) -> Frame | None:
        """Return the frame some steps back; None while its replay goes on."""
        before = self.playback.step
        while not self.playback.rewind(steps):
            if is_overdue():
                # The time of this replay is not made up for.
                self.playback.clock.restart()
                return None
        for _ in self.playback.replay_ahead(steps):
            if is_overdue():
                break
        if self.playback.step <= self.past.tree.oldest:
            self.playback.speed = 0.0
            self.requests.report_oldest('; paused')
        return self._observe_frame(moved=self.playback.step < before)

    def _observe_frame(self, *, moved: bool) -> Frame:
        """Return the frame that is shown, with all answers; fit the past into its budget."""
        snapshot, contacts = self.playback.observe_frame(moved=moved)
        self.past.fit_memory(self.playback.moment)
        self.requests.answers += self.past.reports
        self.past.reports.clear()
        self.playback.changed = False
        frame = Frame(
            snapshot=snapshot,
            contacts=contacts if self.past.reports_contacts else None,
            answers=self.requests.take_answers(),
            speed=self.playback.speed,
            moved=moved,
            past=snapshot.step < self.past.tree.head,
            course=self.past.tree.course,
        )
        before, last = None, self._view
        if last is not None:
            before = last.snapshot if last.snapshot.step != snapshot.step else last.before
        self._view = View(frame, before)
        return frame

    @contextmanager
    def _jump(self) -> Iterator[None]:
        """Have the block move the cursor, from the moment that is shown after all requests."""
        self.requests.apply_waiting()
        self.playback.frames_due = 0
        self.playback.seek_shown()
        yield
        self.playback.note_jump()


def _result(parts: Generator[None, None, str]) -> str:
    """Carry out all parts of work, and return its result."""
    while True:
        try:
            next(parts)
        except StopIteration as end:
            return str(end.value)
