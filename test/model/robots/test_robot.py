# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Robots as values: what a mapping makes, and what is refused."""

import math

from physsim_ros.model.errors import BadProperty, Malformed, UnknownProperty
from physsim_ros.model.robots import Car, Differential, Odometry, Omni, Robot
import pytest

from ...building import refusal

DRIVE = {'kind': 'differential', 'track': 0.16, 'max_speed': 0.22, 'max_turn': 2.84}


@pytest.mark.parametrize('kind', ['differential', 'omni', 'car'])
def test_a_robot_is_made_again_from_its_entry(kind):
    said = {
        'namespace': '/fleet/tb3',
        'drive': {'kind': kind, 'track': 0.3, 'timeout': 1},
        'odometry': {'rate': 10, 'slip': [0.01, 0.02]},
        'sensors': [{'kind': 'laser', 'beams': 90}, {'kind': 'bumper'}],
    }

    robot = Robot.from_value(said, 'robot')

    assert Robot.from_mapping(robot.entry()) == robot
    assert robot.namespace == 'fleet/tb3'
    assert [sensor.name for sensor in robot.sensors] == ['scan', 'bumper']
    assert robot.odometry == Odometry(rate=10.0, slip=(0.01, 0.02))


def test_its_namespace_is_by_the_name_of_its_body_unless_it_says_one():
    assert Robot.from_mapping({'drive': DRIVE}).namespace_of('tb3/0') == 'tb3_0'
    assert Robot.from_mapping({'drive': DRIVE, 'namespace': ''}).namespace_of('tb3/0') == ''


@pytest.mark.parametrize(
    ('said', 'error', 'field'),
    [
        ('turtlebot3_burger', BadProperty, 'robot'),
        ({'drive': None}, BadProperty, 'drive'),
        ({'drive': 'omni'}, BadProperty, 'drive'),
        ({'drive': {}}, BadProperty, 'kind'),
        ({'drive': {'kind': 'legs'}}, BadProperty, 'kind'),
        ({'drive': {'kind': ['omni']}}, BadProperty, 'kind'),
        ({'drive': {'kind': 'omni', 'steering': 0.5}}, UnknownProperty, 'steering'),
        ({'drive': {**DRIVE, 'trak': 0.1}}, UnknownProperty, 'trak'),
        ({'drive': {**DRIVE, 'max_speed': math.nan}}, Malformed, 'max_speed'),
        ({'drive': DRIVE, 'odometry': 3}, BadProperty, 'odometry'),
        ({'drive': DRIVE, 'odometry': {'slip': 0.1}}, BadProperty, 'slip'),
        ({'drive': DRIVE, 'odometry': {'slip': [0.1]}}, Malformed, 'slip'),
        ({'drive': DRIVE, 'odometry': {'slip': [0.1, -0.1]}}, BadProperty, 'slip'),
        ({'drive': DRIVE, 'odometry': {'rates': 30}}, UnknownProperty, 'rates'),
        ({'drive': DRIVE, 'sensor': []}, UnknownProperty, 'sensor'),
        ({'drive': DRIVE, 'sensors': 'laser'}, BadProperty, 'sensors'),
        ({'drive': DRIVE, 'sensors': ['laser']}, BadProperty, 'sensors'),
        ({'drive': DRIVE, 'sensors': [{'kind': 'imu'}] * 65}, BadProperty, 'sensors'),
        ({'drive': DRIVE, 'sensors': [{'kind': 'imu'}] * 2}, BadProperty, 'sensors'),
        ({'drive': DRIVE, 'sensors': [{'kind': 'imu', 'name': 'odom'}]}, BadProperty, 'sensors'),
        ({'drive': DRIVE, 'namespace': 7}, BadProperty, 'namespace'),
        ({'drive': DRIVE, 'namespace': '7up'}, BadProperty, 'namespace'),
        ({'drive': DRIVE, 'namespace': 'a//b'}, BadProperty, 'namespace'),
        ({'drive': DRIVE, 'namespace': 'a' * 200}, BadProperty, 'namespace'),
    ],
)
def test_a_mapping_that_is_no_robot_is_refused_by_the_name_of_the_field(said, error, field):
    assert refusal(Robot.from_value, said, 'robot') == (error, field)


@pytest.mark.parametrize(
    ('drive', 'command', 'aim'),
    [
        (Differential(max_speed=0.2, max_turn=1.0), (1.0, 0.5, -3.0), (0.2, 0.0, -1.0)),
        (Omni(max_speed=1.0, max_turn=1.0), (3.0, 4.0, 0.5), (0.6, 0.8, 0.5)),
        (Car(max_speed=1.0, max_turn=9.0), (0.0, 0.0, 1.0), (0.0, 0.0, 0.0)),
        (
            Car(max_speed=1.0, max_turn=9.0, wheelbase=0.5, steering=math.atan(0.5)),
            (-2.0, 0.0, 3.0),
            (-1.0, 0.0, 1.0),
        ),
    ],
)
def test_a_drive_aims_at_the_nearest_velocity_that_it_can_have(drive, command, aim):
    assert drive.aim(command) == pytest.approx(aim, abs=1e-12)


@pytest.mark.parametrize('drive', [Differential(track=0.4), Omni(track=0.4), Car(track=0.4)])
def test_wheels_do_not_slip_where_they_stand(drive):
    turn = {name: factors[2] for name, factors in drive.wheels.items()}

    # A turn in place moves each rim by the distance of its wheel from the middle.
    assert {abs(each) for each in turn.values()} == {0.2}


@pytest.mark.parametrize('topic', ['odom', 'base_link', '', '/drive', 'a b', 7])
def test_commands_have_no_topic_that_is_taken_or_that_ros_does_not_allow(topic):
    with pytest.raises(BadProperty):
        Robot.from_mapping({'drive': DRIVE, 'command_topic': topic})
    free = Robot.from_mapping(
        {
            'drive': DRIVE,
            'command_topic': 'drive',
            'sensors': [{'kind': 'imu', 'name': 'cmd_vel'}],
        }
    )
    assert free.names_below('tb')[0] == 'tb/drive'


@pytest.mark.parametrize('name', ['odom', 'cmd_vel', 'tf', 'tf_static', 'base_link'])
def test_a_sensor_has_no_name_of_a_topic_or_frame_of_each_robot(name):
    with pytest.raises(BadProperty, match=name) as caught:
        Robot.from_mapping({'drive': DRIVE, 'sensors': [{'kind': 'imu', 'name': name}]})
    assert caught.value.field == 'sensors'
