# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests go in and are answered, in order, one each; frames come out, at their time."""

from collections.abc import Callable
from dataclasses import replace
import math

import numpy as np
from physsim_ros.files import (
    find_world,
    load_mapping,
    load_world,
    robot_spawn,
    state_from,
    text_of,
)
from physsim_ros.model.answer import Answer
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import (
    BadProperty,
    Malformed,
    NothingThere,
    Refusal,
    UnknownBody,
)
from physsim_ros.model.requests import (
    Anchor,
    ChangeBody,
    Command,
    CommandMotors,
    Configure,
    Cut,
    Delete,
    DeleteAll,
    DeleteBodies,
    DriveRobot,
    Grab,
    MoveBodies,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Polygon
from physsim_ros.model.snapshot import Frame
from physsim_ros.simulation.entries import Origin
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import World
import pytest

from .driven import OVERDUE
from ..building import BOX, DISC, joining, NOWHERE, spawn, spawning

SECOND = 1_000_000_000
PERIOD = SECOND / 60
FRAME = 4


def simulation(speed: float = 1.0, settings: WorldSettings = NOWHERE) -> Simulation:
    return Simulation(settings=settings, speed=speed)


def periods(simulation: Simulation, count: int, *, since: int = 0) -> list[Frame]:
    """Advance once a period; return all frames."""
    frames: list[Frame] = []
    for number in range(count):
        frames += simulation.advance(round((since + number) * PERIOD))
    return frames


def answers(frames: list[Frame]) -> list[Answer]:
    return [answer for frame in frames for answer in frame.answers]


def test_a_publish_rate_has_to_divide_the_physics_rate():
    assert Simulation(physics_rate=240.0, publish_rate=60.0).frame_steps == 4
    assert Simulation(physics_rate=60.0, publish_rate=60.0).frame_steps == 1
    assert Simulation(physics_rate=100.0, publish_rate=33.0 + 1.0 / 3.0).frame_steps == 3
    for physics_rate, publish_rate in ((240.0, 50.0), (60.0, 120.0), (240.0, 59.9), (240.0, 0.0)):
        with pytest.raises(BadProperty) as refused:
            Simulation(physics_rate=physics_rate, publish_rate=publish_rate)
        assert refused.value.field == 'publish_rate'


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf, 1e300, -65.0])
def test_times_and_speeds_out_of_range_are_refused_and_change_nothing(value):
    for name in ('history', 'checkpoints', 'speed'):
        with pytest.raises((BadProperty, Malformed)) as refused:
            Simulation(**{name: value})
        assert refused.value.field == name
    sim = Simulation()
    drive = DriveRobot(name='robot/0', velocity=(1.0, 0.0, 0.0))
    sim.applier.drives.commands['robot/0'] = drive
    with pytest.raises((BadProperty, Malformed), match='speed'):
        sim.speed = value
    with pytest.raises((BadProperty, Malformed), match='history'):
        sim.limit_history(value)
    assert (sim.speed, sim.applier.drives.commands) == (1.0, {'robot/0': drive})


def test_a_time_beyond_all_numbers_is_refused():
    with pytest.raises(Malformed, match='clock'):
        Simulation().seek(10**400)


def test_a_time_in_seconds_is_refused():
    sim = simulation()
    sim.advance_frame()
    with pytest.raises(BadProperty, match='whole number of ns'):
        sim.seek(0.01)  # type: ignore[arg-type]
    assert sim.step == FRAME
    assert sim.seek(0) == 'at 0.000 s'


