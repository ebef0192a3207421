# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Commands on their way to a drive: when they arrive, and what is kept of them."""

import numpy as np
from physsim_ros.files import robot_spawn
from physsim_ros.model.errors import UnknownProperty
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.motor_command import MotorCommand, TimedCommand
from physsim_ros.model.requests import (
    ChangeBody,
    CommandMotors,
    Configure,
    Delete,
    DriveRobot,
    Unjoin,
)
from physsim_ros.simulation.world import World
import pytest

from .driven import changing, put, seen_from_above


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


def test_of_commands_that_begin_at_one_step_the_last_one_is_kept():
    world = driven_world()
    for speed in (0.4, 0.5):
        command(world, speed)
    (coming,) = world.save().bodies[0].coming
    assert coming.aim[0] == 0.5


def test_a_command_on_its_way_is_in_the_digest():
    one, other = driven_world(), driven_world()
    assert one.digest() == other.digest()
    command(one, 0.2)
    assert one.digest() != other.digest()
    command(other, 0.3)
    assert one.digest() != other.digest()


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


SHOULDER = 'arm/0/shoulder/0'


def armed_world(**motor: object) -> World:
    """Return a world with an arm whose motor has a latency of 0.1 s unless another is said."""
    link = {'name': 'upper', 'box': {'width': 0.4, 'height': 0.05}, 'at': [0.2, 0.0]}
    shoulder = {'name': 'shoulder', 'kind': 'axle', 'a': 'upper', 'points': [[0.0, 0.0]]}
    shoulder |= {'effort': 20.0, 'max_speed': 4.0, 'latency': 0.1, **motor}
    world = seen_from_above()
    arm = {'from': 'arm', 'links': [link], 'joints': [shoulder], 'sensors': []}
    world.apply(robot_spawn(arm, name='arm/0'))
    return world


def bend(world: World, *points: tuple[float, ...], mode: str = 'position') -> None:
    """Command the shoulder."""
    motor = {'joint': SHOULDER, 'mode': mode, 'points': points}
    world.apply(CommandMotors(commands=(motor,)))


@pytest.mark.parametrize(
    'points', [((0.0, 1.0),), ((0.2, 0.5), (0.4, -0.5)), ((0.2, 0.5, 0.0), (0.4, -0.5, 0.0))]
)
def test_a_motor_obeys_after_the_latency_as_it_would_have_at_once(points):
    late, prompt = armed_world(), armed_world()
    for world in (late, prompt):
        bend(world, (0.0, 0.3), mode='velocity')
    late.step(24)
    bend(late, *points)
    late.step(24 + 120)
    prompt.step(48)
    prompt.space.commands.command_motor(TimedCommand(motor_command(points), 48), 48)
    prompt.step(120)
    # A path begins where the joint is when the command arrives.
    assert np.array_equal(late.snapshot().poses[:, 2], prompt.snapshot().poses[:, 2])
    assert abs(late.snapshot().poses[1, 2]) > 0.3


def motor_command(points: tuple[tuple[float, ...], ...]) -> MotorCommand:
    return MotorCommand(joint=SHOULDER, mode='position', points=points)


def test_a_motor_looks_for_commands_at_its_rate():
    world = armed_world(latency=0.0, command_rate=10.0)
    obeyed = []
    for number in range(200):
        bend(world, (0.0, 0.001 * number), mode='velocity')
        world.step(1)
        obeyed += [command.begun for command in world.save().commands[:1]]
    assert sorted(set(obeyed)) == [*range(-24, 0)]


def test_a_command_on_its_way_is_dropped_with_its_joint():
    world = armed_world()
    bend(world, (0.0, 1.0))
    assert world.save().commands
    world.apply(Unjoin(name=SHOULDER))
    assert not world.save().commands
    world.step(60)


def test_a_pin_has_no_latency():
    with pytest.raises(UnknownProperty):
        JointProperties(latency=(0.1, 0.1)).check_kind(JointKind.PIN)
