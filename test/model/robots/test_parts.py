# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The parts of a robot: what is no tree of links and joints is refused."""

from physsim_ros.model.errors import BadProperty, Malformed, UnknownProperty
from physsim_ros.model.motor_command import MotorCommand
from physsim_ros.model.robots import Robot
import pytest

from ...building import refusal

LINK = {'name': 'a', 'box': {'width': 0.1, 'height': 0.1}}
JOINT = {'name': 'j', 'kind': 'axle', 'a': 'a', 'points': [[0.0, 0.0]]}
SPRING = {**JOINT, 'name': 's', 'kind': 'spring', 'points': [[0.0, 0.0], [0.1, 0.0]]}
SLIDER = {**SPRING, 'kind': 'slider'}
ROPE = {**SPRING, 'name': 'r', 'kind': 'rope', 'points': [[0.0, 0.0], [0.0, 1.0], [0.1, 0.0]]}
GEAR = {**JOINT, 'name': 'g', 'kind': 'gear', 'ratio': 2.0}


@pytest.mark.parametrize(
    ('links', 'joints', 'error', 'field'),
    [
        ([LINK], [], BadProperty, 'links'),
        ([LINK], [SPRING], BadProperty, 'links'),
        ([LINK, LINK], [JOINT], BadProperty, 'links'),
        ([LINK], [JOINT, JOINT], BadProperty, 'joints'),
        ([LINK], [{**JOINT, 'a': 'b'}], BadProperty, 'joints'),
        ([LINK], [{**JOINT, 'b': 'a'}], BadProperty, 'links'),
        ([LINK], [{**JOINT, 'b': 'world'}], BadProperty, 'joints'),
        ([{**LINK, 'name': 'base'}], [JOINT], BadProperty, 'links'),
        ([{**LINK, 'name': 'a/b'}], [JOINT], BadProperty, 'name'),
        ([{**LINK, 'circle': {'radius': 1}}], [JOINT], BadProperty, 'shape'),
        ([{**LINK, 'drive': {}}], [JOINT], UnknownProperty, 'drive'),
        ([LINK], [{**JOINT, 'rest_length': 3}], UnknownProperty, 'rest_length'),
        ([LINK], [{**JOINT, 'kind': 'hook'}], BadProperty, 'kind'),
        ([LINK], [{**JOINT, 'effort': -1}], BadProperty, 'effort'),
        ([LINK], [{**SLIDER, 'effort': 3, 'rate': 1}], BadProperty, 'effort'),
        ([LINK], [JOINT, {**ROPE, 'over': ['crate/0']}], BadProperty, 'joints'),
        ([LINK], [JOINT, {**GEAR, 'carrier': 'arm/0/a/0'}], BadProperty, 'joints'),
    ],
)
def test_parts_that_are_no_tree_are_refused(links, joints, error, field):
    assert refusal(Robot.from_mapping, {'links': links, 'joints': joints}) == (error, field)


def test_parts_and_sensors_on_them_are_written_as_they_are_read():
    link = {**LINK, 'at': [0.1, 0.2, 0.3], 'mass': 2.0, 'towed': {'track': 0.3}}
    gear = {**JOINT, 'name': 'g', 'kind': 'gear', 'ratio': 2.0}
    sensors = [{'kind': 'imu', 'link': 'a'}]
    said = {'links': [link], 'joints': [SPRING, gear, JOINT], 'sensors': sensors}
    robot = Robot.from_mapping(said)
    assert Robot.from_mapping(robot.entry()) == robot
    assert robot.joint_above('a').name == 'j'
    on_b = {**said, 'sensors': [{'kind': 'imu', 'link': 'b'}]}
    assert refusal(Robot.from_mapping, on_b) == (BadProperty, 'link')


@pytest.mark.parametrize(
    ('change', 'error', 'field'),
    [
        ({'mode': 'speed'}, BadProperty, 'mode'),
        ({'points': []}, BadProperty, 'points'),
        ({'points': [(0.0,)]}, Malformed, 'points'),
        ({'points': [(0.0, float('nan'))]}, Malformed, 'points'),
        ({'points': [(0.0, 1.0, 'fast')]}, Malformed, 'points'),
        ({'points': [(1.0, 1.0), (1.0, 2.0)]}, BadProperty, 'points'),
        ({'points': [(-1.0, 1.0)]}, BadProperty, 'points'),
        ({'points': [(0.0, 1e13)]}, BadProperty, 'points'),
        ({'points': [(float(t), 0.0) for t in range(1001)]}, BadProperty, 'points'),
    ],
)
def test_a_command_that_is_none_is_refused(change, error, field):
    said = {'joint': 'j/0', 'mode': 'position', 'points': [(0.0, 1.0)], **change}
    assert refusal(MotorCommand.from_mapping, said) == (error, field)