def test_requests_are_answered_in_order_and_one_each():
    sim = simulation()
    sim.requests.submit(spawning('a/0'), topic='~/spawn')
    sim.requests.submit(Delete(name='a/1'), topic='~/spawn')
    sim.requests.refuse(Malformed('no number'), Origin('~/spawn', field='pose'), subject='a/1')
    sim.requests.submit(spawning('a/1', DISC, (5.0, 0.0, 0.0)), topic='~/spawn_array')
    sim.requests.submit(Command(names=('a/1',), twists=((1.0, 0.0, 0.0),)), topic='~/command')
    sim.requests.submit(Anchor(point=(9.0, 9.0)), topic='~/anchor')
    sim.requests.submit(Anchor(point=(0.0, 0.0)), topic='~/anchor')
    sim.requests.submit(DeleteAll(namespace='b'), topic='~/spawn')
    assert len(sim.world) == 0

    frames = periods(sim, 3)

    assert answers(frames) == [
        Answer(topic='~/spawn', subject='a/0', message='spawned a/0'),
        Answer(
            topic='~/spawn',
            subject='a/1',
            message="there is no body 'a/1'; nearest is 'a/0'",
            code='unknown_body',
            field='name',
        ),
        # A refused text has its answer in its place.
        Answer(
            topic='~/spawn', subject='a/1', message='no number', code='malformed', field='pose'
        ),
        Answer(topic='~/spawn_array', subject='a/1', message='spawned a/1'),
        Answer(topic='~/command', subject='a/1', message='set velocity of a/1'),
        Answer(
            topic='~/anchor',
            message='there is no body at (9, 9)',
            code='nothing_there',
            field='point',
        ),
        Answer(topic='~/anchor', subject='a/0', message='anchored a/0'),
        Answer(topic='~/spawn', message='deleted 0 bodies'),
    ]
    assert frames[0].answers == tuple(answers(frames))


@pytest.mark.parametrize(
    ('request_', 'subject'),
    [(spawning('b/9', frame='nobody/0'), 'b/9'), (Delete(name='b/9'), 'b/9'),
     (Command(names=('b/9',)), 'b/9'), (Command(names=('b/8', 'b/9')), ''),
     (Anchor(point=(9.0, 9.0)), '')],
)  # fmt: skip
def test_a_refusal_names_the_body_that_it_is_about(request_, subject):
    sim = simulation()
    sim.requests.submit(request_, topic='~/topic')

    (answer,) = answers(periods(sim, 1))

    assert (answer.topic, answer.subject) == ('~/topic', subject)
    assert answer.code


@pytest.mark.parametrize('names', [('a/0',), ('a/0', 'a/1')])
@pytest.mark.parametrize(
    'request_of',
    [
        lambda names: Command(names=names, twists=((1.0, 0.0, 0.0),) * len(names)),
        lambda names: MoveBodies(names=names, by=(1.0, 0.0)),
        lambda names: DeleteBodies(names=names),
        lambda names: Cut(pieces=tuple(ChangeBody(name=name) for name in names)),
    ],
)
def test_an_answer_names_the_body_that_it_is_about_if_that_is_one(request_of, names):
    world = World()
    for number in range(3):
        spawn(world, f'a/{number}', DISC, (3.0 * number, 0.0, 0.0))

    answer = world.apply(request_of(names)).answer

    assert answer.subject == (names[0] if len(names) == 1 else '')


def test_frames_come_at_multiples_of_the_publish_period():
    sim = simulation()

    frames = periods(sim, 61)

    assert [frame.snapshot.step for frame in frames] == list(range(0, 241, FRAME))
    assert [frame.stepped for frame in frames] == [False, *[True] * 60]
    assert (frames[0].snapshot.stamp, frames[-1].snapshot.stamp) == (0, SECOND)
    assert (frames[0].speed, answers(frames)) == (1.0, [])


def test_a_paused_world_carries_out_requests_and_shows_them():
    sim = simulation(speed=0.0)
    periods(sim, 1)
    assert periods(sim, 60, since=1) == []

    sim.requests.submit(spawning('a/0', DISC, velocity=(1.0, 0.0)), topic='~/spawn')
    sim.requests.submit(Delete(name='a/9'), topic='~/spawn')
    (frame,) = periods(sim, 60, since=61)

    assert (frame.stepped, frame.speed) == (False, 0.0)
    assert frame.snapshot.step == 0
    assert frame.snapshot.scene.names == ('a/0',)
    assert [answer.code for answer in frame.answers] == ['', 'unknown_body']
    sim.perform(Delete(name='a/0'))
    (frame,) = periods(sim, 2, since=121)
    assert (frame.stepped, frame.snapshot.scene.names) == (False, ())


def test_play_and_pause_go_on_where_they_were():
    sim = simulation()
    periods(sim, 11)

    sim.speed = 0.0
    periods(sim, 600, since=11)
    assert sim.world.step_count == 10 * FRAME
    sim.speed = 2.0
    frames = periods(sim, 11, since=611)

    assert sim.world.step_count == 30 * FRAME
    assert {frame.speed for frame in frames} == {2.0}
    assert sim.playback.clock.late_frames == 0


