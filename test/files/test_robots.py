# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Shipped robots, by name and with changes."""

from physsim_ros.files import shipped_robots, spawn_from, with_shipped_robot
from physsim_ros.model.errors import BadProperty, UnknownProperty
from physsim_ros.model.robots import Robot
from physsim_ros.model.shapes import Box, Disc
import pytest


def test_the_shipped_robots_are_those_that_the_interface_names():
    assert shipped_robots() == ('car', 'mouse', 'omni', 'turtlebot3_burger', 'turtlebot4')


@pytest.mark.parametrize('name', shipped_robots())
def test_a_shipped_robot_is_a_body_by_its_name_alone(name):
    spawn = spawn_from({'name': 'robot/0', 'robot': name})

    assert spawn.properties.robot == Robot.from_mapping(spawn.properties.robot.entry())
    assert spawn.properties.mass > 0.0
    assert spawn.color is not None


def test_a_body_keeps_what_it_says_itself():
    spawn = spawn_from(
        {
            'name': 'tb3/0',
            'box': {'width': 1, 'height': 1},
            'density': 2.0,
            'robot': {'from': 'turtlebot3_burger', 'drive': {'max_speed': 1}, 'sensors': []},
        }
    )

    assert spawn.shape == Box(width=1.0, height=1.0)
    assert (spawn.properties.mass, spawn.properties.density) == (None, 2.0)
    assert spawn.properties.robot.drive.max_speed == 1.0
    assert spawn.properties.robot.drive.track == 0.16
    assert spawn.properties.robot.sensors == ()


def test_a_sensor_is_changed_by_its_name():
    changes = {'scan': {'beams': 90, 'noise': 0}, 'imu': {'name': 'imu/data'}}
    entry = {'robot': {'from': 'turtlebot3_burger', 'sensors': changes}}
    shipped = Robot.from_mapping(with_shipped_robot({'robot': 'turtlebot3_burger'}, [])['robot'])

    laser, imu, wheels = Robot.from_mapping(with_shipped_robot(entry, [])['robot']).sensors

    assert (laser.beams, laser.noise, laser.range) == (90, 0.0, shipped.sensors[0].range)
    assert (imu.name, imu.rate) == ('imu/data', shipped.sensors[1].rate)
    assert wheels == shipped.sensors[2]


def test_a_drive_of_another_kind_keeps_nothing_of_the_shipped_one():
    entry = {'robot': {'from': 'car', 'drive': {'kind': 'omni'}}}

    robot = Robot.from_mapping(with_shipped_robot(entry, [])['robot'])

    assert robot.drive.entry() == Robot.from_mapping({'drive': {'kind': 'omni'}}).drive.entry()


def test_a_body_without_a_shape_of_its_own_has_that_of_the_robot():
    assert spawn_from({'name': 'tb3/0', 'robot': 'turtlebot3_burger'}).shape == Disc(radius=0.105)


@pytest.mark.parametrize(
    ('robot', 'refusal', 'field'),
    [
        ('turtlebot3_burgr', BadProperty, 'robot'),
        ('../worlds/demo', BadProperty, 'robot'),
        ({'from': 3}, BadProperty, 'from'),
        ({'from': 'car', 'drv': {}}, UnknownProperty, 'drv'),
        ({'from': 'car', 'drive': {'speed': 1}}, UnknownProperty, 'speed'),
        ({'from': 'turtlebot4', 'sensors': {'scn': {'beams': 9}}}, BadProperty, 'sensors'),
        ({'from': 'turtlebot4', 'sensors': {'scan': 9}}, BadProperty, 'sensors'),
        ({'from': 'turtlebot4', 'sensors': {'scan': {'beam': 9}}}, UnknownProperty, 'beam'),
        ({'drive': {'kind': 'omni'}, 'sensors': {'scan': {}}}, BadProperty, 'sensors'),
        (['car'], BadProperty, 'robot'),
    ],
)
def test_what_is_no_robot_is_refused(robot, refusal, field):
    with pytest.raises(refusal) as caught:
        spawn_from({'name': 'a/0', 'circle': {'radius': 1}, 'robot': robot})

    assert caught.value.field == field


def test_the_nearest_robot_is_named():
    with pytest.raises(BadProperty, match="nearest is 'turtlebot3_burger'"):
        with_shipped_robot({'robot': 'turtlebot_burger'}, [])
