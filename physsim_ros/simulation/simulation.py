# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The simulation, the front of the core: a world, its frames, and what people do with its time.

Laws: a request in the past begins another course. What moves the world to another moment or
replaces it comes after the requests that wait; a refusal changes nothing.

The world is replaced by another one in five ways: `load` is a request, and time goes on; `reset`
and `open_world` begin a line of events at time 0, which undo leaves; `begin` and `restore` forget
the past, at time 0 or at a saved moment.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
import math
from numbers import Integral

import numpy as np
from physsim_ros.model.checkpoint import Checkpoint, WorldState
from physsim_ros.model.checks import number, OfClass, shown, Within
from physsim_ros.model.errors import BadProperty, InPast
from physsim_ros.model.requests import Command, DriveRobot, Request, Restore
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Contacts, Frame, Snapshot
from physsim_ros.model.timeline import stamp_of, TimelineStatus
from physsim_ros.model.translation import Text
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.sensing import SensedFrame
from physsim_ros.simulation.applier import Applier
from physsim_ros.simulation.frame_maker import FrameMaker
from physsim_ros.simulation.past import DEFAULT_MEMORY, Past
from physsim_ros.simulation.playback import Playback
from physsim_ros.simulation.request_queue import RequestQueue
from physsim_ros.simulation.ticks import NO_LIMITS, TickLimits, Ticks
from physsim_ros.simulation.world import Beginning, forces_now, load_message, World

# Simulation time from one checkpoint to the next [s]: the most that is replayed to reach a step.
CHECKPOINTS = 3.0
# Check of the rates; a node asks for 60 Hz and more.
_RATE = Within(1.0, 1e4, 'Hz')


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class SavedMoment:
    """
    A moment of a simulation, from which it and others continue with the same bits.

    A saved moment can be pickled.

    :param checkpoint: checkpoint of the world
    :param loaded: state that was loaded last, to which `reset` returns
    :param frame: frame that is shown
    :param before: snapshot of another time that was shown before it; None if there is none
    :param driving: commands that robots obey
    :param physics_rate: steps of the world per second of simulation time [Hz]
    """

    checkpoint: Checkpoint
    loaded: WorldState
    frame: Frame
    before: Snapshot | None
    driving: tuple[DriveRobot, ...]
    physics_rate: float