def test_two_frames_a_call_make_up_for_a_hiccup_and_more_are_counted_as_late():
    sim = simulation()
    sim.requests.submit(spawning('a/0'), topic='~/spawn')
    sim.advance(0)

    frames = [sim.advance(round(number * PERIOD)) for number in (4, 5, 6, 7, 8)]

    assert [len(each) for each in frames] == [2, 2, 2, 1, 1]
    steps = [frame.snapshot.step for each in frames for frame in each]
    assert steps == list(range(FRAME, 8 * FRAME + 1, FRAME))
    assert sim.playback.clock.late_frames == 0
    # Answers are told once, with the first frame.
    assert not any(frame.answers for each in frames for frame in each)

    frames = [*sim.advance(round(108.2 * PERIOD)), *sim.advance(round(109.2 * PERIOD))]
    assert [frame.snapshot.step for frame in frames] == [9 * FRAME, 10 * FRAME]
    assert sim.playback.clock.late_frames == 99


def test_advance_frame_goes_on_by_a_period_whatever_the_speed():
    sim = simulation(speed=0.0)
    sim.requests.submit(spawning('a/0'), topic='~/spawn')

    frame = sim.advance_frame()

    assert (frame.snapshot.step, frame.stepped, frame.speed) == (FRAME, True, 0.0)
    assert [answer.message for answer in frame.answers] == ['spawned a/0']
    assert sim.advance_frame().snapshot.step == 2 * FRAME


def test_advance_frame_ends_on_a_multiple():
    sim = simulation(speed=0.5)
    sim.advance(0)
    sim.advance(round(PERIOD * 1.6))
    assert sim.world.step_count % FRAME

    assert sim.advance_frame().snapshot.step == FRAME


JUMPS = {
    'reset': Simulation.reset,
    'undo': Simulation.undo,
    'seek': lambda sim: sim.seek(0),
    'world': lambda sim: sim.open_world(WorldState(settings=NOWHERE)),
}
FRAMES = {
    'frame': lambda sim: sim.frame,
    'requests': Simulation.apply_requests,
    'advance': lambda sim: sim.advance(round(60 * PERIOD))[0],
}


@pytest.mark.parametrize('frame', FRAMES.values(), ids=FRAMES)
@pytest.mark.parametrize('jump', JUMPS.values(), ids=JUMPS)
def test_a_frame_tells_steps_from_jumps_however_it_is_read(jump, frame):
    sim = simulation(speed=0.0)
    sim.perform(spawning('a/0'))
    sim.run(1.0)
    assert sim.frame.stepped

    jump(sim)
    shown = frame(sim)

    assert (shown.snapshot.step, shown.stepped) == (0, False)
    sim.run(1.0)
    assert sim.frame.stepped


def test_settle_carries_out_what_was_asked_and_goes_nowhere():
    sim = simulation()
    sim.advance(0)
    assert sim.apply_requests() is None
    sim.requests.submit(spawning('a/0'), topic='~/spawn')

    frame = sim.apply_requests()

    assert (frame.stepped, frame.snapshot.step) == (False, 0)
    assert [answer.subject for answer in frame.answers] == ['a/0']
    assert sim.apply_requests() is None


def test_perform_is_at_once_after_those_that_wait():
    sim = simulation()
    sim.requests.submit(spawning('a/0'), topic='~/spawn')

    assert sim.perform(Delete(name='a/0')) == 'deleted a/0'

    assert len(sim.world) == 0
    # Who waited is answered with the next frame, who performs has the answer already.
    assert [answer.message for answer in answers(periods(sim, 1))] == ['spawned a/0']


def test_perform_raises_what_is_refused_and_changes_nothing():
    sim = simulation()
    before = sim.world.digest()

    with pytest.raises(UnknownBody):
        sim.perform(Delete(name='a/0'))
    with pytest.raises(NothingThere):
        sim.perform(Anchor(point=(0.0, 0.0)))

    assert sim.world.digest() == before


@pytest.mark.parametrize('wrong', ['a', None, 3, Delete])
def test_what_is_of_another_type_is_refused_and_changes_nothing(wrong):
    sim = simulation()
    before = sim.world.digest()

    with pytest.raises(Malformed, match='request must be of class Request'):
        sim.perform(wrong)
    with pytest.raises(Malformed, match='saved must be of class SavedMoment'):
        sim.restore(wrong)
    with pytest.raises(BadProperty, match='seconds must be a number'):
        sim.run([wrong])  # type: ignore[arg-type]
    if wrong is not None:
        with pytest.raises(Malformed, match='settings must be of class WorldSettings'):
            Simulation(settings=wrong)

    assert sim.world.digest() == before


