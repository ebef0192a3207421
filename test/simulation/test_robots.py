# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Robots in a world: commands, what is refused, and what is kept of them."""

import math

import numpy as np
from physsim_ros.model.errors import BadProperty, Exists, UnknownBody
from physsim_ros.model.requests import Anchor, ChangeBody, Delete, DriveRobot
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box
from physsim_ros.simulation.world import World
import pytest

from .driven import (
    assert_refused,
    body_request,
    changing,
    put,
    seen_from_above,
)
from ..building import joining, sleepers

DRIVE = {'kind': 'differential', 'timeout': 0.5}
SLIPPING = {'drive': DRIVE, 'odometry': {'slip': [0.02, 0.03]}}


@pytest.mark.parametrize('count', [64, 65, 129])
def test_noise_is_that_of_its_step_however_many_are_made_at_once(count):
    at_once, one_by_one = seen_from_above(), seen_from_above()
    for world in (at_once, one_by_one):
        put(world, 'a/0', robot=SLIPPING)
        world.apply(DriveRobot(name='a/0', velocity=(0.2, 0.0, 0.3)))
    at_once.step(count)
    for _ in range(count):
        one_by_one.step(1)
    assert at_once.digest() == one_by_one.digest()


@pytest.mark.parametrize('field', ['anchored', 'kinematic', 'sensor'])
def test_a_robot_is_neither_anchored_nor_kinematic_nor_a_sensor(field):
    world, robot = seen_from_above(), {'drive': DRIVE}
    assert_refused(world, body_request('a/0', robot=robot, **{field: True}), BadProperty, field)
    put(world, 'b/0', robot=robot)
    assert_refused(world, changing('b/0', **{field: True}), BadProperty, field)
    put(world, 'c/0', x=1.0, **{field: True})
    assert_refused(world, changing('c/0', robot=robot), BadProperty, field)


def test_a_robot_is_not_anchored_by_a_click_and_may_have_joints():
    world = seen_from_above()
    put(world, 'a/0', robot={'drive': DRIVE})
    assert_refused(world, Anchor(point=(0.0, 0.0)), BadProperty, 'point')
    put(world, 'b/0', x=1.0)
    rod = joining('rod', [(0.0, 0.0), (1.0, 0.0)], a='a/0', b='b/0')
    world.apply(rod)
    world.apply(changing('b/0', towed={}))
    world.apply(DriveRobot(name='a/0', velocity=(0.2, 0.0, 0.0)))
    world.step(120)

    poses = world.snapshot().poses
    assert poses[0, 0] > 0.05
    assert math.dist(poses[0, :2], poses[1, :2]) == pytest.approx(1.0, abs=1e-6)


def test_two_robots_have_two_namespaces():
    world = seen_from_above()
    put(world, 'a/0', robot={'drive': DRIVE})
    spawn = body_request('b/0', 1.0, robot={'drive': DRIVE, 'namespace': 'a_0'})
    assert_refused(world, spawn, Exists, 'namespace')

    world.apply(Delete(name='a/0'))
    world.apply(spawn)
    # Itself it may be spawned again.
    world.apply(spawn)


@pytest.mark.parametrize(
    ('namespace', 'sensor', 'other', 'name'),
    [
        ('tb', 'x/odom', 'tb/x', 'tb/x/odom'),
        ('tb', 'x/base_link', 'tb/x', 'tb/x/base_link'),
        ('', 'tb/imu/cmd_vel', 'tb/imu', 'tb/imu/cmd_vel'),
    ],
)
def test_two_robots_have_no_name_in_common(namespace, sensor, other, name):
    world = seen_from_above()
    sensors = [{'kind': 'imu', 'name': sensor}]
    put(world, 'a/0', robot={'drive': DRIVE, 'namespace': namespace, 'sensors': sensors})
    spawn = body_request('b/0', 1.0, robot={'drive': DRIVE, 'namespace': other})
    assert_refused(world, spawn, Exists, 'namespace')
    with pytest.raises(Exists, match=f'one topic or frame, /{name};'):
        world.apply(spawn)

    # A namespace within another one is none of its names.
    put(world, 'c/0', 2.0, robot={'drive': DRIVE, 'namespace': f'{other}/y'})


@pytest.mark.parametrize('name', ['7/0', 'a/-1', 'ä/0'])
def test_a_name_that_is_no_namespace_needs_one(name):
    world = seen_from_above()
    spawn = body_request(name, robot={'drive': DRIVE})
    assert_refused(world, spawn, BadProperty, 'namespace')

    put(world, name, robot={'drive': DRIVE, 'namespace': 'r'})


