# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Commands on their way to a drive: when they arrive, and what is kept of them."""

import numpy as np
from physsim_ros.model.errors import BadProperty, Malformed
from physsim_ros.model.requests import ChangeBody, Configure, Delete, DriveRobot, Restore
from physsim_ros.model.robots import Robot
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import World
import pytest

from .driven import body_request, changing, put, refusal_of_file, seen_from_above, twins


def driven_world(**drive: object) -> World:
    """Return a world with the robot a/0, which has a latency of 0.1 s unless another is said."""
    world = seen_from_above()
    put(world, 'a/0', robot={'drive': {'kind': 'differential', 'latency': 0.1, **drive}})
    return world


def command(world: World, speed: float, **said: float) -> None:
    """Have a/0 drive ahead [m/s]."""
    world.apply(DriveRobot(name='a/0', velocity=(speed, 0.0, 0.0), **said))


def arrivals(world: World, steps: int) -> list[int]:
    """Return the steps from now on after which the aim of a/0 was another one."""
    seen, before = [], world.snapshot().robots['aim'][0, 0]
    for step in range(steps):
        world.step(1)
        now = world.snapshot().robots['aim'][0, 0]
        if now != before:
            seen.append(step)
        before = now
    return seen


def test_a_command_acts_after_the_latency_as_it_would_have_at_once():
    late, prompt = driven_world(), driven_world(latency=0)
    command(late, 0.4)
    prompt.step(24)
    command(prompt, 0.4)
    late.step(24 + 60)
    prompt.step(60)
    assert np.array_equal(late.snapshot().poses, prompt.snapshot().poses)
    assert late.snapshot().poses[0, 0] > 0.05

    # The timeout counts from the arrival: 0.5 s.
    assert arrivals(late, 120) == [60]


def test_commands_arrive_one_by_one_in_their_order():
    world = driven_world(latency=[0.0, 0.2])
    speeds = np.linspace(0.1, 0.4, 40)
    seen = []
    for speed in speeds:
        command(world, speed, timeout=0.0)
        world.step(3)
        seen.append(world.snapshot().robots['aim'][0, 0])
    world.step(60)
    assert world.snapshot().robots['aim'][0, 0] == speeds[-1]
    # Some are replaced by a later one that arrives with them.
    assert all(np.diff(seen) >= 0.0)
    assert 5 < len(set(seen)) < 40


def test_latency_is_drawn_evenly_by_seed_and_step():
    def delays(seed: int) -> list[int]:
        world = driven_world(latency=[0.05, 0.15], max_speed=1.0)
        world.apply(Configure(changes={'seed': seed}))
        found = []
        for number in range(40):
            command(world, 0.1 + 0.02 * number, timeout=0.0)
            found += arrivals(world, 40)
        return found

    found = delays(0)
    assert len(found) == 40
    assert min(found) >= 12
    assert max(found) <= 36
    assert np.mean(found) == pytest.approx(24.0, abs=4.0)
    assert delays(0) == found
    assert delays(1) != found


def test_a_drive_looks_for_commands_at_its_rate():
    world = driven_world(latency=0, command_rate=10.0)
    for number in range(200):
        command(world, 0.1 + 0.001 * number, timeout=0.0)
        world.step(1)
    # Of 200 commands in as many steps of 240 Hz, one is seen in 24 of them.
    command(world, 0.0, timeout=0.0)
    assert arrivals(world, 60) == [16]


def test_commands_on_their_way_are_saved_and_loaded_to_the_bit(tmp_path):
    world = driven_world(latency=[0.1, 0.3])
    for speed in (0.1, 0.2, 0.3):
        command(world, speed)
        world.step(5)
    assert world.save().bodies[0].coming
    one, other = twins(world, tmp_path)
    later = seen_from_above()
    later.step(100)
    later.apply(Restore(state=world.save()))
    for _ in range(4):
        for each in (one, other, later):
            each.step(30)
        assert one.digest() == other.digest()
        assert np.array_equal(one.snapshot().poses, later.snapshot().poses)


def test_a_command_on_its_way_is_in_the_digest():
    one, other = driven_world(), driven_world()
    assert one.digest() == other.digest()
    command(one, 0.2)
    assert one.digest() != other.digest()
    command(other, 0.3)
    assert one.digest() != other.digest()


def test_a_rewind_repeats_commands_on_their_way():
    simulation = Simulation(checkpoints=0.1)
    simulation.perform(
        body_request('a/0', robot={'drive': {'kind': 'differential', 'latency': [0.05, 0.25]}})
    )
    for speed in np.linspace(0.1, 0.4, 12):
        simulation.perform(DriveRobot(name='a/0', velocity=(speed, 0.0, 0.0)))
        simulation.run(1 / 15)
    end, digest = simulation.stamp, simulation.world.digest()
    simulation.seek(300_000_000)
    assert simulation.world.digest() != digest
    simulation.seek(end)
    assert simulation.world.digest() == digest

    # A moment continues elsewhere, too.
    moment = simulation.checkpoint()
    other = Simulation()
    other.restore(moment)
    for each in (simulation, other):
        each.run(0.5)
    assert simulation.world.digest() == other.world.digest()


def test_a_robot_that_is_changed_keeps_what_is_on_its_way_and_others_lose_it():
    world = driven_world()
    command(world, 0.3)
    world.apply(changing('a/0', density=2.0))
    assert world.save().bodies[0].coming
    world.apply(ChangeBody(name='a/0', unset=('robot',)))
    assert not world.save().bodies[0].coming
    world.step(60)

    world = driven_world()
    command(world, 0.3)
    world.apply(Delete(name='a/0'))
    put(world, 'a/0', robot={'drive': {'kind': 'differential'}})
    world.step(60)
    assert world.snapshot().poses[0, 0] == 0.0


@pytest.mark.parametrize(
    ('said', 'refusal'),
    [
        ({'latency': -0.1}, BadProperty),
        ({'latency': [0.2, 0.1]}, BadProperty),
        ({'latency': 6.0}, BadProperty),
        ({'latency': [0.1]}, Malformed),
        ({'latency': float('nan')}, Malformed),
        ({'latency': 'soon'}, BadProperty),
        ({'command_rate': -1.0}, BadProperty),
    ],
)
def test_a_latency_that_cannot_be_is_refused(said, refusal):
    with pytest.raises(refusal) as refused:
        Robot.from_mapping({'drive': {'kind': 'differential', **said}})
    assert refused.value.field in said


@pytest.mark.parametrize(
    ('coming', 'code'),
    [
        ('{aim: [0, 0, 0]}', 'bad_property'),
        ('{begins: -1}', 'bad_property'),
        ('{begins: .inf}', 'malformed'),
        ('{begins: 0.2}, {begins: 0.1}', 'bad_property'),
        ('{begins: 0.1, aim: [1, 0]}', 'malformed'),
    ],
)
def test_a_file_with_commands_that_cannot_be_is_refused(tmp_path, coming, code):
    robot = f'robot: {{drive: {{kind: omni}}}}, driven: {{coming: [{coming}]}}'
    refusal = refusal_of_file(tmp_path, f'{{name: a/0, circle: {{radius: 0.1}}, {robot}}}')
    assert refusal.cause == code
