# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The player of random histories, with the oracle that says what each of them must have shown.

A history is a list of operations, which `random_history` makes of a seed. The oracle keeps a plain
list of requests, each with its step, for the line of events that is in force, for each course that
was left, and for what can be redone. At the end it plays every list from nothing, one step at a
time and forward only. That is what each frame must have shown, however its moment was reached.

    python -m test.simulation.histories 17           # the history of seed 17
    python -m test.simulation.histories 1000 2000    # those of all seeds from one to another
    python -m test.simulation.histories 17 --digest  # what it has shown, as a hash

A history that differs is shrunk, and printed as a program.
"""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
import hashlib
import itertools
import sys
import time

import numpy as np
from physsim_ros.files import load_mapping, state_from, text_of
from physsim_ros.files.world_schema import LIMITS
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import InPast, OutOfHistory, Refusal
from physsim_ros.model.requests import (
    Configure,
    Grab,
    HandRequest,
    LetGo,
    MoveHand,
    Request,
    Restore,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.simulation.entries import Amend, Origin, TakeBack
from physsim_ros.simulation.past import Past
from physsim_ros.simulation.simulation import SavedMoment, Simulation
from physsim_ros.simulation.world import beginning_of

from .driven import OVERDUE
from .random_history import history_of, Operation, SETTINGS, shipped_world

# The request of a saved moment from which another line has run on without it.
NOTHING = Configure(changes={})
# Operations for which there is no message.
UNSAID = {'open_world', 'save_moment', 'restore'}
# Processor time of one history that is worth a word [s].
LONGEST = 60.0


class Difference(AssertionError):
    """A history has shown something else than it must have."""


# The oracle


@dataclass(slots=True, eq=False)
class Made:
    """
    A request that changed the world.

    `after` is the step of the last moment before it that was saved, -1 is none; `shown` is whether
    its step was shown with it.
    """

    step: int
    request: Request
    gesture: int
    author: str
    after: int
    shown: bool = False


@dataclass(slots=True)
class Line:
    """A line of events: the state or moment it began with, the requests, and the last step."""

    course: int
    state: WorldState | SavedMoment
    made: list[Made] = field(default_factory=list)
    head: int = 0
    # The moment at which it was left: a step, and a number of requests.
    moment: tuple[int, int] = (0, 0)

    def serial_shown(self, step: int) -> int:
        """Return the number of requests with which a step was shown last."""
        return sum((each.step, not each.shown) < (step, True) for each in self.made)


@dataclass(slots=True, eq=False)
class Shown:
    """A snapshot that was shown, after those requests, and in which operation."""

    state: WorldState | SavedMoment
    made: list[Made]
    snapshot: Snapshot
    operation: int


def key_of(state: WorldState | SavedMoment, made: Sequence[Made]) -> tuple[int, ...]:
    return (id(state), *map(id, made))


def same(one: Snapshot, other: Snapshot) -> bool:
    """Return whether two snapshots are equal to the bit."""
    return (
        one.step == other.step
        and one.scene.key == other.scene.key
        and one.poses.tobytes() == other.poses.tobytes()
        and one.twists.tobytes() == other.twists.tobytes()
        and one.forces.tobytes() == other.forces.tobytes()
        and all(map(_same_bytes, one.robots, other.robots))
    )


def _same_bytes(one: np.ndarray, other: np.ndarray) -> bool:
    return one.tobytes() == other.tobytes()


class Player:
    """
    Plays a history, with the oracle beside.

    Each operation is a method; one that can do nothing where it comes does nothing, so that any
    part of a history is one too.
    """

    def __init__(self) -> None:
        self.now = 0
        self.operation = 0
        self.shown: list[Shown] = []
        # Requests since the last frame.
        self.submitted: list[Request] = []
        # Whether anything may have been dropped of the past.
        self.dropped = False
        # Courses of each time since a reset, by number, and what can be redone and undone.
        self.left: dict[int, Line] = {}
        self.undone: list[tuple[Line, dict[int, Line] | None]] = []
        self.resets: list[tuple[Line, dict[int, Line]]] = []
        self.saved: WorldState | None = None
        # The moment that was saved last. By the beginning of a line and its requests, the steps of
        # those that were saved: there, the world moves into another space. Each has a key as long
        # as these are there.
        self.moment: SavedMoment | None = None
        self.moves: dict[tuple[int, ...], list[int]] = {}
        self.kept: list[list[object]] = []

    # Operations

    def begin(self, physics: float, publish: float, checkpoints: float, contacts: bool) -> None:
        self.rate, self.checkpoints = physics, checkpoints
        self.frame_steps = round(physics / publish)
        self.sim = self._new_simulation(physics, publish)
        self.sim.reports_contacts = contacts
        self.line = Line(1, WorldState(settings=self.sim.world.settings))
        self.courses = 1

    def load_shipped(self, world: str) -> None:
        """Load a world that ships with the package."""
        self.ask(Restore(state=shipped_world(world, self.rate)))

    def ask(self, request: Request, author: str = '') -> None:
        """Submit a request to the world that stands, and show it."""
        self._submit(request, author)
        self.look(self.sim.apply_requests())

    def ask_running(self, request: Request, author: str = '') -> None:
        """Submit a request, and make a frame with it."""
        self._submit(request, author)
        self.look(self.sim.advance_frame())

    def ask_at_once(self, requests: Sequence[Request], joined: bool, author: str) -> None:
        """Submit requests, perhaps as one gesture, and show them together."""
        for number, request in enumerate(requests):
            self._submit(request, author, joined=joined and number > 0)
        self.look(self.sim.apply_requests())

    def run(self, speed: float, frames: int) -> None:
        self.sim.speed = speed
        for _ in range(frames):
            self.now += round(1e9 * self.frame_steps / self.rate)
            for frame in self.sim.advance(self.now):
                self.look(frame)
        self.sim.speed = 0.0

    def run_overdue(self, speed: float, calls: int) -> None:
        """Run in calls that have too little time, so that a replay goes on in the next one."""
        self.sim.speed = speed
        self._call_overdue(calls)
        self.sim.speed = 0.0

    def seek(self, share: float) -> None:
        step = self._step_at(share)
        self._seek(self._stamp(step))
        self.look(self.sim.apply_requests())
        self._check(self.sim.step == step, f'a seek to step {step} came to {self.sim.step}')

    def seek_overdue(self, share: float, calls: int) -> None:
        """Seek in calls that have too little time; the next operation may find it under way."""
        step = self._step_at(share)
        self.sim.requests.submit_seek(self._stamp(step), Origin('~/fuzz'))
        while len(self.sim.requests):
            # Another seek may be under way.
            self._call_overdue(1)
        self._call_overdue(calls)
        self._check(self.sim.step == step, f'a seek to step {step} is at {self.sim.step}')

    def _step_at(self, share: float) -> int:
        """Return the step at a share of the past."""
        oldest, newest = (round(each * self.rate) for each in self._span())
        return round(oldest + share * (newest - oldest))

    def _stamp(self, step: int) -> int:
        return round(step * 1e9 / self.rate)

    def _call_overdue(self, calls: int) -> None:
        for frame in self._frames_overdue(calls):
            self.look(frame)

    def _frames_overdue(self, calls: int) -> Iterator[Frame]:
        for _ in range(calls):
            self.now += round(1e9 * self.frame_steps / self.rate)
            yield from self.sim.advance(self.now, OVERDUE)

    def undo(self) -> None:
        before, words = self._position(), self.sim.status.undo
        serial = before.moment[1]
        try:
            self._perform('undo')
        except OutOfHistory:
            self._check(not words, f'undo is refused, though it is told: {words}')
            done = any(each.gesture for each in before.made[:serial])
            self._check(self.dropped or not (done or self.resets), 'undo is refused')
            return
        if words in {'undo reset', 'undo open world'}:
            self.undone.append((before, self.left))
            self.line, self.left = self.resets.pop()
            self._arrive(self.line.moment)
            return
        gesture = before.made[serial - 1].gesture
        first = next(n for n, each in enumerate(before.made) if each.gesture == gesture)
        step = before.made[first].step
        self.undone.append((before, None))
        self.line = Line(before.course, before.state, before.made[:first], step)
        self._arrive((step, first))

    def redo(self) -> None:
        before, words = self._position(), self.sim.status.redo
        try:
            self._perform('redo')
        except OutOfHistory:
            self._check(not words, f'redo is refused, though it is told: {words}')
            self._check(self.dropped or not self.undone, 'redo is refused')
            return
        line, left = self.undone.pop()
        if left is not None:
            self.resets.append((before, self.left))
            self.left = left
        self.line = line
        self._arrive(line.moment)

    def take_back(self, author: str, calls: int) -> None:
        """
        Take back what a person has done last; what others have done since is done again.

        :param calls: that have too little time for more than a part of it
        """
        before = self._position()
        theirs = [each.gesture for each in before.made if each.author == author]
        self.sim.requests.submit(TakeBack(), Origin('~/fuzz', author=author, asker='me'))
        made = [*self._frames_overdue(calls), self.sim.apply_requests()]
        frames = [frame for frame in made if frame is not None]
        answers = [answer for frame in frames for answer in frame.answers]
        match next(each.code for each in answers if each.asker == 'me'):
            case 'in_past':
                self._check(before.moment != (before.head, len(before.made)), 'it is the end')
            case 'out_of_history':
                self._check(self.dropped or not theirs, f'nothing by {author} is taken back')
            case 'not_alone':
                self._look_and_arrive(frames, before.moment)
            case code:
                self._check(not code, f'taking back is refused: {code}')
                later = self._cut(before, theirs[-1])
                self._look_and_arrive(frames, before.moment)
                self._check_done_again(later)
                self.undone = [(before, None)]

    def _look_and_arrive(self, frames: Sequence[Frame], moment: tuple[int, int]) -> None:
        for frame in frames:
            self.look(frame)
        self._arrive(moment)

    def amend(self, back: int, requests: Sequence[Request], calls: int) -> None:
        """
        Have other requests instead of those of an earlier gesture, up to this moment.

        :param calls: that have too little time for more than a part of it
        """
        before = self._position()
        # That of a saved moment before all others is nobody's.
        made = (each.gesture for each in before.made[: before.moment[1]] if each.gesture)
        gestures = list(dict.fromkeys(made))
        if self.dropped or not gestures:
            return
        gesture = gestures[-min(back, len(gestures))]
        self.sim.requests.submit(Amend((gesture,), tuple(requests)), topic='~/fuzz')
        # While it waits, a frame of steps that were under way shows the line before.
        frames = [each for each in self._frames_overdue(calls) if not len(self.sim.requests)]
        frames.append(self.sim.apply_requests())
        later = self._cut(before, gesture)
        self.submitted += requests
        for frame in frames:
            self.look(frame)
        self._check_done_again(later)
        self.undone.clear()

    def _cut(self, before: Line, gesture: int) -> list[Made]:
        """End the line before a gesture; return the later requests, which are asked again."""
        (step, serial), made = before.moment, before.made
        first = next(n for n, each in enumerate(made) if each.gesture == gesture)
        opening = made[first]
        self.line = Line(before.course, before.state, made[:first], step)
        later = [
            each
            for each in made[first:serial]
            if (each.gesture, each.author) != (gesture, opening.author)
        ]
        self.submitted += [each.request for each in later]
        return later

    def _check_done_again(self, later: list[Made]) -> None:
        """Check that later requests were done again in their order, each at its step."""
        asked = iter([(each.step, id(each.request)) for each in later])
        known = {id(each.request) for each in later}
        again = [each for each in self.line.made if id(each.request) in known]
        in_order = all((each.step, id(each.request)) in asked for each in again)
        self._check(in_order, 'requests are done again in another order or at another step')

    def reset(self) -> None:
        before = self._position()
        self._perform('reset')
        if not (before.head or before.moment[1]):
            return
        loads = [each.request.state for each in before.made if isinstance(each.request, Restore)]
        begun = before.state
        loads.insert(0, begun.loaded if isinstance(begun, SavedMoment) else begun)
        self._begin_anew(before, loads[-1])

    def open_world(self, built: bool) -> None:
        """
        Begin with the world that was saved last.

        :param built: whether its beginning is built before, as on a thread
        """
        if self.saved is None:
            return
        before = self._position()
        self.sim.open_world(beginning_of(self.saved, self.rate) if built else self.saved)
        self._begin_anew(before, self.saved)

    def _begin_anew(self, before: Line, state: WorldState) -> None:
        self.resets.append((before, self.left))
        self.undone.clear()
        self.courses += 1
        # Each beginning is another one, also of the same state.
        self.line = Line(self.courses, replace(state))
        self.left = {}
        self._arrive((0, 0))

    def course(self, choice: int) -> None:
        listed = [each.number for each in self.sim.status.courses]
        known = [*self.left]
        self._check(set(listed) <= set(known), f'courses {listed} are told of {known}')
        self._check(self.dropped or set(listed) == set(known[-16:]), f'{listed}, {known}')
        if not listed:
            return
        number = listed[choice % len(listed)]
        step = self.sim.step
        before = self._position()
        self._return_to_course(number)
        self.left[before.course] = before
        self.line = self.left.pop(number)
        self.undone.clear()
        oldest = round(self._span()[0] * self.rate)
        step = max(oldest, min(step, self.line.head))
        self._arrive((step, self.line.serial_shown(step)))

    def report_contacts(self, reports: bool) -> None:
        self.sim.reports_contacts = reports
        self.look(self.sim.apply_requests())

    def limit_memory(self, megabytes: float) -> None:
        self.dropped |= megabytes < 16.0
        self.sim.limit_memory(megabytes)
        self.look(self.sim.apply_requests())

    def limit_history(self, seconds: float) -> None:
        self.dropped |= seconds < 600.0
        self.sim.limit_history(seconds)
        self.look(self.sim.apply_requests())

    def drag(self, name: str, to: tuple[float, float], frames: int, lets_go: bool) -> None:
        """Drag a body for some frames; a hand that does not let go is gone at the next jump."""
        self.sim.speed = 1.0
        self._submit(Grab(hand='h', point=(0.0, 0.0), frame=name))
        for number in range(frames):
            self.look(self.sim.advance_frame())
            self._submit(MoveHand(hand='h', point=(to[0], to[1] + number / 10)))
        if lets_go:
            self._submit(LetGo(hand='h'))
        self.look(self.sim.advance_frame())
        self.sim.speed = 0.0

    def save(self) -> None:
        """Save; the file is the world to the bit, and all that load it go on alike."""
        state = self.sim.save()
        if len(state.bodies) > state.settings.max_bodies:
            # The limit has come down since; no world may begin so.
            return
        self.saved = state
        text = text_of(state, self.rate)
        # Limits are the node's to say. They may have come down since.
        limits = {name: getattr(state.settings, name) for name in LIMITS}
        content = load_mapping(text, field='file')
        loaded = state_from(content, WorldSettings(), self.rate)
        loaded = replace(loaded, settings=replace(loaded.settings, **limits))
        self._check(loaded.settings == state.settings, 'settings load differently')
        for one, other in zip(loaded.bodies, state.bodies, strict=True):
            self._check(one == other, f'a body loads differently: {one} was {other}')
        for one, other in zip(loaded.joints, state.joints, strict=True):
            self._check(one == other, f'a joint loads differently: {one} was {other}')
        self._check(text_of(loaded, self.rate) == text, 'saved, loaded and saved again differs')
        worlds = self._beside(), self._beside()
        for world, begins in zip(worlds, (state, loaded), strict=True):
            world.begin(begins)
        again = text_of(worlds[1].save(), self.rate)
        self._check(again == text, 'a world that was loaded is saved differently')
        for _ in range(20):
            one, other = (world.advance_frame().snapshot for world in worlds)
            self._check(same(one, other), 'two worlds of one file go apart')

    def load(self) -> None:
        """Load the world that was saved last; time goes on."""
        if self.saved is not None:
            self.ask(Restore(state=self.saved))

    def save_moment(self, frames: int) -> None:
        """Save the moment; this world goes on like one that restores it."""
        before = self._position()
        self.submitted.append(NOTHING)
        try:
            moment = self.sim.checkpoint()
        except InPast:
            self._check(before.moment != (before.head, len(before.made)), 'it is the end')
            self.look(self.sim.apply_requests())
            return
        self.look(moment.frame)
        grips = moment.frame.snapshot.grips
        self._check(grips == moment.checkpoint.grips, f'the frame of a saved moment has {grips}')
        steps = self.moves.setdefault(key_of(self.line.state, self.line.made), [])
        steps.append(self.sim.step)
        self.kept.append([self.line.state, *self.line.made])
        self.moment, other = moment, self._beside()
        other.restore(moment)
        other.reports_contacts = self.sim.reports_contacts
        for _ in range(frames):
            frame, its = self.sim.advance_frame(), other.advance_frame()
            self.look(frame)
            self._check(same(frame.snapshot, its.snapshot), 'a restored world goes apart')

    def restore(self) -> None:
        """Continue from the moment that was saved last, without a past."""
        if self.moment is None:
            return
        self.sim.restore(self.moment)
        step = self.moment.frame.snapshot.step
        self.line, self.courses = Line(1, replace(self.moment), head=step), 1
        self.left, self.undone, self.resets = {}, [], []
        frame = self.sim.frame
        here = frame.course, frame.speed, frame.answers
        self._check(here == (1, 0.0, ()), f'a restored frame has {here}')
        self._arrive((step, 0))

    def _beside(self) -> Simulation:
        """Return a new simulation beside this one."""
        return Simulation(
            physics_rate=self.rate,
            publish_rate=self.rate / self.frame_steps,
            checkpoints=self.checkpoints,
        )

    def _new_simulation(self, physics: float, publish: float) -> Simulation:
        return Simulation(
            physics_rate=physics,
            publish_rate=publish,
            settings=SETTINGS,
            checkpoints=self.checkpoints,
            speed=0.0,
        )

    # How the simulation is asked, which is otherwise over topics and on a page

    def _submit(self, request: Request, author: str = '', *, joined: bool = False) -> None:
        self.submitted.append(request)
        self.sim.requests.submit(request, Origin('~/fuzz', author=author), joined=joined)

    def _perform(self, action: str) -> None:
        """Undo, redo or reset."""
        getattr(self.sim, action)()

    def _seek(self, stamp: int) -> None:
        self.sim.seek(stamp)

    def _return_to_course(self, number: int) -> None:
        self.sim.return_to_course(number)

    # What it has shown

    def _span(self) -> tuple[float, float]:
        return self.sim.status.oldest, self.sim.status.newest

    def _position(self) -> Line:
        """Return the line of events, with the moment that is shown."""
        serial = self.line.serial_shown(self.sim.step)
        return replace(self.line, made=[*self.line.made], moment=(self.sim.step, serial))

    def _arrive(self, moment: tuple[int, int]) -> None:
        """Check where a jump has come to."""
        step, digest = self.sim.step, self.sim.world.digest()
        if not self.dropped:
            self._check(step == moment[0], f'step {step} instead of {moment[0]}')
        self._check(self.sim.status.course == self.line.course, 'another course')
        for each in self.line.made[: moment[1]]:
            # An undo shows a step with the requests before the gesture, though none was shown.
            each.shown |= each.step == step
        self.look(self.sim.apply_requests())
        self._check(digest == self.sim.world.digest(), 'a frame has changed the world')

    def look(self, frame: Frame | None) -> None:
        """Note the requests that were applied before a frame, and what it shows."""
        if frame is None:
            return
        bad = [each.message for each in frame.answers if each.code == 'divergence']
        self._check(not bad, f'{bad}')
        self.dropped |= any(each.code == 'history' for each in frame.answers)
        step = frame.snapshot.step
        for each in self._note_requests(frame):
            # One that a running world has applied shows in the next frame only.
            each.shown = each.step == step
        line = self.line
        line.head = max(line.head, step)
        made = line.made[: line.serial_shown(step)]
        self.shown.append(Shown(line.state, made, frame.snapshot, self.operation))

    def _note_requests(self, frame: Frame) -> list[Made]:
        """Return the requests that have changed the world since the last frame, from its log."""
        history, line = self.sim.past.line, self.line
        dropped, logged = history.nodes[0].serial, history.nodes[1:]
        pairs = zip(line.made[dropped:], logged, strict=False)
        same_yet = itertools.takewhile(lambda pair: pair[0].request is pair[1].request, pairs)
        common = len([*same_yet])
        if frame.course != line.course:
            self.left[line.course] = line
            self.courses += 1
            kept = line.made[: dropped + common]
            self.line = Line(frame.course, line.state, kept, logged[-1].step)
        else:
            self._check(dropped + common == len(line.made), 'requests are lost')
        fresh: list[Made] = []
        for each in logged[common:]:
            moves = self.moves.get(key_of(self.line.state, [*self.line.made, *fresh]), ())
            after = max((step for step in moves if step <= each.step), default=-1)
            fresh.append(Made(each.step, each.request, each.gesture, each.author, after))
        for each in fresh:
            self._check(self._was_asked(each.request), 'nobody has asked for this')
        self.submitted.clear()
        # Nobody has asked for the release of a silent hand, and what there is to redo stays.
        unasked = sum('no message from' in each.message for each in frame.answers)
        if len(fresh) > unasked + sum(each.request == NOTHING for each in fresh):
            self.undone.clear()
        self.line.made += fresh
        return fresh

    def _was_asked(self, request: Request) -> bool:
        return isinstance(request, HandRequest) or request in self.submitted

    # What it must have shown

    def verify(self) -> None:
        """Play all requests from nothing, and compare what was shown on the way."""
        pending: dict[tuple[int, ...], list[Shown]] = {}
        for each in self.shown:
            pending.setdefault(key_of(each.state, each.made), []).append(each)
        while pending:
            longest = max(pending, key=len)
            last = max(pending[longest], key=lambda each: each.snapshot.step)
            for state, made, snapshot in self.straight(last.state, last.made, last.snapshot.step):
                key = key_of(state, made)
                here = [
                    each for each in pending.get(key, []) if each.snapshot.step == snapshot.step
                ]
                for each in here:
                    if not same(each.snapshot, snapshot):
                        raise Difference(
                            f'operation {each.operation} has shown step {snapshot.step} otherwise '
                            f'than {len(made)} requests played from nothing'
                        )
                if here:
                    pending[key] = [each for each in pending[key] if each not in here]
                    if not pending[key]:
                        del pending[key]

    def straight(
        self, state: WorldState | SavedMoment, made: list[Made], end: int
    ) -> Iterator[tuple[WorldState | SavedMoment, list[Made], Snapshot]]:
        """Play requests from nothing, step by step; yield what is there after each of both."""
        past = Past(
            physics_rate=self.rate,
            frame_steps=1,
            settings=SETTINGS,
            length=1e6,
            checkpoints=self.checkpoints,
            memory=1e6,
            boundary=ErrorBoundary(),
        )
        if isinstance(state, SavedMoment):
            past.restore(state.checkpoint, state.loaded)
        else:
            past.begin(state)
        cursor = past.cursor
        yield state, [], cursor.arrive().snapshot()
        for count in range(len(made) + 1):
            goal = after = end
            if count < len(made):
                goal, after = made[count].step, made[count].after
            moves = self.moves.get(key_of(state, made[:count]), ())
            while True:
                if cursor.arrive().step_count in moves and cursor.arrive().step_count <= after:
                    cursor.add_keyframe()
                if cursor.arrive().step_count >= goal:
                    break
                cursor.begin_advance(1)
                yield state, made[:count], cursor.arrive().snapshot()
            if count < len(made):
                past.apply(made[count].request, count)
                yield state, made[: count + 1], cursor.arrive().snapshot()

    def digest(self) -> str:
        """Return a hash of all that was shown."""
        digest = hashlib.blake2b(digest_size=16)
        for each in self.shown:
            snapshot = each.snapshot
            digest.update(f'{snapshot.step} '.encode() + snapshot.scene.key)
            for array in (snapshot.poses, snapshot.twists, snapshot.forces):
                digest.update(array.tobytes())
        return digest.hexdigest()

    def _check(self, holds: bool, message: str) -> None:
        if not holds:
            raise Difference(message)


class NodePlayer(Player, ABC):
    """
    A player of the simulation of a node, which is asked by messages where there are some.

    :param simulation: of the node

    :ivar sent: number of messages
    """

    def __init__(self, simulation: Simulation) -> None:
        super().__init__()
        self.sent = 0
        self._simulation = simulation

    @abstractmethod
    def send(self, request: Request) -> bool:
        """Send the message of a request; return whether it has one."""

    def _new_simulation(self, physics: float, publish: float) -> Simulation:
        simulation = self._simulation
        simulation.speed = 0.0
        assert (simulation.physics_rate, simulation.frame_steps) == (physics, physics / publish)
        return simulation

    def _submit(self, request: Request, author: str = '', *, joined: bool = False) -> None:
        if self.send(request):
            self.sent += 1
        else:
            super()._submit(request, author, joined=joined)

    def _was_asked(self, _: Request) -> bool:
        # A message has another rounding, and may ask by another request.
        return True


def history_of_node(seed: int) -> list[Operation]:
    """Return the operations of a seed at the rates that a node has by default."""
    (begin, *_, contacts), *operations = history_of(seed)
    others = [each for each in operations if each[0] not in UNSAID]
    return [(begin, 240.0, 60.0, 3.0, contacts), *others]


# Playing and shrinking


def play(operations: Sequence[Operation], player: Player | None = None) -> Player:
    """
    Play a history.

    :param player: asks the simulation; None asks it itself
    :raises Difference: it has shown anything else than the oracle
    """
    player = player or Player()
    for number, (name, *arguments) in enumerate(operations):
        player.operation = number
        try:
            getattr(player, name)(*arguments)
        except Refusal as refusal:
            raise Difference(f'{name} is refused: {refusal}') from refusal
    player.verify()
    return player


def difference_of(operations: Sequence[Operation]) -> str:
    """Return how a history differs from the oracle, or ''."""
    try:
        play(operations)
    except Difference as difference:
        return str(difference)
    return ''


def shrunk(operations: Sequence[Operation], seconds: float = 60.0) -> list[Operation]:
    """Leave out operations, half of them, a quarter and so on, as long as a difference remains."""
    left, size = list(operations), len(operations) // 2
    end = time.process_time() + seconds
    while size and time.process_time() < end:
        place = 1
        while place < len(left) and time.process_time() < end:
            rest = place + size
            fewer = left[:place] + left[rest:]
            if difference_of(fewer):
                left = fewer
            else:
                place = rest
        size //= 2
    return left


def script(operations: Sequence[Operation]) -> str:
    """Return a history as a program."""
    lines = [f'player.{name}({", ".join(map(repr, rest))})' for name, *rest in operations]
    return '\n'.join(['player = Player()', *lines, 'player.verify()'])


def check(seed: int) -> None:
    """
    Play the history of a seed.

    :raises Difference: with its program, shrunk
    """
    operations = history_of(seed)
    if difference_of(operations):
        short = shrunk(operations)
        raise Difference(f'seed {seed}: {difference_of(short)}\n{script(short)}')


def main(arguments: list[str]) -> int:
    """Play histories; return how many differ."""
    seeds = [int(each) for each in arguments if each.isdigit()]
    if '--digest' in arguments:
        sys.stdout.write(f'{play(history_of(seeds[0])).digest()}\n')
        return 0
    found = 0
    for seed in range(seeds[0], seeds[-1] + 1):
        before = time.process_time()
        try:
            check(seed)
        except Difference as difference:
            found += 1
            sys.stdout.write(f'{difference}\n')
        if (seconds := time.process_time() - before) > LONGEST:
            sys.stdout.write(f'seed {seed} took {seconds:.0f} s of the processor\n')
        if (played := seed + 1 - seeds[0]) % 100 == 0 or seed == seeds[-1]:
            sys.stdout.write(f'{played} histories, of which {found} differ\n')
        sys.stdout.flush()
    return found


if __name__ == '__main__':
    sys.exit(main(sys.argv[1:]))
