# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Robots with parts are spawned, moved, deleted, saved and rewound as one."""

import math

import numpy as np
from physsim_ros import Properties, Robot, robot_spawn, save_world, Simulation, WorldSettings
from physsim_ros.files import load_world
from physsim_ros.model.errors import BadProperty, Exists, UnknownBody, UnknownJoint
from physsim_ros.model.requests import (
    ChangeBody,
    Command,
    CommandMotors,
    Delete,
    DeleteAll,
    DriveRobot,
    MoveBodies,
    Restore,
    Spawn,
    Unjoin,
)
from physsim_ros.model.robots import Robot as Description
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.model.transform import local_to_world, world_to_local
from physsim_ros.simulation.world import World
import pytest

from ..building import joining, refusal

ARM, UPPER, LOWER = PARTS = 'arm/0', 'arm/0/upper/0', 'arm/0/lower/0'
ANCHORED = Properties(anchored=True)
FLAT = WorldSettings(gravity=(0.0, 0.0))


def with_robot(robot='arm', name='arm/0', at=(1.0, 2.0, 0.5)) -> World:
    world = World(settings=FLAT)
    world.apply(robot_spawn(robot, name=name, at=at))
    return world


def poses(world):
    snapshot = world.snapshot()
    return dict(zip(snapshot.scene.names, map(tuple, snapshot.poses.tolist()), strict=True))


def told(joint='arm/0/shoulder/0', mode='position', points=((0.0, 1.0),)):
    return CommandMotors(commands=({'joint': joint, 'mode': mode, 'points': points},))


def seen_from(pose, other):
    """Return a pose in the frame of another one."""
    return *world_to_local(pose[:2], other), math.remainder(pose[2] - other[2], math.tau)


def test_a_robot_is_spawned_with_its_parts_where_its_file_has_them():
    world = with_robot()

    assert tuple(world.scene.names) == PARTS
    assert [joint.name for joint in world.scene.joints] == ['arm/0/shoulder/0', 'arm/0/elbow/0']
    found = poses(world)
    assert found[LOWER] == pytest.approx((*local_to_world((0.55, 0.0), found[ARM]), 0.5))


def test_a_rope_runs_over_links_and_a_gear_turns_about_one_wherever_the_robot_is(tmp_path):
    wheel = {'name': 'wheel', 'circle': {'radius': 0.1}, 'at': [0.0, 1.0]}
    hook = {'name': 'hook', 'box': {'width': 0.1, 'height': 0.1}, 'at': [0.5, 0.0]}
    axle = {'name': 'axle', 'kind': 'axle', 'a': 'wheel', 'points': [[0.0, 1.0]]}
    lift = {'name': 'lift', 'kind': 'slider', 'a': 'hook', 'points': [[0.5, 0.0], [0.5, 1.0]]}
    rope = {
        'name': 'rope',
        'kind': 'rope',
        'a': 'hook',
        'points': [[0.5, 0.0], [0.1, 1.0], [-0.5, 1.0], [-0.5, 0.0]],
        'over': ['wheel', 'world'],
    }
    gear = {
        'name': 'gear',
        'kind': 'gear',
        'a': 'wheel',
        'b': 'hook',
        'points': [[0.0, 1.0]],
        'carrier': 'base',
    }
    robot = {'links': [wheel, hook], 'joints': [axle, lift, rope, gear]}
    world = World(settings=FLAT)
    for name, at in (('crane/0', (0.0, 0.0, 0.0)), ('crane/1', (10.0, 5.0, 1.0))):
        properties = Properties(robot=Description.from_mapping(robot), anchored=True)
        world.apply(Spawn(name=name, shape=Disc(radius=0.05), pose=at, properties=properties))
    guides = {joint.name: joint.properties.guides for joint in world.scene.joints}
    for name in ('crane/0', 'crane/1'):
        assert guides[f'{name}/rope/0'] == (f'{name}/wheel/0', 'world')
        assert guides[f'{name}/gear/0'] == (name,)
    world.step(10)
    path = save_world(world.save(), 'w', world_dir=tmp_path, physics_rate=world.physics_rate)
    again = World(settings=FLAT)
    again.apply(Restore(state=load_world(path)))
    assert again.save().joints == world.save().joints


@pytest.mark.parametrize('taken', [UPPER, 'arm/0/elbow/0'])
def test_a_robot_is_not_spawned_where_the_name_of_a_part_is_taken(taken):
    world = World(settings=FLAT)
    world.apply(Spawn(name=UPPER if taken == UPPER else 'box/0', shape=Box(width=1, height=1)))
    if taken != UPPER:
        world.apply(robot_spawn('arm', name='arm/0'))
        world.apply(Delete(name='arm/0'))
        spawn = Spawn(name='box/1', shape=Box(width=1, height=1))
        world.apply(spawn)
        world.apply(joining('rod', [(0.0, 0.0), (0.2, 0.0)], name=taken, a='box/0', b='box/1'))
    digest = world.digest()

    error, field = refusal(world.apply, robot_spawn('arm', name='arm/0'))

    assert (error, field) == (Exists, 'name')
    assert world.digest() == digest


def test_deleting_one_of_them_deletes_all():
    for request in (Delete(name=ARM), Delete(name=LOWER), DeleteAll(namespace='arm')):
        world = with_robot()
        world.apply(request)
        assert len(world) == 0
        assert world.scene.joints == ()


