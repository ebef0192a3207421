# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A step that takes long is made in several calls, and where it is cut changes no bit."""

from collections.abc import Callable
import time

from physsim_ros.engine.core import lib
from physsim_ros.engine.core_world import CoreWorld
from physsim_ros.files import find_world, load_world, spawn_from
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.requests import Configure
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Frame
from physsim_ros.simulation.entries import Amend
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import beginning_of, World
import pytest
from tools.bench.scenes import FREE, MACHINES, Scene

from .driven import OVERDUE, SECOND
from ..building import DISC, spawn, spawning


def shipped(name: str) -> Scene:
    """Return the function that begins a shipped world."""
    return lambda simulation: simulation.begin(load_world(find_world(name)))


# Bodies, joints, robots and actors.
WORLDS = {name: shipped(name) for name in ('burger', 'line', 'people', 'soccer')}
SCENES = {**FREE, **MACHINES, **WORLDS}
# A call of the core makes one sub-step, as of a world where that takes long.
SUB_STEPS = 4 * lib.SUB_STEPS


@pytest.fixture
def in_sub_steps(monkeypatch: pytest.MonkeyPatch) -> Callable[[Scene], Simulation]:
    """Return a function that begins a scene whose calls of the core make a sub-step each."""

    def begun(scene: Scene) -> Simulation:
        with monkeypatch.context() as patch:
            patch.setattr(CoreWorld, 'longest_call', 0.0)
            simulation = Simulation(checkpoints=100.0)
            scene(simulation)
            simulation.checkpoint()
        return simulation

    return begun


