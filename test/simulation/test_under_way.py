# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Robots, motors and actors under way: to the bit from files and in the past, or refused."""

from collections.abc import Callable
from typing import Any

import numpy as np
from physsim_ros.model.joints import JointProperties
from physsim_ros.model.requests import Delete, DriveRobot, Restore
from physsim_ros.model.robots import Battery, Robot
from physsim_ros.model.shapes import Box
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import World
import pytest

from .driven import put, refusal_of_file, seen_from_above, twins
from .test_actors import PATH
from .test_assemblies import told, with_robot
from .test_batteries import powered_world
from .test_command_latency import armed_world, bend, driven_world
from ..building import check_begins_alike, refusal

DRIVE = {'kind': 'differential', 'timeout': 0.5}


def actors() -> World:
    """Return a world with actors of each kind and start."""
    world = seen_from_above()
    put(world, 'a/0', kinematic=True, actor=PATH)
    put(world, 'b/0', x=1.0, mass=70.0, actor={'kind': 'orca', 'points': [[3, 0], [-1, 0]]})
    force = {'kind': 'social_force', 'points': [[-1, 0], [3, 0]], 'repeat': 'loop'}
    put(world, 'c/0', x=3.0, kinematic=True, actor=force)
    timed = {**PATH, 'start': {'time': 3}}
    put(world, 'd/0', x=5.0, shape=Box(width=0.2, height=0.4), actor=timed)
    put(world, 'gate/0', x=1.9, sensor=True, anchored=True)
    gate = {'gate': 'gate/0', 'by': 'a/0'}
    put(world, 'e/0', x=8.0, kinematic=True, actor={**PATH, 'start': gate})
    world.step(100)
    # It is in no file then, and the actor waits for ever.
    world.apply(Delete(name='gate/0'))
    return world


def drive(world: World, *speeds: float) -> World:
    """Have `a/0` drive and turn, and return the world after some steps."""
    for speed in speeds:
        world.apply(DriveRobot(name='a/0', velocity=(speed, 0.0, 0.4)))
        world.step(5)
    return world


def slipping() -> World:
    """Return a robot whose odometry errs, and which pushes a body."""
    world = seen_from_above()
    put(world, 'a/0', robot={'drive': DRIVE, 'odometry': {'slip': [0.02, 0.03]}})
    put(world, 'b/0', x=0.25, mass=0.02)
    return drive(world, *[0.3] * 10)


def bent(**motor: object) -> World:
    """Return an arm whose motor was commanded to follow paths."""
    world = armed_world(**motor)
    for angle in (0.2, 0.4, 0.6):
        bend(world, (0.0, angle), (0.3, angle + 0.5))
        world.step(10)
    return world


def commanded() -> World:
    """Return a shipped arm with a command of two seconds."""
    world = with_robot()
    world.apply(told(points=((2.0, 1.0, 0.0),)))
    world.step(100)
    return world


UNDER_WAY: dict[str, Callable[[], World]] = {
    'actors': actors,
    'a robot': slipping,
    'a battery': lambda: drive(powered_world(), 0.1),
    'a drive with latency': lambda: drive(driven_world(latency=[0.1, 0.3]), 0.1, 0.2, 0.3, 0.4),
    'a motor': commanded,
    'a motor with latency': lambda: bent(latency=[0.1, 0.12]),
}


@pytest.mark.parametrize('make', UNDER_WAY.values(), ids=UNDER_WAY)
def test_what_is_under_way_goes_on_to_the_bit_from_its_file_and_at_another_moment(make, tmp_path):
    world = make()
    check_begins_alike(world.save(), world.physics_rate)

    one, other = twins(world, tmp_path)
    later = seen_from_above()
    later.step(100)
    later.apply(Restore(state=world.save()))
    for _ in range(10):
        assert one.digest() == other.digest()
        assert np.array_equal(one.snapshot().poses, later.snapshot().poses)
        for each in (one, other, later):
            each.step(60)


@pytest.mark.parametrize('make', UNDER_WAY.values(), ids=UNDER_WAY)
def test_what_is_under_way_comes_again_to_the_bit_in_the_past_and_elsewhere(make):
    simulation, elsewhere = (Simulation(checkpoints=0.1) for _ in range(2))
    simulation.begin(make().save())
    simulation.run(0.55)
    elsewhere.restore(simulation.checkpoint())
    simulation.run(1.0)
    end, digest = simulation.stamp, simulation.world.digest()

    simulation.seek(300_000_000)
    assert simulation.world.digest() != digest
    simulation.seek(end)
    elsewhere.run(1.0)

    assert simulation.world.digest() == elsewhere.world.digest() == digest
    assert not [each for each in simulation.frame.answers if each.code == 'divergence']