def saved(settings: WorldSettings) -> World:
    """Return a world that has been going on for a while."""
    world = World(settings=settings)
    spawn(world, 'a/0', DISC, (1.0, 2.0, 0.3), velocity=(3.0, 4.0), spin=5.0, lifetime=10.0)
    spawn(world, 'a/1', BOX, (5.0, 2.0, 0.3), anchored=True)
    world.apply(Command(names=('a/0',), wrenches=((0.1, 0.0, 0.0),)))
    world.step(24)
    return world


def test_load_replaces_the_world_and_time_goes_on():
    sim = simulation()
    sim.requests.submit(spawning('b/0'), topic='~/spawn')
    periods(sim, 11)
    world = saved(WorldSettings(gravity=(0.0, -1.0)))

    message = sim.load(world.save())

    assert message == 'loaded 2 bodies'
    assert sim.world.settings.gravity == (0.0, -1.0)
    assert sim.world.step_count == 10 * FRAME
    snapshot = sim.world.snapshot()
    assert snapshot.scene.names == ('a/0', 'a/1')
    assert np.array_equal(snapshot.poses, world.snapshot().poses)
    assert np.array_equal(snapshot.twists, world.snapshot().twists)
    # The rest of a lifetime counts from here.
    assert snapshot.scene.bodies[0].expires == 10 * FRAME + 2400 - 24


def test_reset_returns_to_what_was_loaded_at_time_0():
    sim = simulation()
    periods(sim, 11)
    state = saved(WorldSettings(gravity=(0.0, -1.0))).save()
    sim.load(state)
    other = Simulation()
    other.load(state)
    first = other.world.digest()

    for _ in range(2):
        periods(sim, 7)
        sim.requests.submit(spawning('b/0'), topic='~/spawn')
        sim.perform(Configure(changes={'damping': 0.5, 'gravity': (1.0, 1.0)}))
        sim.reports_contacts = True
        message = sim.reset()

        assert message == 'back at the beginning, time 0'
        assert sim.world.step_count == 0
        assert sim.world.digest() == first
        assert sim.world.save() == state
        assert sim.world.reports_contacts


def full() -> WorldState:
    """Return a state with more bodies than it may have."""
    sim = simulation()
    for number in range(3):
        sim.perform(spawning(f'a/{number}', DISC, (3.0 * number, 0.0, 0.0)))
    state = sim.save()
    return replace(state, settings=replace(state.settings, max_bodies=1))


REFUSED: dict[str, Callable[[Simulation], object]] = {
    'reset': lambda sim: sim.reset(-1),
    'load': lambda sim: sim.load(full()),
    'load what is none': lambda sim: sim.load('demo'),  # type: ignore[arg-type]
    'begin': lambda sim: sim.begin(full()),
    'begin with what is none': lambda sim: sim.begin(None),  # type: ignore[arg-type]
    'restore': lambda sim: sim.restore(None),  # type: ignore[arg-type]
    'open_world': lambda sim: sim.open_world(full()),
    'undo': Simulation.undo,
    'redo': Simulation.redo,
    'return_to_course': lambda sim: sim.return_to_course(7),
    'seek': lambda sim: sim.seek(99 * SECOND),
    'place': lambda sim: sim.place('nobody/0', 0.0, 0.0),
    'limit_history': lambda sim: sim.limit_history(-1.0),
    'limit_memory': lambda sim: sim.limit_memory(-1.0),
}


@pytest.mark.parametrize('name', REFUSED)
def test_what_is_refused_ends_no_drive_no_drag_and_no_frame_that_is_due(name):
    sim = simulation(speed=0.0)
    sim.perform(spawning('b/0', DISC, (0.0, 0.0, 0.0)))
    sim.perform(Grab(hand='mouse', point=(0.0, 0.0)))
    # Now there is nothing to undo.
    sim.past.begin(sim.save())
    sim.applier.drives.commands['robot/0'] = DriveRobot(name='robot/0', velocity=(1.0, 0.0, 0.0))
    sim.playback.queue_frame()
    before = sim.step, sim.world.digest(), sim.status

    with pytest.raises(Refusal):
        REFUSED[name](sim)

    assert (sim.step, sim.world.digest(), sim.status) == before
    assert sim.applier.drives.commands
    assert 'mouse' in sim.applier.hands
    assert sim.playback.single_frames == 1