@pytest.mark.parametrize('named', PARTS)
def test_a_robot_is_moved_as_one_by_the_pose_of_any_of_its_bodies(named):
    world = with_robot()
    before = poses(world)

    world.apply(Command(names=(named,), poses=np.array([[-3.0, 1.0, 2.0]])))

    after = poses(world)
    assert after[named] == pytest.approx((-3.0, 1.0, 2.0))
    for name in PARTS:
        assert seen_from(after[name], after[named]) == pytest.approx(
            seen_from(before[name], before[named]), abs=1e-12
        )


def test_bodies_that_a_request_names_are_where_it_says_and_others_follow():
    world = with_robot(at=(0.0, 0.0))
    world.apply(
        Command(names=(ARM, LOWER), poses=np.array([[1.0, 0.0, 0.0], [1.4, 0.15, math.pi / 2]]))
    )
    found = poses(world)
    assert found[UPPER] == pytest.approx((1.2, 0.0, 0.0))
    assert found[LOWER] == pytest.approx((1.4, 0.15, math.pi / 2))
    world.apply(MoveBodies(names=(ARM,), by=(0.0, 2.0)))
    assert poses(world)[LOWER] == pytest.approx((1.4, 2.15, math.pi / 2))
    world.apply(ChangeBody(name=ARM, pose=(0.0, 0.0, 0.0)))
    assert poses(world)[LOWER] == pytest.approx((0.4, 0.15, math.pi / 2))


def test_parts_have_the_velocity_of_a_rigid_body_where_that_of_their_robot_is_set():
    world = with_robot('tractor', 'tractor/0', (0.0, 0.0))
    world.apply(Command(names=('tractor/0',), twists=np.array([[0.0, 0.0, 1.0]])))
    twists, centers = world.snapshot().twists, world.snapshot().centers
    dx, dy = centers[1] - centers[0]
    assert twists[1] == pytest.approx((-dy, dx, 1.0))


def test_the_parts_of_a_robot_are_not_changed():
    world = with_robot()
    robot = world.scene.bodies[0].robot
    changed = robot_spawn({'from': 'arm', 'links': [], 'joints': [], 'sensors': []}, name='x/0')
    change = ChangeBody(name=ARM, properties=changed.properties)
    assert refusal(world.apply, change) == (BadProperty, 'robot')
    assert world.scene.bodies[0].robot == robot


def test_motors_are_commanded_by_the_names_of_their_joints():
    world = with_robot('tractor', 'tractor/0')
    assert refusal(world.apply, told('no/0')) == (UnknownJoint, 'joint')
    assert refusal(world.apply, told('tractor/0/hitch/0')) == (BadProperty, 'joint')
    arm = with_robot()
    digest = arm.digest()
    arm.apply(told())
    assert arm.digest() != digest
    drive = DriveRobot(name='arm/0', velocity=(1.0, 0.0, 0.0))
    assert refusal(arm.apply, drive) == (BadProperty, 'name')


def test_a_world_file_has_a_robot_with_its_parts_by_its_name_alone(tmp_path):
    path = tmp_path / 'w.yaml'
    path.write_text(
        'format: 1\ngravity: [0, 0]\nbodies:\n- {name: arm/0, robot: arm, at: [1, 2, 0.5]}\n'
    )
    world = World(settings=FLAT)
    world.apply(Restore(state=load_world(path)))
    for name, pose in poses(with_robot()).items():
        assert poses(world)[name] == pytest.approx(pose)
    world.apply(told())
    world.step(600)
    assert poses(world)[UPPER][2] == pytest.approx(1.5, abs=1e-6)


def test_a_laser_does_not_see_the_parts_of_its_robot_and_may_be_on_one():
    sensors = [
        {'kind': 'laser', 'name': 'scan', 'beams': 4, 'angle': [0, 6.2832], 'range': [0.01, 9]},
        {'kind': 'laser', 'name': 'tip', 'link': 'lower', 'at': [0.15, 0], 'range': [0.01, 9],
         'beams': 1, 'angle': [0, 0]},
    ]  # fmt: skip
    simulation = Simulation(settings=FLAT)
    simulation.perform(robot_spawn({'from': 'arm', 'sensors': sensors}, name='arm/0'))
    simulation.perform(
        Spawn(
            name='box/0', shape=Box(width=1, height=1), pose=(2.5, 0.0, 0.0), properties=ANCHORED
        )
    )
    robot = Robot(simulation, 'arm/0')
    assert robot.read('scan').tolist() == pytest.approx([2.0, math.inf, math.inf, math.inf])
    assert robot.read('tip').tolist() == pytest.approx([1.3])
    simulation.perform(told('arm/0/elbow/0', points=((0.0, 0.2),)))
    simulation.run(1.0)
    # Its shoulder has yielded a little as the elbow set off.
    assert robot.read('tip').tolist() == pytest.approx(
        [(2.0 - 0.4) / math.cos(0.2) - 0.3], abs=1e-3
    )


def test_a_joint_of_a_robot_may_be_removed():
    world = with_robot()
    world.apply(Unjoin(name='arm/0/elbow/0'))
    world.step(10)
    assert refusal(world.apply, told('arm/0/elbow/0')) == (UnknownJoint, 'joint')
    world.apply(Delete(name=UPPER))
    assert refusal(world.apply, Delete(name=LOWER)) == (UnknownBody, 'name')