OMNI = 'robot: {drive: {kind: omni}}'
ACTOR = f'actor: {PATH}'


@pytest.mark.parametrize(
    ('said', 'code', 'field'),
    [
        ('acting: {}', 'bad_property', 'acting'),
        (f'{ACTOR}, acting: [1]', 'bad_property', 'acting'),
        (f'{ACTOR}, acting: {{seconds: a}}', 'bad_property', 'seconds'),
        (f'{ACTOR}, acting: {{reached: -1}}', 'bad_property', 'reached'),
        (f'{ACTOR}, acting: {{begun: 1}}', 'unknown_property', 'begun'),
        ('actor: {kind: walk}', 'bad_property', 'kind'),
        (f'{ACTOR}, anchored: true', 'bad_property', 'anchored'),
        ('robot: {drive: {kind: omni}, namespace: a_0}', 'exists', None),
        ('driven: {}', 'bad_property', None),
        ('robot: car, driven: {aim: [1]}', 'malformed', None),
        ('robot: car, driven: {aim: [1, 2, .nan]}', 'malformed', None),
        ('robot: car, driven: {seconds: -1}', 'bad_property', None),
        ('robot: car, driven: {wheel: 1}', 'unknown_property', None),
        ('robot: car, anchored: true', 'bad_property', None),
        ('robot: {drive: {kind: omni}, battery: {}}, driven: {drawn: .nan}', 'malformed', None),
        (f'{OMNI}, driven: {{coming: [{{aim: [0, 0, 0]}}]}}', 'bad_property', None),
        (f'{OMNI}, driven: {{coming: [{{begins: -1}}]}}', 'bad_property', None),
        (f'{OMNI}, driven: {{coming: [{{begins: .inf}}]}}', 'malformed', None),
        (f'{OMNI}, driven: {{coming: [{{begins: 2}}, {{begins: 1}}]}}', 'bad_property', None),
        (f'{OMNI}, driven: {{coming: [{{begins: 0.1, aim: [1, 0]}}]}}', 'malformed', None),
        ('robot: {namespace: r}, driven: {coming: [{begins: 0.1}]}', 'bad_property', None),
    ],
)
def test_a_file_with_what_cannot_be_under_way_is_refused(tmp_path, said, code, field):
    first = f'{{name: a/0, circle: {{radius: 0.1}}, {OMNI}}}'
    refused = refusal_of_file(tmp_path, first, f'{{name: b/0, circle: {{radius: 1}}, {said}}}')
    assert refused.cause == code
    assert field in (None, refused.field)


def driven_by(said: dict[str, Any]) -> Robot:
    return Robot.from_mapping({'drive': DRIVE | said})


@pytest.mark.parametrize(
    ('make', 'said', 'code'),
    [
        (Battery.from_mapping, {'capacity': 0}, 'bad_property'),
        (Battery.from_mapping, {'capacity': float('nan')}, 'malformed'),
        (Battery.from_mapping, {'level': 1.5}, 'bad_property'),
        (Battery.from_mapping, {'idle': -1.0}, 'bad_property'),
        (Battery.from_mapping, {'docks': 'dock/0'}, 'bad_property'),
        (Battery.from_mapping, {'docks': [f'dock/{each}' for each in range(17)]}, 'bad_property'),
        (Battery.from_mapping, {'rate': 0}, 'bad_property'),
        (driven_by, {'latency': 6.0}, 'bad_property'),
        (driven_by, {'latency': float('nan')}, 'malformed'),
        (driven_by, {'latency': 'soon'}, 'bad_property'),
        *(
            (make, said, code)
            for make in (driven_by, JointProperties.from_mapping)
            for said, code in (
                ({'latency': -0.1}, 'bad_property'),
                ({'latency': [0.2, 0.1]}, 'bad_property'),
                ({'latency': [0.1]}, 'malformed'),
                ({'command_rate': -1.0}, 'bad_property'),
            )
        ),
    ],
)
def test_a_battery_or_latency_that_cannot_be_is_refused(make, said, code):
    kind, field = refusal(make, said)
    assert (kind.code, field in said) == (code, True)