def ticks_to_frames(simulation: Simulation, count: int, ticks: int) -> list[tuple[int, Frame]]:
    """Return frames with the tick of each, where each tick is overdue at once."""
    made = []
    for tick in range(ticks):
        frames = simulation.advance(tick * SECOND // 60, OVERDUE)
        made += [(tick, frame) for frame in frames]
        if len(made) == count:
            return made
    pytest.fail(f'{len(made)} frames in {ticks} ticks')


def whole(scene: Scene) -> Simulation:
    simulation = Simulation(checkpoints=100.0)
    scene(simulation)
    simulation.checkpoint()
    return simulation


@pytest.mark.parametrize('name', SCENES)
def test_a_step_that_is_cut_anywhere_has_the_same_bits(in_sub_steps, name):
    one, other = whole(SCENES[name]), in_sub_steps(SCENES[name])
    one.run(0.5)
    other.run(0.5)
    assert one.world.digest() == other.world.digest()


def test_a_frame_takes_as_many_ticks_as_it_has_sub_steps(in_sub_steps):
    simulation = in_sub_steps(FREE['stack of ten'])
    (first, _), (second, frame) = ticks_to_frames(simulation, 2, 100)[-2:]
    assert second - first >= SUB_STEPS - 1
    assert frame.snapshot.step % simulation.frame_steps == 0


def test_contacts_are_reported_of_whole_steps(in_sub_steps):
    def impulses(asked_after: int) -> list[list[float]]:
        """Return those of two steps, of which reports are asked for after a sub-step."""
        world = in_sub_steps(FREE['stack of ten']).world
        for number, _ in enumerate(world.slices_of_steps(2), 1):
            world.reports_contacts = number >= asked_after
        return world.contacts(world.snapshot()).impulses.tolist()

    assert impulses(1) == impulses(lib.SUB_STEPS) != []


def calls_of_a_step(longest: float, monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Return the durations of the calls that make a step of a crowd, each to end in a time [s]."""
    with monkeypatch.context() as patch:
        patch.setattr(CoreWorld, 'longest_call', longest)
        world = World()
    for number in range(500):
        spawn(world, f'disc/{number}', DISC, (number % 50, number // 50, 0.0), velocity=(1.0, 0.0))
    world.step(4)
    took, slices, done = [], world.slices_of_steps(1), object()
    while True:
        began = time.perf_counter()
        is_done = next(slices, done) is done
        took.append(time.perf_counter() - began)
        if is_done:
            return took


@pytest.mark.slow
def test_a_call_of_the_core_begins_no_sub_step_that_would_end_too_late(monkeypatch):
    def are_single() -> bool:
        sub_step = min(calls_of_a_step(0.0, monkeypatch))
        # One sub-step ends in that time, and two do not.
        return len(calls_of_a_step(1.4 * sub_step, monkeypatch)) == lib.SUB_STEPS

    # A busy machine delays some calls: the test is slow, since it measures time.
    assert sum(are_single() for _ in range(9)) > 4


def test_what_reads_the_world_meanwhile_finds_whole_steps(in_sub_steps):
    one, other = whole(FREE['stack of ten']), in_sub_steps(FREE['stack of ten'])
    one.run(1 / 60)
    other.advance(0, OVERDUE)
    other.advance(SECOND // 60, OVERDUE)
    assert other.past.cursor.is_working
    assert other.world.digest() == one.world.digest()
    assert not other.past.cursor.is_working


def test_requests_wait_for_the_end_of_the_frame(in_sub_steps):
    simulation = in_sub_steps(FREE['stack of ten'])
    simulation.advance(0, OVERDUE)
    simulation.advance(SECOND // 60, OVERDUE)
    assert simulation.past.cursor.is_working
    simulation.requests.submit(spawning('late/0', DISC, (9.0, 1.0, 0.0)), topic='~/spawn')
    simulation.applier.apply_ready()
    assert 'late/0' not in simulation.world
    frames = [frame for _, frame in ticks_to_frames(simulation, 3, 200)]
    assert 'late/0' in frames[-1].snapshot.scene.names


def test_the_log_of_a_world_that_was_cut_replays_to_the_same_bits(in_sub_steps):
    simulation = in_sub_steps(FREE['ten fall and roll'])
    for tick in range(400):
        simulation.advance(tick * SECOND // 60, OVERDUE)
        if tick % 37 == 0:
            change = Configure(changes={'gravity': (0.1 * (tick % 5), -9.81)})
            simulation.requests.submit(change, topic='~/gravity')
    step, digest = simulation.step, simulation.world.digest()
    step = simulation.step
    simulation.past.frames.drop_from(0)
    simulation.seek(SECOND // 10)
    simulation.world.digest()
    simulation.seek(round(step * SECOND / 240))
    assert simulation.world.digest() == digest
    assert 'divergence' not in [answer.code for answer in simulation.frame.answers]


def test_a_seek_in_the_middle_of_a_step_goes_to_its_goal(in_sub_steps):
    simulation, other = in_sub_steps(FREE['stack of ten']), whole(FREE['stack of ten'])
    simulation.run(0.5)
    at_half, step = simulation.world.digest(), simulation.step
    for tick in range(3):
        simulation.advance(tick * SECOND // 60, OVERDUE)
    assert simulation.past.cursor.is_working
    simulation.past.frames.drop_from(0)
    simulation.speed = 0.0
    simulation.playback.seek(round(step * SECOND / 240))
    assert simulation.world.digest() == at_half
    other.run(0.5)
    assert other.world.digest() == at_half


def test_an_amendment_is_cut_within_the_steps_that_it_makes_again(monkeypatch):
    monkeypatch.setattr(CoreWorld, 'longest_call', 0.0)
    simulation = Simulation(speed=0.0)
    gesture = simulation.requests.begin_gesture()
    simulation.perform(spawning('a/0', DISC, (0.0, 9.0, 0.0)), gesture)
    simulation.run(0.5)
    simulation.requests.submit(Amend((gesture,), (spawning('b/0', DISC, (0.0, 9.0, 0.0)),)))
    ((tick, frame),) = ticks_to_frames(simulation, 1, 2000)
    assert frame.snapshot.step == simulation.step == 120
    assert frame.snapshot.scene.names == ('b/0',)
    assert tick >= 120 * lib.SUB_STEPS


def reset(simulation: Simulation) -> None:
    simulation.reset(ahead=beginning_of(simulation.loaded, simulation.physics_rate))


def open_empty(simulation: Simulation) -> None:
    empty = WorldState(settings=WorldSettings())
    simulation.open_world(beginning_of(empty, simulation.physics_rate))


@pytest.mark.parametrize('begin', [reset, open_empty])
def test_undo_returns_to_the_last_step_before_a_world_that_began_within_a_frame(
    in_sub_steps, begin
):
    simulation = in_sub_steps(FREE['stack of ten'])
    simulation.run(0.5)
    for tick in range(3):
        simulation.advance(tick * SECOND // 60, OVERDUE)
    shown = simulation.step
    assert simulation.past.cursor.is_working

    begin(simulation)
    simulation.undo()

    assert simulation.step == shown


@pytest.mark.parametrize('kind', ['social_force', 'orca'])
def test_a_step_of_a_crowd_is_cut_between_pedestrians(in_sub_steps, kind):
    def scene(simulation: Simulation) -> None:
        for number in range(20):
            actor = {'kind': kind, 'points': [[5.0, 5.0]]}
            entry = {'name': f'a/{number}', 'circle': {'radius': 0.2}, 'actor': actor}
            simulation.perform(spawn_from(entry | {'at': [0.5 * number, 0.0]}))

    world = in_sub_steps(scene).world
    # The last wish, and the first sub-step, end no call of their own.
    assert sum(1 for _ in world.slices_of_steps(1)) == 20 + lib.SUB_STEPS - 1
    other = whole(scene).world
    other.step(1)
    assert world.digest() == other.digest()
