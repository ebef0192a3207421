# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Encoders: wheels turn as far as the way of their rims by their radius."""

import math

from physsim_ros import robot_spawn
from physsim_ros.model.requests import DriveRobot, Unjoin
from physsim_ros.model.shapes import Disc
from physsim_ros.sensing.motion import read_wheels
import pytest

from .worlds import add_robot, plane
from ..building import command, join, spawn

DRIVE = {
    'kind': 'differential',
    'track': 0.16,
    'wheel_radius': 0.03,
    'max_turn': 3.0,
    'timeout': 0.0,
}


def drive(world, *velocity, name='robot/0', seconds=4.0):
    world.apply(DriveRobot(name=name, velocity=velocity))
    world.step(round(seconds * 240))


def robot(world, name='robot/0', pose=(0.0, 0.0, 0.0), **changes):
    return add_robot(world, name, pose, mass=1.0, robot={'drive': DRIVE | changes})


def test_straight_on_both_wheels_roll_the_way_by_their_radius():
    world = plane()
    row = robot(world)

    drive(world, 0.3, 0.0, 0.0)

    wheels = read_wheels(world.snapshot(), row)
    way = world.snapshot().poses[row, 0]
    assert wheels.names == ('wheel_left_joint', 'wheel_right_joint')
    assert way > 1.0
    assert wheels.positions.tolist() == pytest.approx([way / 0.03] * 2, rel=1e-3)
    assert wheels.velocities.tolist() == pytest.approx([10.0, 10.0])


def test_in_place_the_left_wheel_turns_back():
    world = plane()
    # Another one, before it in the scene.
    robot(world, 'other/0', (3.0, 3.0, 0.0))
    row = robot(world)

    drive(world, 0.0, 0.0, 1.5)

    wheels = read_wheels(world.snapshot(), row)
    turned = world.snapshot().poses[row, 2]
    assert turned > 5.0
    assert wheels.positions.tolist() == pytest.approx(
        [-turned * 0.08 / 0.03, turned * 0.08 / 0.03], rel=1e-3
    )
    assert wheels.velocities.tolist() == pytest.approx([-4.0, 4.0])


def test_an_omni_has_three_wheels():
    world = plane()
    row = robot(world, kind='omni')

    drive(world, 0.0, 0.3, 0.0)

    wheels = read_wheels(world.snapshot(), row)
    first, second, third = wheels.velocities.tolist()
    assert first == pytest.approx(third)
    assert second == pytest.approx(-10.0)
    assert first + third == pytest.approx(10.0)
    assert math.isclose(sum(wheels.positions), 0.0, abs_tol=1e-9)


@pytest.mark.parametrize('first', ['robot/0', 'wheel/0'])
def test_a_wheel_on_an_axle_is_read_against_the_robot_whichever_of_the_two_is_named_first(first):
    world = plane()
    # Another body, after them in the scene.
    row = robot(world, pose=(1.0, 2.0, 0.5))
    spawn(world, 'wheel/0', Disc(radius=0.05), (1.0, 2.0, -0.7), mass=0.1)
    spawn(world, 'other/0', Disc(radius=0.05), (3.0, 2.0, 2.0), spin=3.0)
    second = {'robot/0': 'wheel/0', 'wheel/0': 'robot/0'}[first]
    join(world, 'axle', [(1.0, 2.0)], a=first, b=second)
    command(world, 'wheel/0', twist=(0.0, 0.0, 4.0))

    world.step(60)

    wheels, seen = read_wheels(world.snapshot(), row), world.snapshot()
    wheel = seen.scene.names.index('wheel/0')
    turned, rate = seen.poses[wheel, 2] - seen.poses[row, 2], seen.twists[wheel] - seen.twists[row]
    assert wheels.names[-1] == 'joint_0'
    assert turned > -0.3
    assert wheels.positions[-1] == pytest.approx(turned)
    assert wheels.velocities[-1] == pytest.approx(rate[2])


def test_joints_of_the_robot_itself_are_read_while_they_are_there():
    world = plane()
    world.apply(robot_spawn('arm', name='arm/0'))
    row = world.scene.names.index('arm/0')
    assert read_wheels(world.snapshot(), row).names == ('shoulder', 'elbow')

    world.apply(Unjoin(name='arm/0/elbow/0'))

    assert read_wheels(world.snapshot(), row).names == ('shoulder',)
