# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Machines that stand, hang or fly: forces stay with their joints, springs at their balance."""

import math

import numpy as np
from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import (
    Anchor,
    Command,
    Configure,
    Pin,
    Release,
    Spawn,
    Unjoin,
    UnjoinAll,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.simulation.world import World
import pytest

from ..building import BOX, G, join, spawn


def energy(snapshot: Snapshot) -> float:
    """Return the energy [J]."""
    return snapshot.kinetic_energy + snapshot.potential_energy + snapshot.elastic_energy


@pytest.mark.parametrize('kind', [JointKind.AXLE, JointKind.ROD])
def test_a_joint_against_a_contact_moves_no_free_machine(kind):
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    # Drawn into each other, and yet to collide.
    spawn(world, 'a/0', BOX, (0.0, 0.0, 0.0), velocity=(1.0, 0.0))
    spawn(world, 'a/1', BOX, (0.98, 0.3, 0.0), velocity=(1.0, 0.0))
    points = ((0.5, 0.15),) if kind is JointKind.AXLE else ((0.0, 0.0), (0.98, 0.3))
    join(world, kind, points, a='a/0', b='a/1', collide=True)
    before = world.snapshot().momentum
    world.step(480)
    assert world.snapshot().momentum == pytest.approx(before, abs=1e-9)


def hanging() -> World:
    """Return two bars that hang from each other, and swing, and a disc beside them."""
    world = World()
    for number in range(2):
        spawn(world, f'bar/{number}', Box(width=1.0, height=0.2), (0.5 + number, 5.0, 0.0))
        other = f'bar/{number - 1}' if number else 'world'
        join(world, 'axle', [(number, 5.0)], f'axle/{number}', a=f'bar/{number}', b=other)
    spawn(world, 'disc/0', pose=(9.0, 9.0, 0.0))
    world.step(100)
    return world


def test_what_joints_gave_stays_where_others_come_and_go():
    world = hanging()
    forces = world.snapshot().forces
    assert (forces > 1.0).all()
    spawn(world, 'disc/0', pose=(9.0, 9.0, 0.0), color=(1.0, 0.0, 0.0, 1.0))
    assert world.snapshot().forces.tolist() == forces.tolist()
    join(world, 'rod', [(9.0, 9.0), (9.0, 12.0)], 'rod/0', a='disc/0')
    assert world.snapshot().forces.tolist() == [*forces.tolist(), 0.0]
    world.renew()
    world.apply(Unjoin(name='axle/0'))
    assert world.snapshot().forces.tolist() == [forces[1], 0.0]


def test_joints_come_and_go_in_a_world_that_stands():
    world = hanging()
    x, y, _ = world.snapshot().poses[2].tolist()
    for _ in range(3):
        for number in range(2):
            world.apply(Pin(point=(x, y)))
            world.snapshot()
            if number:
                world.apply(UnjoinAll(namespace='joint'))
                world.snapshot()
    world.step(10)
    assert np.isfinite(world.snapshot().poses).all()


def weighted(
    stiffness: float, *, stretched: float = 0.0, physics_rate: float = 240.0, mass: float = 1.0
) -> World:
    """Return a weight on a spring, so far below where 1 kg would hang at rest, which is y = 0."""
    world = World(physics_rate=physics_rate)
    spawn(world, 'weight/0', Disc(radius=0.1), (0.0, -stretched, 0.0), mass=mass)
    ends = ((0.0, -stretched), (0.0, 1.0 + G / stiffness))
    said = {'stiffness': stiffness, 'rest_length': 1.0}
    join(world, 'spring', ends, a='weight/0', b='world', **said)
    return world


@pytest.mark.parametrize('physics_rate', [60.0, 240.0])
@pytest.mark.parametrize('stiffness', [4.0, 40.0])
def test_a_weight_at_balance_on_its_spring_stays(stiffness, physics_rate):
    world = weighted(stiffness, physics_rate=physics_rate)
    for _ in range(240):
        world.step(10)
        assert world.snapshot().poses[0] == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


@pytest.mark.parametrize(
    'again',
    [
        (Anchor(point=(0.0, 0.0)), Release(point=(0.0, 0.0))),
        (Command(names=('weight/0',), twists=((0.0, 0.0, 0.0),)),),
        (Command(names=('weight/0',), poses=((0.0, 0.0, 0.0),)),),
        (Configure(changes={'gravity': (0.0, 0.0)}), Configure(changes={'gravity': (0.0, -G)})),
        (Spawn(name='weight/0', shape=Disc(radius=0.2), pose=(0.0, 0.0, 0.0)),),
    ],
    ids=['released', 'stopped', 'put', 'gravity', 'changed'],
)
def test_it_stays_where_it_is_let_go_again(again):
    world = weighted(10.0)
    world.step(60)
    for request in again:
        world.apply(request)
    world.step(120)
    assert world.snapshot().poses[0] == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)


def test_what_hangs_on_a_weight_by_a_rod_stays_with_it():
    world = weighted(20.0, mass=0.5)
    spawn(world, 'weight/1', Disc(radius=0.1), (0.0, -1.0, 0.0), mass=0.5)
    join(world, 'rod', [(0.0, 0.0), (0.0, -1.0)], 'rod/0', a='weight/0', b='weight/1')
    for _ in range(24):
        world.step(10)
        assert np.abs(world.snapshot().twists).max() < 1e-3


def test_a_weight_on_a_stretched_spring_swings_as_far_as_it_was_pulled():
    world = weighted(10.0, stretched=0.2)
    omega, start = math.sqrt(10.0), world.snapshot()
    for _ in range(480):
        world.step(1)
        now = world.snapshot()
        exact = -0.2 * math.cos(omega * world.step_count / 240.0)
        # The spring swings too fast by (omega dt)^2 / 24 (leapfrog).
        assert now.poses[0, 1] == pytest.approx(exact, abs=1e-6)
        assert energy(now) == pytest.approx(energy(start), abs=0.01 * 0.2)


def test_two_bodies_that_a_spring_joins_fly_together_exactly():
    world = World()
    for number in range(2):
        spawn(world, f'weight/{number}', Disc(radius=0.1), (float(number), 0.0, 0.0))
    said = {'a': 'weight/0', 'b': 'weight/1', 'stiffness': 10.0, 'rest_length': 0.8}
    join(world, 'spring', [(0.0, 0.0), (1.0, 0.0)], **said)
    world.step(480)
    assert world.snapshot().poses[:, 1] == pytest.approx(-2.0 * G, abs=1e-9)
