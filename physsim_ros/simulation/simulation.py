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
The simulation, the front of the core: requests and steady time go in, frames come out.

Laws: requests are applied in the order of their arrival and only between frames; every one is
answered; they are applied in a paused world too, and in the past, where another course begins.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
import itertools

from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import BadProperty, Refusal
from physsim_ros.model.requests import (
    Grab,
    HandRequest,
    KeepHand,
    LetGo,
    MoveHand,
    Request,
    Restore,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Answer, Frame, NO_CONTACTS, Snapshot
from physsim_ros.model.timeline import TimelineStatus
from physsim_ros.simulation.clock import Clock
from physsim_ros.simulation.frame_cache import CachedFrame, FrameCache
from physsim_ros.simulation.ghosts import Ghosts
from physsim_ros.simulation.hands import Hands, placing
from physsim_ros.simulation.history_memory import DEFAULT_MEMORY, HistoryMemory
from physsim_ros.simulation.records import Moment
from physsim_ros.simulation.replay import Timeline
from physsim_ros.simulation.request_queue import RequestQueue, Seek
from physsim_ros.simulation.timeline_status import status_of
from physsim_ros.simulation.undo import Undo
from physsim_ros.simulation.world import World

# Frames in one call: the one that is due, and one to make up for a late one.
_FRAMES_A_CALL = 2
# Simulation time from one checkpoint to the next [s]: at most so much is replayed to reach a step.
CHECKPOINTS = 3.0


class Simulation:
    """
    A world and its time.

    :param physics_rate: steps a second of simulation time [Hz], a multiple of publish_rate
    :param publish_rate: frames a second of simulation time at speed 1 [Hz]
    :param settings: of the empty world at the start
    :param speed: simulation seconds a second; 0 is paused, negative goes back
    :param history: how far back it can go [s of simulation time]
    :param history_memory: memory that the past may take [MB]; when it is spent, the oldest goes
    :param checkpoints: from one checkpoint to the next [s]
    :raises BadProperty: publish_rate does not divide physics_rate, or the memory is out of range
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
    ) -> None:
        steps = physics_rate / publish_rate
        if steps < 1 or abs(steps - round(steps)) > 1e-9:
            raise BadProperty(
                f'publish_rate {publish_rate:g} Hz does not divide physics_rate '
                f'{physics_rate:g} Hz',
                field='publish_rate',
            )
        self.frame_steps = round(steps)
        self.physics_rate = physics_rate
        self._clock = Clock(physics_rate=physics_rate, frame_steps=self.frame_steps, speed=speed)
        self._requests = RequestQueue()
        self._hands = Hands()
        self._answers: list[Answer] = []
        self._changed = True
        self._watching = False
        self._history = history
        self._checkpoints = checkpoints
        self._memory = HistoryMemory(history_memory)
        empty = WorldState(settings=settings or WorldSettings())
        self._course_numbers = itertools.count(1)
        self._ghosts = Ghosts()
        self._undo = Undo(self._timeline_of, empty)
        self.frame_cache = self._new_frame_cache()
        # The frame of a rewind that is shown, while the world is at another step; else None.
        self._shown: CachedFrame | None = None

    # Reading

    @property
    def timeline(self) -> Timeline:
        """Return the world on its course, and its history."""
        return self._undo.timeline

    @property
    def world(self) -> World:
        """Return the world as it is at the moment that is shown."""
        self._seek_shown()
        return self.timeline.world

    @property
    def step(self) -> int:
        """Return the step that is shown."""
        if self._shown is not None:
            return self._shown.snapshot.step
        return self.timeline.moment[0]

    @property
    def settings(self) -> WorldSettings:
        """Return what holds for the whole world at the moment that is shown."""
        if self._shown is not None:
            return self._shown.snapshot.scene.settings
        return self.timeline.settings

    @property
    def speed(self) -> float:
        """Return simulation seconds a second; 0 is paused, negative goes back."""
        return self._clock.speed

    @speed.setter
    def speed(self, speed: float) -> None:
        self._changed |= speed != self._clock.speed
        if speed < 0.0:
            self._hands.clear()
        self._clock.speed = speed

    @property
    def status(self) -> TimelineStatus:
        """Return where the world is in its time, and what can be undone and returned to."""
        return status_of(
            self._undo, self._shown_moment, speed=self.speed, dt=1.0 / self.physics_rate
        )

    @property
    def _shown_moment(self) -> Moment:
        """Return step and serial that are shown."""
        if self._shown is None:
            return self.timeline.moment
        return self.step, self.timeline.history.serial_shown_at(self.step)

    def ghost(self, course: int, seconds: float) -> Snapshot | None:
        """
        Return what a course that was left has shown at a simulation time.

        :param course: number of the course
        :param seconds: simulation time [s]
        :return: the last snapshot until then; None where none is kept
        """
        return self._ghosts.snapshot_at(course, self._steps(seconds))

    @property
    def history(self) -> float:
        """Return how far back it can go [s of simulation time]."""
        return self._history

    @history.setter
    def history(self, history: float) -> None:
        self._seek_shown()
        self._history = history
        if not self._limit_timeline():
            self._note_jump()
            self._report_oldest()

    @property
    def history_memory(self) -> HistoryMemory:
        """Return the budget of all that remembers the past, and what is taken of it."""
        return self._memory

    def limit_memory(self, megabytes: float) -> None:
        """
        Set the memory that the past may take [MB]; what is too much goes with the next frame.

        :raises Refusal: it is out of range
        """
        self._memory.megabytes = megabytes
        self.frame_cache.budget = self._memory.frame_limit
        self._limit_timeline()
        self._changed = True

    def _limit_timeline(self) -> bool:
        """Limit the timeline in force, and return whether the world is where it was."""
        return self.timeline.keep_within(self._steps(self._history), self._memory.log_limit)

    @property
    def waiting_requests(self) -> int:
        """Count of requests, refusals and answers that wait for the next frame."""
        return len(self._requests)

    @property
    def late_frames(self) -> int:
        """Count of frames that the machine could not make in time."""
        return self._clock.late_frames

    def watch_contacts(self, watching: bool) -> None:  # noqa: FBT001 - a state, not a mode
        """Record contacts for the frames, or save the cost of it."""
        self._watching = watching
        self.timeline.watch_contacts(watching)

    # Requests

    def submit(
        self,
        request: Request,
        *,
        topic: str,
        joined: bool = False,
        field: str = '',
        asker: str = '',
    ) -> None:
        """
        Queue a request; nothing moves until the next frame, which carries the answer.

        :param topic: where it comes from
        :param joined: whether it belongs to the one before, and is undone together with it
        :param field: the one field that it was made of, to be named by a refusal; '' is none
        :param asker: key of the message that asks, which the answer names; '' for none
        """
        self._requests.add_request(request, topic=topic, joined=joined, field=field, asker=asker)

    def tell(self, answer: Answer) -> None:
        """Queue an answer without a request, so that answers keep their order."""
        self._requests.add_answer(answer)

    def refuse(
        self,
        refusal: Refusal,
        *,
        topic: str,
        subject: str,
        joined: bool = False,
        field: str = '',
        asker: str = '',
    ) -> None:
        """Queue the refusal of a message that is no request, so that answers keep their order."""
        self._requests.add_refusal(
            refusal, topic=topic, subject=subject, joined=joined, field=field, asker=asker
        )

    def perform(self, request: Request) -> str:
        """
        Apply a request now, after those that wait, and return what was done as a sentence.

        :raises Refusal: and nothing is changed
        """
        self._apply_waiting()
        message = self._apply(request, self._requests.begin_gesture())[1]
        self._changed = True
        return message

    def begin(self, state: WorldState) -> None:
        """Begin with a state, at time 0, without a past; `reset` will return to it."""
        self._undo.begin(state)
        self._hands.clear()
        self.frame_cache = self._new_frame_cache()
        self._note_jump()

    def load(self, state: WorldState) -> str:
        """Replace the world by a state, to which `reset` will return; time goes on."""
        return self.perform(Restore(state=state))

    def save(self) -> WorldState:
        """
        Return the world as it is, to the bit; how it goes on is not changed.

        All worlds that begin with that state go on alike. This world goes on as they do up to the
        next impact; there the order in which the engine found contacts counts, which a state
        cannot have.
        """
        self._apply_waiting()
        self._seek_shown()
        return self.timeline.world.save()

    def reset(self) -> str:
        """Return to the state that was loaded last, at time 0; `undo` comes back from there."""
        self._apply_waiting()
        self._seek_shown()
        self._hands.clear()
        if not self._undo.reset():
            self._note_jump()
            return 'at the beginning, time 0'
        self.frame_cache = self._new_frame_cache()
        self._note_jump()
        return 'back at the beginning, time 0'

    @property
    def gesture(self) -> int:
        """Return the number of the last gesture that was submitted, for `amend`."""
        return self._requests.gesture

    def amend(
        self,
        gestures: Sequence[int],
        requests: Sequence[Request],
        *,
        topic: str,
        field: str = '',
        asker: str = '',
    ) -> None:
        """
        Replace the requests of earlier gestures, as if these had been made then, in one gesture.

        The world is simulated again from there up to this moment. Each request is answered.

        :param gestures: numbers of these, as `gesture` was after each was submitted
        :param topic: where the requests come from
        :param field: of the message that they were made of, to be named by a refusal
        :param asker: whom the answers are for
        """
        self._apply_waiting()
        self._seek_shown()
        step, done = self.timeline.amend(gestures, requests)
        self._undo.clear_undone()
        self.frame_cache.drop_from(step)
        self._note_jump()
        for each in done:
            if isinstance(each, Refusal):
                answer = Answer.refused(each, topic=topic, field=field, asker=asker)
            else:
                answer = Answer(topic=topic, subject=each[0], message=each[1], asker=asker)
            self._answers.append(answer)

    def undo(self) -> str:
        """
        Go back to the moment before the last request that changed the world, and say so.

        :raises OutOfHistory: there is none in the history
        """
        self._apply_waiting()
        self._seek_shown()
        undone, step = self._undo.undo()
        self._drop_frames(step)
        self._note_jump()
        return f'undid {undone}, back at {self._time()}'

    def redo(self) -> str:
        """
        Return to where the last undo was asked for, and say so.

        :raises OutOfHistory: nothing was undone, or something else was done since
        """
        self._apply_waiting()
        self._seek_shown()
        self._drop_frames(self._undo.redo())
        self._note_jump()
        return f'redid what was undone, at {self._time()}'

    def return_to_course(self, number: int) -> str:
        """
        Return to a course of events that was left, at the time that is shown or its last.

        :param number: of the course
        :raises OutOfHistory: it is kept no more; nothing is changed
        """
        self._apply_waiting()
        self._seek_shown()
        self.timeline.note_shown()
        left = self.timeline.courses.current
        step = self.timeline.return_to_course(number)
        if number != left:
            self._keep_ghost(left, step)
            for frame in self._ghosts.take_course(number):
                self.frame_cache.add_frame(frame)
            self._undo.clear_undone()
            self._hands.clear()
        self._note_jump()
        return f'on course {number}, at {self._time()}'

    def seek(self, stamp: int) -> str:
        """
        Go to a simulation time [ns], and say so.

        :raises OutOfHistory: it is kept no more, or has not come yet
        """
        self._apply_waiting()
        return self._go_to(stamp)

    def submit_seek(self, stamp: int, *, topic: str) -> None:
        """
        Queue a seek to a simulation time [ns]; of those in a row the last is carried out.

        :param topic: where it comes from
        """
        self._requests.add_seek(Seek(stamp), topic=topic)

    def _go_to(self, stamp: int) -> str:
        self._seek_shown()
        # What has just been carried out belongs to this step.
        self.timeline.note_shown()
        self.timeline.seek(round(stamp * 1e-9 * self.physics_rate))
        self._hands.clear()
        self._note_jump()
        return f'at {self._time()}'

    # Time

    def continue_seek(self, is_overdue: Callable[[], bool] = lambda: False) -> bool:
        """
        Replay towards the moment that was sought, without a limit where the world is asked for.

        Requests wait until it is reached; another seek or an undo takes its place.

        :param is_overdue: whether to go on another time
        :return: whether the world is there
        """
        if self.timeline.continue_seek(is_overdue):
            return True
        self._clock.restart()
        return False

    def advance(
        self, now_ns: int, *, is_overdue: Callable[[], bool] = lambda: False
    ) -> tuple[Frame, ...]:
        """
        Apply the requests that wait, and advance, or rewind, by the steps that are due.

        :param now_ns: steady time, never going back [ns]
        :param is_overdue: whether the call has taken too long; a frame that advances then ends at
            the next publish period, however many are due, so that requests do not wait for it
        :return: the frames, in the order in which they are shown; none where nothing is due and
            nothing has changed
        """
        if self._shown is not None and (self.speed > 0 or self._requests):
            self._seek_shown()
        if not self.continue_seek(is_overdue):
            return ()
        self._apply_waiting()
        self._hands.note_time(now_ns, paused=self.speed == 0)
        if self.speed > 0:
            self._release_grips()
        frames = []
        for _ in range(_FRAMES_A_CALL):
            steps = self._clock.due(now_ns, self.step)
            if steps == 0:
                break
            if steps > 0:
                frames.append(self._play_frame(steps, is_overdue))
            else:
                frame = self._rewind_frame(-steps, is_overdue)
                if frame is None:
                    # What is shown stands still meanwhile, and makes up for nothing.
                    self._clock.restart()
                    break
                frames.append(frame)
            if self.speed == 0 or is_overdue():
                break
        if not frames and self._changed:
            frames.append(self._frame(moved=False))
        return tuple(frames)

    def settle(self) -> Frame | None:
        """Apply the requests that wait, without a step; return a frame if there were any."""
        self._apply_waiting()
        return self._frame(moved=False) if self._changed else None

    def take_answers(self) -> tuple[Answer, ...]:
        """Return the answers that wait, where no frame shows anything new."""
        answers, self._answers = tuple(self._answers), []
        return answers

    def advance_frame(self) -> Frame:
        """Apply the requests that wait, and advance by one publish period, at any speed."""
        self._apply_waiting()
        self._release_grips()
        self._clock.restart()
        return self._play_frame(self._steps_to_period)

    @property
    def _steps_to_period(self) -> int:
        """Return the number of steps to the next multiple of the publish period."""
        return self.frame_steps - self.step % self.frame_steps

    def _play_frame(self, steps: int, is_overdue: Callable[[], bool] = lambda: False) -> Frame:
        self._seek_shown()
        while steps > 0:
            some = min(steps, self._steps_to_period)
            self.timeline.advance(some)
            self.timeline.build_ahead(some)
            steps = 0 if is_overdue() else steps - some
        return self._frame(moved=True)

    def _rewind_frame(self, steps: int, is_overdue: Callable[[], bool]) -> Frame | None:
        """Return a frame further back; None where it has to be replayed for longer."""
        oldest = self.timeline.history.oldest
        step = max(oldest, self.step - steps)
        moved = step < self.step
        if moved:
            shown = self.frame_cache.frame_at(step, watching=self._watching, is_overdue=is_overdue)
            if shown is None:
                return None
            self._shown = shown
            fine = not self.speed.is_integer()
            self.frame_cache.replay_ahead(
                step, steps, fine=fine, watching=self._watching, is_overdue=is_overdue
            )
        if step == oldest:
            self.speed = 0.0
            self._report_oldest('; paused')
        return self._frame(moved=moved)

    def _seek_shown(self) -> None:
        """Have the world go to the moment that is shown."""
        if self._shown is not None:
            step, self._shown = self._shown.snapshot.step, None
            self.timeline.seek(step, with_contacts=False)

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

    def _note_jump(self) -> None:
        """Note that another moment is shown than before."""
        self._shown = None
        self.timeline.watch_contacts(self._watching)
        self._clock.restart()
        self._changed = True

    # Inside

    def _apply_waiting(self) -> None:
        for waiting in self._requests.take_all():
            request, topic, subject = waiting.request, waiting.topic, waiting.subject
            field, asker = waiting.field, waiting.asker
            if isinstance(request, Answer):
                self._answers.append(request)
                continue
            # A seek that is refused shows nothing new.
            self._changed |= not isinstance(request, Seek)
            try:
                if isinstance(request, Refusal):
                    raise request
                if isinstance(request, Seek):
                    message = self._go_to(request.stamp)
                else:
                    subject, message = self._apply(request, waiting.gesture)
            except Refusal as refusal:
                answer = Answer.refused(
                    refusal, topic=topic, subject=subject, field=field, asker=asker
                )
            else:
                if isinstance(request, MoveHand | KeepHand):
                    continue
                answer = Answer(topic=topic, subject=subject, message=message, asker=asker)
            self._answers.append(answer)

    def _apply(self, request: Request, gesture: int) -> tuple[str, str]:
        made = self.timeline.moment
        if isinstance(request, HandRequest):
            done = self._drag(request, gesture)
        else:
            done = self._apply_to_world(request, gesture)
        if self.timeline.moment != made:
            # A branch has no hands of the course that it leaves.
            self._release_grips()
        return done

    def _drag(self, request: HandRequest, gesture: int) -> tuple[str, str]:
        if request.hand not in self._hands and not isinstance(request, Grab):
            # A grip of the past that is shown belongs to no hand of now.
            return '', f'{request.hand} holds no body'
        if self.speed == 0.0:
            request = placing(request)
        gesture = self._hands.gesture_of(request, gesture)
        done = self._apply_to_world(request, gesture)
        self._hands.note_request(request, gesture)
        return done

    def _release_grips(self) -> None:
        """Remove the grips of hands that are gone, unless the history knows how they end."""
        timeline = self.timeline
        if self._shown is not None or not timeline.world.grips or not timeline.is_newest:
            return
        for grip in timeline.world.grips:
            if grip.hand not in self._hands:
                # Undone together with what came last.
                gesture = timeline.history.gesture_before(timeline.serial, self.gesture)
                self._apply_to_world(LetGo(hand=grip.hand), gesture)
                message = f'{grip.hand} is silent and has let go of {grip.body}'
                self._answers.append(
                    Answer(topic='~/drag/feedback', subject=grip.body, message=message)
                )

    def _apply_to_world(self, request: Request, gesture: int) -> tuple[str, str]:
        self._seek_shown()
        courses = self.timeline.courses
        before = courses.current
        done = self.timeline.apply(request, gesture)
        if self.timeline.world.changed:
            self._undo.clear_undone()
        if courses.current != before:
            self._keep_ghost(before, self.step)
        return done

    def _keep_ghost(self, left: int, step: int) -> None:
        """Keep the frames of a course that was left, from the step on where it ends."""
        self._ghosts.add_course(left, self.frame_cache.drop_from(step))
        kept = self.timeline.courses.reachable(self.timeline.history)
        self._ghosts.retain({course.number for course in kept})

    def _frame(self, *, moved: bool) -> Frame:
        snapshot, contacts = self._shown or self._observe_world(moved=moved)
        if self._shown is not None and not moved:
            # They have been shown.
            contacts = NO_CONTACTS
        self._fit_memory()
        self._answers += self.timeline.take_answers() + self.frame_cache.take_answers()
        frame = Frame(
            snapshot=snapshot,
            contacts=contacts if self._watching else None,
            answers=tuple(self._answers),
            speed=self.speed,
            moved=moved,
            past=snapshot.step < self.timeline.history.head,
        )
        self._answers.clear()
        self._changed = False
        return frame

    def _fit_memory(self) -> None:
        """Drop the oldest of what remembers the past until it fits, and tell it once."""
        history = self.timeline.history
        history.shown = min(self._shown_moment, self.timeline.moment)
        if self._memory.fit(self.frame_cache, (self._ghosts, *self._undo.stores)):
            self._answers.append(self._memory.report(history.oldest / self.physics_rate))

    def _observe_world(self, *, moved: bool) -> CachedFrame:
        """Return the state of the world, and cache it for rewinds."""
        world = self.timeline.world
        snapshot = world.snapshot()
        contacts = world.contacts(snapshot) if world.watching else None
        frame = CachedFrame(snapshot, contacts)
        # What touched in this step has been taken by the frame that came with it.
        self.frame_cache.add_frame(frame if moved else self.frame_cache.with_first_contacts(frame))
        self.timeline.note_shown()
        return frame

    def _timeline_of(self, state: WorldState) -> Timeline:
        """Return a timeline that begins with a state."""
        world = World(
            physics_rate=self.physics_rate, frame_steps=self.frame_steps, settings=state.settings
        )
        world.apply(Restore(state=state))
        world.watching = self._watching
        return Timeline(
            world,
            length=self._steps(self._history),
            spacing=self._steps(self._checkpoints),
            log_limit=self._memory.log_limit,
            courses=self._course_numbers,
        )

    def _new_frame_cache(self) -> FrameCache:
        """Return an empty frame cache of the timeline."""
        return FrameCache(
            self.timeline.history,
            physics_rate=self.physics_rate,
            frame_steps=self.frame_steps,
            budget=self._memory.frame_limit,
        )

    def _report_oldest(self, more: str = '') -> None:
        message = f'{self._time()} is the oldest that is kept{more}'
        self._answers.append(Answer(topic='history', message=message))

    def _steps(self, seconds: float) -> int:
        return round(seconds * self.physics_rate)

    def _time(self) -> str:
        return f'{self.step / self.physics_rate:.3f} s'