def timed() -> WorldState:
    """Return a state half way through a lifetime, a wrench, a path and commands of motors."""
    sim = Simulation(settings=replace(NOWHERE, command_timeout=2.0))
    sim.perform(spawning('lives/0', DISC, (0.0, 9.0, 0.0), lifetime=2.0))
    sim.perform(spawning('pushed/0', DISC))
    sim.perform(Command(names=('pushed/0',), wrenches=[(1.0, 0.0, 0.0)]))
    path = {'kind': 'path', 'points': [[0, -9], [2, -9]], 'times': [0, 2]}
    sim.perform(spawning('walks/0', DISC, (0.0, -9.0, 0.0), kinematic=True, actor=path))
    drive = {'kind': 'omni', 'latency': 0.5, 'timeout': 1.5}
    sim.perform(spawning('robot/0', DISC, (0.0, 5.0, 0.0), robot={'drive': drive}))
    sim.perform(DriveRobot(name='robot/0', velocity=(1.0, 0.0, 0.0)))
    motor = {'effort': 9.0, 'latency': 0.25}
    sim.perform(joining('axle', [(0.0, 0.0)], 'arm/0', a='pushed/0', b='world', **motor))
    for value in (1.0, 2.0):
        points = [[0.0, value]]
        command = {'joint': 'arm/0', 'mode': 'velocity', 'points': points}
        sim.perform(CommandMotors(commands=[command]))
        sim.run(0.2)
    sim.perform(DriveRobot(name='robot/0', velocity=(0.0, 1.0, 0.0)))
    sim.run(0.6)
    sim.perform(DriveRobot(name='robot/0', velocity=(0.0, -1.0, 0.0)))
    return sim.save()


@pytest.mark.parametrize('rate', [120.0, 240.0, 960.0])
def test_a_state_has_the_times_of_its_file_at_any_rate(rate):
    state = timed()
    read = state_from(load_mapping(text_of(state, 240.0), field='text'), state.settings, rate)

    other = state.at_rate(rate)

    for one, two in zip(other.bodies, read.bodies, strict=True):
        for name in ('wrench', 'wrench_steps', 'driven', 'coming', 'acting'):
            assert getattr(one, name) == getattr(two, name)
        assert one.body.expires == two.body.expires
    assert other.commands == read.commands
    for name in ('wrench_steps', 'driven', 'coming', 'acting'):
        assert any(getattr(each, name) for each in other.bodies)
    assert other.commands


@pytest.mark.parametrize('put', [Simulation.begin, Simulation.load, Simulation.open_world])
@pytest.mark.parametrize('rate', [120.0, 240.0, 960.0])
def test_times_of_a_state_are_those_of_a_world_with_another_rate(put, rate):
    state = timed()
    sim = Simulation(physics_rate=rate)

    put(sim, state)

    sim.run(0.9)
    assert 'lives/0' in sim.world
    sim.run(0.2)
    assert 'lives/0' not in sim.world
    snapshot = sim.frame.snapshot
    assert snapshot.poses[snapshot.row('walks/0')][0] == pytest.approx(2.0, abs=1e-6)


def test_reset_answers_those_that_wait_first():
    sim = simulation()
    sim.advance(0)
    sim.requests.submit(spawning('a/0'), topic='~/spawn')

    sim.reset()

    (frame,) = sim.advance(1)
    assert [answer.topic for answer in frame.answers] == ['~/spawn']
    assert frame.snapshot.scene.names == ()


def test_time_after_a_reset_begins_without_a_jump():
    sim = simulation()
    periods(sim, 601)

    sim.reset()
    frames = periods(sim, 4, since=10_000)

    assert [frame.snapshot.step for frame in frames] == [0, FRAME, 2 * FRAME, 3 * FRAME]
    assert sim.playback.clock.late_frames == 0


def test_contacts_come_where_somebody_watches():
    sim = simulation(settings=WorldSettings(bounds=(-5.0, 0.0, 5.0, 9.0)))
    sim.requests.submit(spawning('a/0', BOX, (0.0, 0.5, 0.0)), topic='~/spawn')
    assert {frame.contacts for frame in periods(sim, 30)} == {None}

    sim.reports_contacts = True
    frames = periods(sim, 30, since=30)

    told = [frame.contacts.pairs.tolist() for frame in frames if frame.contacts is not None]
    assert told == [[[0, -1]]] * len(frames)
    sim.reports_contacts = False
    assert {frame.contacts for frame in periods(sim, 3, since=60)} == {None}


