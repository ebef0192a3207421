# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""After any requests in any order, every step of the past is as it was, to the bit."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from hypothesis import HealthCheck, Phase, settings
from hypothesis import strategies as st
from hypothesis.stateful import initialize, invariant, rule, RuleBasedStateMachine
import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import (
    Anchor,
    Axle,
    ChangeBody,
    Command,
    Configure,
    Delete,
    DeleteAll,
    DeleteBodies,
    Grab,
    Join,
    LetGo,
    MoveBodies,
    MoveHand,
    Pin,
    Release,
    Request,
    Restore,
    Spawn,
    Unjoin,
    UnjoinAll,
)
from physsim_ros.model.shapes import Box, Compound, Disc, Polygon, Shape
from physsim_ros.model.snapshot import Frame
from physsim_ros.simulation.simulation import Simulation

FRAME = 4
PERIOD = 1e9 / 60
SHAPES: list[Shape] = [
    Disc(radius=0.3),
    Box(width=0.8, height=0.4),
    Polygon(outline=((0.0, 0.0), (1.0, 0.0), (0.2, 0.3), (0.0, 1.0))),
    Compound(element=Box(width=0.3, height=0.3), centers=((-0.3, 0.0), (0.0, 0.0), (0.0, 0.3))),
]

names = st.sampled_from([f'a/{number}' for number in range(6)])
joint_names = st.sampled_from([f'j/{number}' for number in range(2)])
coordinates = st.integers(-30, 30).map(lambda tenths: tenths / 10)
points = st.tuples(coordinates, coordinates.map(lambda y: y + 3.0))
changes = st.one_of(
    st.tuples(coordinates, coordinates).map(lambda value: {'gravity': value}),
    st.sampled_from([0.0, 0.2, 0.9]).map(lambda value: {'damping': value}),
    st.sampled_from([3, 10, 25]).map(lambda value: {'iterations': value}),
    st.sampled_from([None, (-4.0, 0.0, 4.0, 9.0)]).map(lambda value: {'bounds': value}),
)


@st.composite
def spawns(draw: Any) -> Spawn:
    anchored = draw(st.integers(0, 3)) == 0
    velocity = None if anchored else draw(st.tuples(coordinates, coordinates))
    return Spawn(
        name=draw(names),
        shape=draw(st.sampled_from(SHAPES)),
        pose=(*draw(points), draw(coordinates)),
        lifetime=draw(st.sampled_from([0.0, 0.0, 0.4])),
        properties=Properties(
            velocity=velocity,
            anchored=anchored,
            elasticity=draw(st.sampled_from([None, 0.9])),
            sensor=draw(st.sampled_from([None, None, True])),
            group=draw(st.sampled_from([None, None, 1])),
        ),
    )


properties = st.sampled_from(
    [
        Properties(),
        Properties(density=3.0),
        Properties(friction=0.1, elasticity=0.0),
        Properties(velocity=(1.0, 2.0)),
        Properties(anchored=True),
        Properties(anchored=False),
    ]
)
colors = st.sampled_from([None, (1.0, 0.0, 0.0, 1.0)])


@st.composite
def commands(draw: Any) -> Command:
    three = st.tuples(coordinates, coordinates, coordinates)
    return Command(
        names=(draw(names),),
        poses=draw(st.sampled_from([(), ((0.5, 4.0, 1.0),)])),
        twists=draw(st.one_of(st.just(()), st.tuples(three))),
        wrenches=draw(st.one_of(st.just(()), st.tuples(three))),
    )


@st.composite
def joins(draw: Any) -> Join:
    kind = draw(st.sampled_from(list(JointKind)))
    ends = draw(st.lists(points, min_size=kind.points, max_size=kind.points, unique=True))
    first, second = draw(st.lists(names, min_size=2, max_size=2, unique=True))
    return Join(
        name=draw(joint_names),
        kind=kind,
        points=tuple(ends),
        a=first,
        b=draw(st.sampled_from([second, 'world'])),
        properties=JointProperties(break_force=draw(st.sampled_from([None, None, 30.0]))),
    )


hands = st.sampled_from(['left', 'right'])
several_names = st.lists(names, min_size=1, max_size=3, unique=True).map(tuple)
requests: st.SearchStrategy[Request] = st.one_of(
    spawns(),
    spawns(),
    commands(),
    changes.map(lambda value: Configure(changes=value)),
    names.map(lambda name: Delete(name=name)),
    st.builds(DeleteAll),
    points.map(lambda point: Anchor(point=point)),
    points.map(lambda point: Release(point=point)),
    points.map(lambda point: Pin(point=point)),
    points.map(lambda point: Axle(point=point)),
    joins(),
    joins(),
    joint_names.map(lambda name: Unjoin(name=name)),
    st.builds(UnjoinAll),
    st.builds(ChangeBody, name=names, properties=properties, color=colors),
    st.builds(MoveBodies, names=several_names, by=points),
    st.builds(DeleteBodies, names=several_names),
    st.builds(Grab, hand=hands, point=points),
    st.builds(LetGo, hand=hands),
)