def test_only_robots_are_driven():
    world = seen_from_above()
    put(world, 'a/0')
    assert_refused(world, DriveRobot(name='b/0', velocity=(1.0, 0.0, 0.0)), UnknownBody, 'name')
    assert_refused(world, DriveRobot(name='a/0', velocity=(1.0, 0.0, 0.0)), BadProperty, 'name')


def test_a_refusal_names_ten_robots_that_there_are():
    world = seen_from_above()
    for number in range(12):
        put(world, f'a/{number}', x=2.0 * number, robot={'drive': DRIVE})
    with pytest.raises(UnknownBody) as refused:
        world.apply(DriveRobot(name='b/0', velocity=(1.0, 0.0, 0.0)))
    _, _, names = str(refused.value).partition('robots: ')
    assert names.split(', ') == [f'a/{number}' for number in range(10)]


def test_only_a_sensor_is_a_conveyor():
    world = seen_from_above()
    belt = Box(width=1.0, height=1.0)
    spawn = body_request('belt/0', shape=belt, surface_velocity=(1.0, 0.0), anchored=True)

    assert_refused(world, spawn, BadProperty, 'surface_velocity')


def test_a_robot_keeps_its_state_when_it_is_changed_and_loses_it_when_it_is_removed():
    world = seen_from_above()
    put(world, 'a/0', robot={'drive': DRIVE})
    put(world, 'b/0', x=2.0, robot={'drive': DRIVE})
    for name in ('a/0', 'b/0'):
        world.apply(DriveRobot(name=name, velocity=(0.2, 0.0, 0.0)))
    world.step(60)
    before = world.snapshot().robots

    world.apply(changing('a/0', friction=0.9))
    kept = world.snapshot().robots
    assert np.array_equal(kept, before)
    spawn = body_request('a/0', robot={'drive': DRIVE})
    world.apply(Delete(name='a/0'))
    world.apply(spawn)

    # A body that is spawned anew is the last one.
    assert world.scene.names == ('b/0', 'a/0')
    last = world.snapshot().robots
    assert np.array_equal(last['odometry'][0], before['odometry'][1])
    assert not last['odometry'][1].any()
    assert not last['wheels'][1].any()


def test_a_sleeping_robot_is_woken_up_by_a_command():
    world = seen_from_above()
    put(world, 'a/0', robot={'drive': DRIVE})
    world.step(240)
    assert sleepers(world) == ['a/0']

    world.apply(DriveRobot(name='a/0', velocity=(0.2, 0.0, 0.0)))
    world.step(60)

    assert world.snapshot().twists[0, 0] == pytest.approx(0.2, abs=1e-9)


@pytest.mark.parametrize(('velocity', 'axis'), [((0.001, 0.0, 0.0), 0), ((0.0, 0.0, 0.02), 2)])
def test_a_robot_that_creeps_or_turns_slowly_does_not_fall_asleep(velocity, axis):
    world = seen_from_above()
    put(world, 'a/0', robot={'drive': {**DRIVE, 'timeout': 0}})
    world.apply(DriveRobot(name='a/0', velocity=velocity))
    world.step(480)

    assert world.snapshot().poses[0, axis] == pytest.approx(2.0 * velocity[axis], rel=0.01)


def test_a_body_that_is_no_robot_any_more_has_no_state_of_one():
    world = seen_from_above()
    put(world, 'a/0', robot={'drive': DRIVE})
    world.apply(DriveRobot(name='a/0', velocity=(0.2, 0.0, 0.0)))
    world.step(60)

    world.apply(ChangeBody(name='a/0', unset=('robot',)))

    assert world.save().bodies[0].driven is None
    with pytest.raises(BadProperty):
        world.apply(DriveRobot(name='a/0', velocity=(0.2, 0.0, 0.0)))
    world.apply(changing('a/0', robot={'drive': DRIVE}))
    assert not any(world.snapshot().robots['odometry'][0])


@pytest.mark.parametrize(('gravity', 'falls'), [((0.0, 0.0), False), ((0.0, -9.81), True)])
def test_a_robot_that_falls_is_told(gravity, falls):
    world = World(settings=WorldSettings(gravity=gravity))

    answer = world.apply(body_request('a/0', robot={'drive': DRIVE})).answer

    assert answer.message.startswith('spawned a/0')
    assert ('gravity' in answer.message) is falls
