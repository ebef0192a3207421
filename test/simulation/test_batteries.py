# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Batteries of robots: what drains and charges them, and that an empty one stops its robot."""

from physsim_ros import Box, Robot, Simulation
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.requests import DriveRobot, MoveBodies
from physsim_ros.model.robots import Robot as Description
from physsim_ros.simulation.world import World
import pytest

from .driven import body_request, put, seen_from_above
from ..building import spawning

# Empty after 18 s at rest, and after 4.5 s of motion.
BATTERY = {'capacity': 0.005, 'idle': 1.0, 'moving': 3.0, 'charging': 9.0, 'docks': ['dock/0']}


def powered_world(**battery: object) -> World:
    """Return a world with a robot a/0 that has a battery, and a dock 3 m ahead of it."""
    world = seen_from_above()
    dock = spawning(
        'dock/0', Box(width=1.0, height=1.0), (3.0, 0.0, 0.0), anchored=True, sensor=True
    )
    world.apply(dock)
    drive = {'kind': 'differential', 'timeout': 0, 'max_speed': 1.0, 'acceleration': 100.0}
    put(world, 'a/0', robot={'drive': drive, 'battery': {**BATTERY, **battery}})
    return world


def drawn(world: World) -> float:
    """Return the charge drawn from the battery [A s]."""
    return float(world.snapshot().robots['drawn'][0])


def command(world: World, speed: float) -> None:
    world.apply(DriveRobot(name='a/0', velocity=(speed, 0.0, 0.0)))


def test_a_battery_gives_its_idle_current_and_another_while_wheels_turn():
    world = powered_world()
    world.step(240)
    assert drawn(world) == pytest.approx(1.0, abs=1e-9)
    command(world, 0.1)
    world.step(240)
    assert drawn(world) == pytest.approx(1.0 + 4.0, abs=1e-9)


def test_a_robot_stops_where_its_battery_is_empty_and_obeys_no_command():
    world = powered_world()
    command(world, 0.1)
    world.step(round(4.5 * 240) - 5)
    assert world.snapshot().twists[1, 0] == pytest.approx(0.1)
    world.step(240)
    assert drawn(world) == 18.0
    assert world.snapshot().poses[1, 0] == pytest.approx(0.45, abs=0.005)
    command(world, 0.1)
    world.step(60)
    assert not world.snapshot().twists[1].any()


def test_a_dock_charges_an_empty_battery_until_it_is_full_and_the_robot_drives_again():
    world = powered_world(level=0.0)
    command(world, 0.1)
    world.step(240)
    assert world.snapshot().poses[1, 0] == 0.0
    world.apply(MoveBodies(names=('a/0',), by=(3.0, 0.0)))
    world.step(240)
    assert drawn(world) == pytest.approx(-(9.0 - 1.0), abs=1e-6)
    world.step(480)
    # Full: 0.005 A h.
    assert drawn(world) == -18.0
    command(world, -0.5)
    world.step(480)
    assert world.snapshot().poses[1, 0] == pytest.approx(2.0, abs=0.02)
    assert drawn(world) > -18.0


def test_a_program_reads_the_state_of_a_battery():
    simulation = Simulation()
    simulation.begin(powered_world(level=0.5).save())
    robot = Robot(simulation, 'a/0')
    assert robot.battery() == (0.5, -1.0, False)
    robot.drive(0.1)
    simulation.run(1.0)
    level, current, is_docked = robot.battery()
    assert (current, is_docked) == (-4.0, False)
    assert level == pytest.approx(0.5 - 4.0 / 18.0, abs=1e-3)
    robot.drive(0.0)
    robot.place(3.0, 0.0)
    simulation.run(3.0)
    assert robot.battery() == (1.0, 0.0, True)
    robot.place(0.0, 0.0)
    simulation.run(18.5)
    assert robot.battery() == (0.0, 0.0, False)

    simulation.perform(body_request('b/0', robot={'drive': {'kind': 'omni'}}))
    assert Robot(simulation, 'b/0').battery() is None


def test_a_dock_that_is_not_there_charges_nothing():
    world = powered_world(docks=['nowhere/0', 'a/0'])
    world.step(240)
    assert drawn(world) == pytest.approx(1.0, abs=1e-9)


def test_a_battery_without_a_drive_and_a_second_topic_of_its_name_are_refused():
    with pytest.raises(BadProperty, match='drive'):
        Description.from_mapping({'battery': {}})
    sensor = {'kind': 'imu', 'name': 'battery_state'}
    robot = {'drive': {'kind': 'omni'}, 'sensors': [sensor]}
    Description.from_mapping(robot)
    with pytest.raises(BadProperty, match='two topics'):
        Description.from_mapping({**robot, 'battery': {}})