class Simulation:
    """
    A world and its time.

    Requests change the world, and `advance_frame` or `run` advances it. A disc falls for a second:

    >>> from physsim_ros import Disc, Simulation, Spawn
    >>> simulation = Simulation()
    >>> simulation.perform(Spawn(name='ball/0', shape=Disc(radius=0.5), pose=(0.0, 9.0, 0.0)))
    'spawned ball/0'
    >>> simulation.run(1.0)
    >>> snapshot = simulation.frame.snapshot
    >>> round(float(snapshot.poses[snapshot.row('ball/0')][1]), 3)  # y [m]
    4.095

    :param physics_rate: steps per second of simulation time [Hz], a multiple of publish_rate
    :param publish_rate: frames per second of simulation time at speed 1 [Hz]
    :param settings: settings of the empty world at the start
    :param speed: simulation time per wall time; 0 is paused, negative goes back
    :param history: length of the past that is kept [s of simulation time]; 0 caches no frames
    :param history_memory: memory of the past [MB]; when it is full, the oldest data is dropped
    :param checkpoints: simulation time from one checkpoint to the next [s]
    :param boundary: catches unexpected errors of requests; None lets them pass
    :raises BadProperty: a number is out of range, or publish_rate does not divide physics_rate
    :raises Malformed: a number is not finite, or a value has another type

    :ivar physics_rate: steps a second of simulation time [Hz]
    :ivar frame_steps: number of steps in a frame at speed 1
    :ivar past: the lines of events, cached frames, and their budget of memory
    :ivar playback: the moment that is shown
    :ivar requests: queue of the requests that wait for the next frame
    :ivar applier: applies them
    :ivar frames: makes the frames of that moment
    :ivar ticks: advances its time
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
                'publish_rate {rate:g} Hz does not divide physics_rate {steps:g} Hz',
                field='publish_rate',
                rate=publish_rate,
                steps=physics_rate,
            )
        settings = WorldSettings() if settings is None else settings
        OfClass(WorldSettings)(settings, 'settings')
        past = Past(
            physics_rate=physics_rate,
            frame_steps=round(steps),
            settings=settings,
            length=history,
            checkpoints=checkpoints,
            memory=history_memory,
            boundary=boundary or ErrorBoundary(),
        )
        self.physics_rate = past.physics_rate
        self.frame_steps = past.frame_steps
        self.past = past
        self.playback = Playback(past, speed=speed)
        self.requests = RequestQueue()
        self.applier = Applier(self.requests, past, self.playback)
        self.frames = FrameMaker(past, self.playback, self.applier)
        self.ticks = Ticks(past, self.playback, self.applier, self.frames)

    # Reading

    @property
    def world(self) -> World:
        """Return the world at the moment that is shown; a replay that leads there is finished."""
        return self.playback.arrive()

    @property
    def step(self) -> int:
        """Return the step that is shown."""
        return self.playback.step

    @property
    def stamp(self) -> int:
        """Return the simulation time that is shown [ns]."""
        return stamp_of(self.step, self.physics_rate)

    @property
    def is_past(self) -> bool:
        """Whether something lies ahead of the moment that is shown, on its course."""
        return not self.playback.is_newest

    @property
    def speed(self) -> float:
        """Return simulation seconds a second; 0 is paused, negative goes back."""
        return self.playback.speed

    @speed.setter
    def speed(self, speed: float) -> None:
        self.playback.speed = speed
        if self.playback.speed < 0.0:
            self.applier.let_go()

    @property
    def sensed(self) -> SensedFrame:
        """
        Return the frame of now as sensors see it.

        A frame is made when it is first read after steps or requests, so that steps whose frame
        nobody reads make none.
        """
        return self.frames.make_if_changed()

    @property
    def frame(self) -> Frame:
        """Return the frame of now, which is made, with all answers, when it is first read."""
        return self.frames.make_if_changed().frame

    @property
    def settings(self) -> WorldSettings:
        """Return the settings of the world at the moment that is shown."""
        return self.playback.settings

    @property
    def status(self) -> TimelineStatus:
        """Return the status of the timeline at the moment that is shown."""
        return self.playback.status

    @property
    def loaded(self) -> WorldState:
        """Return the state that was loaded last, to which `reset` returns."""
        return self.past.line.tip.loaded.state

    def limit_history(self, seconds: float) -> None:
        """
        Set the length of the past that is kept [s of simulation time].

        :raises Refusal: it is out of range
        """
        length = self.past.steps_of('history', seconds)
        self._world_now()
        # The times of a paused world are told anew.
        self.playback.changed = True
        if not self.past.cursor.keep_within(length):
            self.playback.show_cursor()
            self.past.report_oldest(self.step)

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
            self.playback.report_contacts(reports_contacts)

    # Time

    def apply_requests(self) -> Frame | None:
        """Apply the requests that wait, without a step; return a frame if anything changed."""
        self.applier.apply_all()
        return self.frames.make() if self.frames.is_changed else None

    def advance_frame(self) -> Frame:
        """Apply the requests that wait, and advance by one publish period, at any speed."""
        self.ticks.run(1)
        return self.frames.make()

    def run(self, seconds: float) -> None:
        """
        Advance by simulated seconds, to the nearest publish period, at any speed.

        No frame is made but the last one, when it is read; its contacts are those of all steps
        since the one that was read before.

        :raises BadProperty: they are no number, below 0, or more than can be counted
        :raises Malformed: they are not finite
        """
        seconds = number(seconds, 'seconds')
        periods = seconds * self.physics_rate / self.frame_steps
        if not 0.0 <= periods < math.inf:
            template = 'seconds must be finite and >= 0, not {seconds:g}'
            raise BadProperty(template, field='seconds', seconds=seconds)
        self.ticks.run(round(periods))

    def advance(self, now_ns: int, limits: TickLimits = NO_LIMITS) -> tuple[Frame, ...]:
        """
        Apply the requests that wait, and advance, or rewind, by the steps that are due.

        :param now_ns: steady time, never going back [ns]
        :return: the frames, in the order in which they are shown; empty where nothing is due and
            nothing has changed
        """
        return self.ticks.advance(now_ns, limits)

    # Requests

    def keep_driving(self, command: DriveRobot) -> None:
        """Have a robot drive on by a command, until it gets another one or is gone."""
        self.applier.drives.commands[command.name] = command

    def perform(self, request: Request, gesture: int | None = None) -> Text:
        """
        Apply a request now, after those that wait, and return a message about it.

        :param gesture: number of the gesture that it belongs to; None begins a new one
        :raises Refusal: the request is refused, and has changed nothing
        """
        OfClass(Request)(request, 'request')
        self.applier.apply_all()
        gesture = self.requests.begin_gesture() if gesture is None else gesture
        message = self.applier.apply_one(request, gesture).message
        self.playback.changed = True
        return message

    def place(self, name: str, x: float, y: float, yaw: float = 0.0) -> None:
        """
        Put a body at a pose in the world, at rest.

        :param x: x of its origin [m]
        :param y: y of its origin [m]
        :param yaw: its angle, counter-clockwise [rad]
        :raises UnknownBody: no body has that name
        :raises Malformed: a number is not finite
        """
        rigid = self._world_now().space.bodies.by_name.get(name)
        # An anchored body takes a pose only.
        twists = np.zeros((0 if rigid is not None and rigid.body.anchored else 1, 3))
        self.perform(Command(names=(name,), poses=np.array(((x, y, yaw),)), twists=twists))

    def begin(self, state: WorldState) -> None:
        """
        Begin with a state, at time 0 and without a past; `reset` returns to it.

        :raises Malformed: the value is not a state
        :raises Refusal: the state is too large, or cannot be simulated; nothing is changed
        """
        OfClass(WorldState)(state, 'state')
        self.applier.apply_all()
        self.past.begin(state.at_rate(self.physics_rate))
        self._show_beginning()

    def load(self, world: WorldState | Beginning) -> Text:
        """
        Replace the world by a state, to which `reset` returns; time goes on. Return a message.

        :param world: a state from `load_world` or `save`, also of a world with another physics
            rate; or its beginning, which any thread makes
        :raises Malformed: the value is neither
        :raises Refusal: the state is too large, or cannot be simulated; nothing is changed
        """
        OfClass(WorldState | Beginning)(world, 'world')
        self._world_now()
        message = self.perform(Restore(state=self._state_to_begin(world)))
        self.applier.let_go()
        return message

    def _state_to_begin(self, world: WorldState | Beginning) -> WorldState:
        """Return the state that the world is to begin with now, and keep its beginning built."""
        if isinstance(world, WorldState):
            return world.at_rate(self.physics_rate)
        self.past.keep_built(world)
        return world.state

    def _show_beginning(self) -> None:
        """Show the world that has begun, which nobody drags, drives or has seen."""
        self.applier.let_go()
        self.frames.forget()
        self.applier.show_jump()

    def save(self) -> WorldState:
        """
        Return the state of the world, to the bit; nothing is changed.

        All worlds that begin with the state continue with the same bits. This world has these bits
        only up to its next impact, because the engine solves contacts in the order in which it
        found them, and a state does not contain that order.
        """
        return self.saver()()

    def saver(self) -> Callable[[], WorldState]:
        """Return a function that returns, on any thread, the state of the world as it is now."""
        return self._world_now().saver()

    def saver_of_run(self) -> Callable[[], WorldState]:
        """
        Return a function like that of `saver`, for the state after the last request.

        A world that begins with this state, and gets no request, repeats the run.
        """
        self.applier.apply_all()
        return self.past.saver_of_run()

    def forces_now(self, snapshot: Snapshot) -> tuple[Contacts, Snapshot] | None:
        """
        Return the forces of a world that has not stepped since a change.

        :param snapshot: of the world that is shown
        :return: contacts as of one step, and a snapshot with the forces of joints, media and
            attraction; None where the world is at another moment, or too large
        """
        world = self.world
        if world.step_count != snapshot.step or world.scene is not snapshot.scene:
            return None
        return forces_now(world.save(), world.physics_rate)

    def checkpoint(self) -> SavedMoment:
        """
        Return this moment, to the bit, for `restore`.

        Requests that wait are applied before, and hands let go. This world then continues with the
        same bits as all worlds that restore the moment, because it too moves into a space that is
        built from the checkpoint. Without the call, its later bits may differ. After an undo, the
        moment has a request of its own, which changes nothing, and is taken back with the gesture
        before it.

        :raises InPast: the past is shown
        """
        self._world_now()
        if self.frame.past:
            raise InPast('the past is shown; go to its end first', field='history')
        self.applier.hands.clear()
        self.applier.release_grips()
        frame = self.frame
        checkpoint = self.past.cursor.add_keyframe()
        return SavedMoment(
            checkpoint=checkpoint,
            loaded=self.loaded,
            frame=frame,
            before=self.sensed.before,
            driving=tuple(self.applier.drives.commands.values()),
            physics_rate=self.physics_rate,
        )

    def restore(self, saved: SavedMoment) -> None:
        """
        Continue from a saved moment, at its time and without a past.

        :param saved: what `checkpoint` returned, also in another simulation or process
        :raises Malformed: the value is not a saved moment
        :raises BadProperty: it is one of a world with another physics rate
        """
        OfClass(SavedMoment)(saved, 'saved')
        if saved.physics_rate != self.physics_rate:
            raise BadProperty(
                'the moment is one at {rate:g} Hz, and this world makes its steps at {own:g} Hz',
                field='physics_rate',
                rate=saved.physics_rate,
                own=self.physics_rate,
            )
        self.applier.apply_all()
        self.past.restore(saved.checkpoint, saved.loaded)
        self._show_beginning()
        for command in saved.driving:
            self.keep_driving(command)
        # Its answers are those of the other simulation.
        frame = replace(saved.frame, answers=(), speed=self.speed, course=self.past.tree.course)
        self.frames.show_again(frame, saved.before)

    def reset(self, seed: int | None = None, *, ahead: Beginning | None = None) -> Text:
        """
        Go to the state that was loaded last, at time 0; `undo` reverts it. Return a message.

        :param seed: seed of all noise from then on; None is that of the state
        :param ahead: the beginning of the state, which any thread makes
        :raises BadProperty: the seed is out of range
        """
        done = self._past_now().reset(seed, ahead)
        self._show_beginning()
        return Text('back at the beginning, time 0' if done else 'at the beginning, time 0')

    def open_world(self, world: WorldState | Beginning) -> Text:
        """
        Begin with another state, at time 0; `undo` reverts it. Return a message.

        :param world: the state, or its beginning, which any thread makes
        :raises Refusal: the state is too large, or cannot be simulated; nothing is changed
        """
        OfClass(WorldState | Beginning)(world, 'world')
        past, state = self._past_now(), self._state_to_begin(world)
        past.open_world(state)
        self._show_beginning()
        return load_message(state)

    def undo(self) -> Text:
        """
        Go back to before the last gesture that changed the world; return a message about it.

        :raises OutOfHistory: no gesture is left to undo
        """
        undone = self._past_now().undo()
        self.applier.show_jump()
        return Text('undid {gesture}, back at {time}', gesture=undone, time=self.playback.time)

    def redo(self) -> Text:
        """
        Return to the moment of the last undo; return a message about it.

        :raises OutOfHistory: nothing was undone, or a request was applied since
        """
        redone = self._past_now().redo()
        self.applier.show_jump()
        return Text('redid {gesture}, at {time}', gesture=redone, time=self.playback.time)

    def return_to_course(self, number: int) -> Text:
        """
        Return to a course, at the time that is shown or its last one; return a message.

        :param number: number of the course
        :raises OutOfHistory: the course is no longer kept; nothing is changed
        """
        if self._past_now().return_to_course(number):
            self.applier.let_go()
        self.applier.show_jump()
        return Text('on course {course}, at {time}', course=number, time=self.playback.time)

    def seek(self, stamp: int) -> Text:
        """
        Go to a simulation time, exactly, and return a message about it.

        :param stamp: the time [ns], a whole number like `snapshot.stamp`
        :raises OutOfHistory: the time is no longer kept, or in the future
        :raises BadProperty: the time is not a whole number
        :raises Malformed: the time is not a finite number
        """
        if not isinstance(stamp, Integral):
            raise BadProperty(
                'a time is a whole number of ns, not {stamp}', field='clock', stamp=shown(stamp)
            )
        number(stamp, 'clock')
        self.applier.apply_all()
        return self.applier.seek(stamp)

    # After the requests that wait

    def _world_now(self) -> World:
        """Apply the requests that wait, and return the world at the moment that is shown."""
        self.applier.apply_all()
        return self.playback.arrive()

    def _past_now(self) -> Past:
        """Apply the requests that wait; return the past, its cursor sent to what is shown."""
        self.applier.apply_all()
        self.playback.send_cursor()
        return self.past