@pytest.mark.parametrize('name', ['poses', 'twists', 'forces', 'pulls', 'robots', 'impulses'])
def test_nobody_changes_the_past_by_the_arrays_of_a_frame(name):
    sim = Simulation()
    sim.load(load_world(find_world('newtons_cradle')))
    sim.perform(robot_spawn('turtlebot3_burger', at=(50.0, 50.0)))
    sim.reports_contacts = True
    frames = [sim.advance_frame() for _ in range(60)]
    frame = next(each for each in frames if each.contacts is not None and len(each.contacts.pairs))
    array = getattr(frame.contacts if name == 'impulses' else frame.snapshot, name)
    assert len(array)

    with pytest.raises(ValueError, match='read-only'):
        array[0] = array[-1]


def test_a_lost_body_is_told_of():
    sim = simulation(settings=WorldSettings(gravity=(0.0, 0.0), command_timeout=0.0))
    sim.requests.submit(spawning('a/0', DISC, mass=1e-9), topic='~/spawn')
    sim.requests.submit(Command(names=('a/0',), wrenches=((1e12, 0.0, 0.0),)), topic='~/command')

    told = answers(periods(sim, 5))

    assert [(answer.topic, answer.subject, answer.code) for answer in told] == [
        ('~/spawn', 'a/0', ''),
        ('~/command', 'a/0', ''),
        ('body_lost', 'a/0', 'body_lost'),
    ]
    assert len(sim.world) == 0


@pytest.mark.filterwarnings('error')
def test_a_machine_of_extreme_sizes_stays_within_the_range_of_numbers():
    sim = simulation(settings=WorldSettings())
    triangle, needle = Polygon(outline=((0, 0), (1e4, 0), (0, 1e4))), Box(width=1e4, height=1e-3)
    for spawned in (
        spawning('a/0', triangle, (0.0, 1e7, 0.0), mass=1.0, velocity=(0.0, 7e4)),
        spawning('a/1', needle, (-2.0, 1e7, -0.14), velocity=(0.0, 7e4)),
        spawning('a/2', Box(width=1e-3, height=0.1), (-1.0, -1e7, 0.0), mass=1e-3),
    ):
        sim.requests.submit(spawned, topic='~/spawn')
    pin = joining('pin', [(-2.0, 1e7)], 'j/0', a='a/0', b='a/2')
    slider = joining('slider', [(0.0, 1e7), (0.001, 1e7)], 'j/1', a='a/0')
    for joined in (pin, slider):
        sim.requests.submit(joined, topic='~/join')

    told = answers(periods(sim, 40))

    assert {answer.code for answer in told} == {''}
    assert np.abs(sim.world.snapshot().twists).max() < 1e5


def test_a_frame_that_takes_too_long_ends_at_the_next_period_and_makes_the_same_steps():
    slow, fast = (Simulation(speed=64.0) for _ in range(2))
    for simulation in (slow, fast):
        simulation.requests.submit(spawning('a/0', DISC), topic='~/spawn')
    now = 0

    while slow.step < 256:
        now += round(1e9 / 60)
        frames = slow.advance(now, OVERDUE)
        assert [frame.snapshot.step % slow.frame_steps for frame in frames] == [0] * len(frames)
        assert len(frames) <= 1
    while fast.step < slow.step:
        fast.advance_frame()

    assert slow.step == fast.step == 256
    assert slow.world.digest() == fast.world.digest()


def test_speed_changes_nothing_but_when_frames_come():
    settings = WorldSettings(bounds=(-5.0, 0.0, 5.0, 9.0))
    digests = []
    for speed in (1.0, 2.0, 8.0, 0.5, 1.6):
        sim = simulation(speed, settings)
        for number in range(6):
            box = spawning(f'a/{number}', BOX, (0.2 * number, 0.6 + 1.1 * number, 0.1))
            sim.requests.submit(box, topic='~/spawn')
        command = Command(names=('a/5',), wrenches=((1.0, 2.0, 0.1),))
        sim.requests.submit(command, topic='~/command')
        calls = 0
        # Ticks come so often that a fractional speed makes no more than a step at a time.
        while sim.world.step_count < 32 * FRAME:
            sim.advance(round(calls * PERIOD / 8))
            calls += 1
        assert sim.world.step_count == 32 * FRAME
        assert calls == pytest.approx(8 * 32 / speed, abs=8)
        digests.append(sim.world.digest())

    assert len(set(digests)) == 1