class TimeMachine(RuleBasedStateMachine):
    """
    Drives a simulation, and remembers what it showed of each step.

    `seen` is what the one course of events that is now has shown; what a branch drops is dropped.
    """

    @initialize(
        several=st.lists(spawns(), min_size=3, max_size=6),
        checkpoints=st.sampled_from([0.25, 0.17]),
    )
    def begin(self, several: list[Spawn], checkpoints: float) -> None:
        self.checkpoints = checkpoints
        self.simulation = self.new()
        self.simulation.watch_contacts(True)
        self.now = 0
        self.seen: dict[int, Frame] = {}
        # The same of each course, when it was in force last.
        self.seen_on: dict[int, dict[int, Frame]] = {}
        self.simulation.requests.submit(
            Configure(changes={'bounds': (-4.0, 0.0, 4.0, 9.0)}), topic=''
        )
        for spawn in several:
            self.simulation.requests.submit(spawn, topic='')
        self.look(self.simulation.apply_requests())

    def new(self) -> Simulation:
        # Checkpoints come every 3 s; here time is short.
        return Simulation(history=5.0, checkpoints=self.checkpoints)

    # Requests

    @rule(request=requests)
    def ask_while_it_stands(self, request: Request) -> None:
        step, digest = self.simulation.step, self.simulation.world.digest()
        made = self.simulation.past.timeline.serial
        self.simulation.requests.submit(request, topic='')
        frame = self.simulation.apply_requests()
        assert frame is not None
        # A request that has changed anything is in the log, to be replayed.
        changed = self.simulation.world.digest() != digest
        assert not changed or self.simulation.past.timeline.serial > made
        self.after_request(frame, step, accepted=not frame.answers[0].code)

    @rule(request=requests)
    def ask_while_it_runs(self, request: Request) -> None:
        step = self.simulation.step
        self.simulation.requests.submit(request, topic='')
        frame = self.simulation.advance_frame()
        accepted = not next(each for each in frame.answers if each.topic == '').code
        if accepted:
            self.drop_after(step)
        self.look(frame)

    @rule(request=requests)
    def ask_while_it_goes_back(self, request: Request) -> None:
        self.run(-1.0, 3)
        step = self.simulation.step
        self.simulation.requests.submit(request, topic='')
        frame = self.simulation.apply_requests()
        assert frame is not None
        self.after_request(frame, step, accepted=not frame.answers[0].code)

    def after_request(self, frame: Frame, step: int, *, accepted: bool) -> None:
        assert frame.snapshot.step == step
        if accepted:
            self.drop_after(step)
            self.seen[step] = frame
        else:
            self.look(frame)

    @rule(hand=hands, name=names, to=points, frames=st.integers(1, 20))
    def drag(self, hand: str, name: str, to: tuple[float, float], frames: int) -> None:
        snapshot, step = self.simulation.world.snapshot(), self.simulation.step
        self.simulation.requests.submit(Grab(hand=hand, point=(0.0, 0.0), frame=name), topic='')
        for number in range(frames):
            point = (to[0], to[1] + number / 10)
            self.simulation.requests.submit(MoveHand(hand=hand, point=point), topic='')
            frame = self.simulation.advance_frame()
            if number == 0 and snapshot.scene.names.count(name):
                self.drop_after(step)
            self.look(frame)

    # Time

    @rule(
        speed=st.sampled_from([-64.0, -4.0, -1.0, -0.3, 0.3, 1.0, 1.0, 4.0]),
        frames=st.integers(1, 50),
    )
    def run(self, speed: float, frames: int) -> None:
        self.simulation.speed = speed
        for _ in range(frames):
            self.now += round(PERIOD)
            for frame in self.simulation.advance(self.now):
                self.look(frame)
        self.simulation.speed = 0.0

    @rule(share=st.floats(0.0, 1.0))
    def seek(self, share: float) -> None:
        history = self.simulation.past.timeline.history
        step = round(history.oldest + share * (history.head - history.oldest))
        self.simulation.seek(round(step * 1e9 / 240))
        assert self.simulation.step == step
        self.look(self.simulation.apply_requests())

    @rule()
    def undo_and_redo(self) -> None:
        step, digest = self.simulation.step, self.simulation.world.digest()
        if not self.simulation.past.timeline.history.log.last_gesture(
            self.simulation.past.timeline.serial
        ):
            return
        self.simulation.undo()
        assert self.simulation.step <= step
        self.simulation.redo()
        assert (self.simulation.step, self.simulation.world.digest()) == (step, digest)

    @rule(frames=st.integers(0, 20))
    def undo_and_go_on_and_redo(self, frames: int) -> None:
        step, digest = self.simulation.step, self.simulation.world.digest()
        if not self.simulation.past.timeline.history.log.last_gesture(
            self.simulation.past.timeline.serial
        ):
            return
        self.simulation.undo()
        # A hand that is there no more lets go, after which nothing can be redone.
        for _ in range(0 if self.simulation.world.grips else frames):
            self.simulation.advance_frame()
        self.simulation.redo()
        assert (self.simulation.step, self.simulation.world.digest()) == (step, digest)

    @rule()
    def undo(self) -> None:
        # The undone gesture is the last before the moment that is shown.
        self.simulation.world.digest()
        timeline = self.simulation.past.timeline
        undone = timeline.history.log.last_gesture(timeline.serial)
        if undone is not None:
            self.simulation.undo()
            assert self.simulation.step == undone[0].step
            self.drop_after(undone[0].step - 1)

    @rule(choice=st.integers(0, 7))
    def return_to_a_course(self, choice: int) -> None:
        courses = self.simulation.status.courses
        if courses:
            number, _, ends = courses[choice % len(courses)]
            self.simulation.return_to_course(number)
            assert self.simulation.status.course == number
            assert self.simulation.step <= round(ends * 240)
            self.seen = dict(self.seen_on[number])
            self.look(self.simulation.apply_requests())

    @rule(frames=st.integers(1, 40))
    def save_and_go_on_elsewhere(self, frames: int) -> None:
        simulation = self.simulation
        history = simulation.past.timeline.history
        simulation.seek(round(history.head * 1e9 / 240))
        self.look(simulation.apply_requests())
        # Hands are not saved.
        self.look(simulation.advance_frame())
        others = self.new(), self.new()
        for other in others:
            other.begin(simulation.save())
            assert other.world.save() == simulation.world.save()
        for _ in range(frames):
            self.look(simulation.advance_frame())
            one, two = (other.advance_frame().snapshot for other in others)
            np.testing.assert_array_equal(one.poses, two.poses)
            np.testing.assert_array_equal(one.twists, two.twists)

    # Invariants

    def look(self, frame: Frame | None) -> None:
        assert frame is not None
        assert not [each for each in frame.answers if each.code == 'divergence'], frame.answers
        step, snapshot = frame.snapshot.step, frame.snapshot
        before = self.seen.setdefault(step, frame).snapshot
        assert snapshot.scene.names == before.scene.names
        assert snapshot.scene.settings == before.scene.settings
        assert snapshot.scene.joints == before.scene.joints
        np.testing.assert_array_equal(snapshot.poses, before.poses)
        np.testing.assert_array_equal(snapshot.twists, before.twists)
        np.testing.assert_array_equal(snapshot.forces, before.forces)

    def drop_after(self, step: int) -> None:
        for number in [number for number in self.seen if number > step]:
            del self.seen[number]

    @invariant()
    def a_course_is_remembered(self) -> None:
        if hasattr(self, 'simulation'):
            self.seen_on[self.simulation.status.course] = dict(self.seen)

    @invariant()
    def the_history_is_no_longer_than_asked(self) -> None:
        if hasattr(self, 'simulation'):
            history = self.simulation.past.timeline.history
            assert history.head - history.oldest <= history.length


TestTimeMachine = TimeMachine.TestCase
TestTimeMachine.settings = settings(
    max_examples=100,
    stateful_step_count=20,
    deadline=None,
    # A failing example is long, and to shrink it takes minutes.
    phases=[Phase.explicit, Phase.reuse, Phase.generate],
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large],
)


def test_a_restored_world_is_one_of_the_requests() -> None:
    first, second = Simulation(), Simulation()
    first.requests.submit(Spawn(name='a/0', shape=SHAPES[0], pose=(0.0, 3.0, 0.0)), topic='')
    for _ in range(30):
        first.advance_frame()
    second.perform(Restore(state=first.save()))
    shown = {}
    for _ in range(60):
        frame = second.advance_frame()
        shown[frame.snapshot.step] = replace(frame.snapshot)
    second.seek(0)
    for _ in range(60):
        snapshot = second.advance_frame().snapshot
        np.testing.assert_array_equal(snapshot.poses, shown[snapshot.step].poses)
