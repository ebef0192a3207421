# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Joints that are removed, changed, or wait, with their bodies and by name."""

import math
import random

import numpy as np
from physsim_ros.model.requests import (
    Anchor,
    Axle,
    Command,
    Delete,
    DeleteAll,
    Pin,
    Release,
    Unjoin,
    UnjoinAll,
)
from physsim_ros.model.shapes import Box
from physsim_ros.simulation.world import World
import pytest

from .jointed import joints, KINDS, pair, points_of, PROPERTIES
from ..building import BOX, command, DISC, join, joining, pose, spawn, twist


@pytest.mark.parametrize('kind', KINDS)
def test_a_joint_goes_with_its_body(kind):
    world = pair()
    join(world, kind, points_of(kind))
    world.apply(Delete(name='a/1'))
    world.step(10)
    assert joints(world) == ()


def test_joints_are_deleted_by_name_by_namespace_and_with_all_bodies():
    world = pair()
    for name in ('x/0', 'x/1', 'y/0'):
        join(world, 'axle', [(0.4, 0.0)], name)
    world.apply(Unjoin(name='x/0'))
    assert [joint.name for joint in joints(world)] == ['x/1', 'y/0']
    world.apply(UnjoinAll(namespace='x'))
    assert [joint.name for joint in joints(world)] == ['y/0']
    world.apply(UnjoinAll())
    assert joints(world) == ()
    join(world, 'axle', [(0.4, 0.0)])
    world.apply(DeleteAll())
    assert joints(world) == ()


@pytest.mark.parametrize('kind', KINDS)
def test_a_body_that_is_changed_in_place_keeps_its_joints(kind):
    world = pair()
    join(world, kind, points_of(kind), **PROPERTIES.get(kind, {}))
    before = joints(world)
    spawn(world, 'a/1', DISC, (0.8, 0.0, -0.2), mass=3.0)
    assert joints(world) == before
    world.step(60)
    assert np.isfinite(world.snapshot().poses).all()


@pytest.mark.parametrize('kind', KINDS)
def test_a_joint_waits_while_both_its_bodies_are_anchored(kind):
    world = pair()
    join(world, kind, points_of(kind))
    held = pose(world, 'a/0').tolist(), pose(world, 'a/1').tolist()
    world.apply(Anchor(point=(-0.3, 0.0)))
    world.apply(Anchor(point=(1.2, 0.0)))
    world.step(24)
    assert (pose(world, 'a/0').tolist(), pose(world, 'a/1').tolist()) == held
    world.apply(Release(point=(1.2, 0.0)))
    world.step(24)
    assert pose(world, 'a/0').tolist() == held[0]
    assert len(joints(world)) == 1


def test_a_command_of_a_yaw_does_not_wind_a_joint_up():
    world = World()
    spawn(world, 'a/0', BOX, spin=20.0)
    spawn(world, 'a/1', BOX, (0.8, 0.0, 0.0))
    join(world, 'pin', [(0.4, 0.0)])
    world.step(480)
    x, y, yaw = pose(world, 'a/0').tolist()
    world.apply(Command(names=('a/0',), poses=((x, y, math.remainder(yaw, math.tau)),)))
    spin = twist(world, 'a/0')[2]
    world.step(1)
    assert twist(world, 'a/0')[2] == pytest.approx(spin, abs=1e-3)


def test_releasing_a_body_removes_the_pins_and_axles_there():
    world = pair()
    world.apply(Pin(point=(0.4, 0.0)))
    world.apply(Axle(point=(0.4, 0.0)))
    join(world, 'axle', [(1.2, 0.0)], a='a/1', b='world')
    world.apply(Release(point=(0.4, 0.0)))
    assert [joint.name for joint in joints(world)] == ['joint/0']


def test_releasing_a_long_body_leaves_the_axles_farther_along_it():
    world = World()
    spawn(world, 'plank/0', Box(width=20.0, height=1.0))
    for x in (0.1, 2.4):
        world.apply(Axle(point=(x, 0.0)))
    world.apply(Release(point=(0.0, 0.0)))
    assert [joint.name for joint in joints(world)] == ['axle/1']


@pytest.mark.parametrize('kind', KINDS)
def test_what_is_asked_for_again_where_it_is_changes_nothing(kind):
    world = pair()
    request = joining(kind, points_of(kind), a='a/0', b='a/1', **PROPERTIES.get(kind, {}))
    world.apply(request)
    before = world.digest()
    world.apply(request)
    assert world.digest() == before


def test_a_joint_that_is_changed_keeps_what_is_not_said():
    world = pair()
    join(world, 'spring', [(0.4, 0.0), (-0.3, 0.0)], stiffness=7.0, damping=1.0)
    join(world, 'spring', [(0.4, 0.1), (-0.3, 0.0)], stiffness=9.0)
    (joint,) = joints(world)
    assert (joint.properties.stiffness, joint.properties.damping) == (9.0, 1.0)


@pytest.mark.parametrize('replaced', [False, True])
def test_a_joint_that_is_made_under_the_name_of_another_has_no_force_yet(replaced):
    world = pair()
    join(world, 'spring', [(0.0, 0.0), (0.0, 3.0)], a='a/0', b='world')
    world.step(5)
    assert world.snapshot().forces[0] > 0.0
    if not replaced:
        world.apply(UnjoinAll())
    join(world, 'rod', [(0.8, 0.0), (0.8, 2.0)], a='a/1', b='world')

    assert world.snapshot().forces.tolist() == [0.0]


def test_a_body_that_is_put_elsewhere_comes_back_at_20_metres_a_second(world):
    spawn(world, 'a/0', DISC, anchored=True)
    spawn(world, 'b/0', DISC, (1.0, 0.0, 0.0))
    join(world, 'rod', [(0.0, 0.0), (1.0, 0.0)])
    command(world, 'b/0', pose=(51.0, 0.0, 0.0))
    world.step(24)

    assert pose(world, 'b/0')[0] == pytest.approx(49.0, abs=1e-6)


@pytest.mark.parametrize('seed', range(20))
def test_links_that_are_put_apart_come_together_without_spinning(seed, world):
    chance, place, last = random.Random(seed), 0.0, 'world'
    count = chance.randint(2, 5)
    for number in range(count):
        half, name = chance.choice((0.02, 0.1, 0.5)), f'b/{number}'
        spawn(world, name, Box(width=2 * half, height=0.4 * half), (place + half, 0.0, 0.0))
        join(world, 'axle', [(place, 0.0)], f'axle/{number}', a=name, b=last)
        place, last = place + 2 * half, name
    for number in range(count):
        x, y, _ = pose(world, f'b/{number}')
        apart = (
            x + chance.uniform(-0.5, 0.5),
            y + chance.uniform(-0.5, 0.5),
            chance.uniform(-3, 3),
        )
        command(world, f'b/{number}', pose=apart)
    yaws = []
    for _ in range(60):
        yaws.append(world.snapshot().poses[:, 2])
        world.step(1)

    # Two turns; tens of them where a step of Newton's method turns bodies by more than a quarter.
    assert np.abs(np.diff(yaws, axis=0)).sum(axis=0).max() < 4.0 * math.pi
