# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bodies are changed by the properties that are named, and moved and deleted by the name."""

from dataclasses import replace

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import Refusal, UnknownProperty
from physsim_ros.model.requests import ChangeBody, DeleteBodies, MoveBodies, Request
from physsim_ros.model.snapshot import Answer
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.simulation.world import World
import pytest

from ..building import body, BOX, DISC, ELL, NOWHERE, spawn, spawning, twist


def changed(world: World, **properties: object) -> None:
    message = world.apply(ChangeBody(name='a/0', properties=Properties(**properties)))
    assert message == Answer(subject='a/0', message='changed a/0')


def test_only_what_is_named_changes():
    world = World(settings=NOWHERE)
    spawn(world, 'a/0', ELL, (1.0, 2.0, 0.3), velocity=(1.0, 2.0), spin=3.0, lifetime=9.0)
    world.step(7)
    before, snapshot = body(world, 'a/0'), world.snapshot()

    changed(world, friction=0.25)
    assert body(world, 'a/0') == replace(before, friction=0.25)
    changed(world, density=7.0, elasticity=0.125)
    world.apply(ChangeBody(name='a/0', color=(1, 0, 0, 1)))

    assert body(world, 'a/0') == replace(
        before, friction=0.25, density=7.0, elasticity=0.125, color=(1.0, 0.0, 0.0, 1.0)
    )
    assert world.snapshot().poses == pytest.approx(snapshot.poses, abs=1e-12)
    assert world.snapshot().twists == pytest.approx(snapshot.twists, abs=1e-12)


@pytest.mark.parametrize(
    ('name', 'value', 'default'),
    [
        ('friction', 0.25, 0.75),
        ('elasticity', 0.25, 0.125),
        ('density', 7.0, 3.0),
        ('kinematic', True, False),
        ('anchored', True, False),
        ('group', 5, 0),
        ('sensor', True, False),
        ('label', 'm', ''),
        ('robot', {'drive': {'kind': 'omni'}}, None),
    ],
)
def test_a_property_that_is_unset_has_its_default_again(name, value, default):
    world = World(settings=replace(NOWHERE, friction=0.75, elasticity=0.125, density=3.0))
    spawn(world, 'a/0', DISC)
    before = body(world, 'a/0')
    changed(world, **{name: value})

    world.apply(ChangeBody(name='a/0', unset=(name,)))

    assert getattr(body(world, 'a/0'), name) == default
    assert body(world, 'a/0') == before


def test_a_mass_that_is_unset_leaves_the_default_density():
    world = World(settings=replace(NOWHERE, density=3.0))
    spawn(world, 'a/0', DISC, mass=20.0)
    spawn(world, 'a/1', DISC, density=5.0)

    for name in ('a/0', 'a/1'):
        world.apply(ChangeBody(name=name, unset=('mass',)))

    assert [(each.mass, each.density) for each in world.scene.bodies] == [(None, 3.0), (None, 5.0)]


def test_a_density_that_is_unset_leaves_a_mass():
    world = World(settings=replace(NOWHERE, density=3.0))
    spawn(world, 'a/0', DISC, mass=20.0)
    spawn(world, 'a/1', DISC, density=5.0)
    heavy = body(world, 'a/0')

    for name in ('a/0', 'a/1'):
        world.apply(ChangeBody(name=name, unset=('density',)))

    assert body(world, 'a/0') == heavy
    assert [(each.mass, each.density) for each in world.scene.bodies][1] == (None, 3.0)


def test_a_velocity_that_is_unset_is_none():
    world = World(settings=NOWHERE)
    spawn(world, 'a/0', DISC, velocity=(1.0, 2.0), spin=3.0)

    world.apply(ChangeBody(name='a/0', unset=('velocity',)))
    assert twist(world, 'a/0') == pytest.approx((0.0, 0.0, 3.0))
    world.apply(ChangeBody(name='a/0', unset=('spin',)))
    assert not twist(world, 'a/0').any()


def test_a_property_that_there_is_not_cannot_be_unset():
    with pytest.raises(UnknownProperty, match="nearest is 'friction'"):
        ChangeBody(name='a/0', unset=('frictoin',))


def test_pose_velocity_and_role_change_too():
    world = World(settings=NOWHERE)
    spawn(world, 'a/0', DISC, velocity=(1.0, 0.0))
    spawn(world, 'b/0', DISC, (5.0, 5.0, 0.0))

    changed(world, velocity=(0.0, 4.0))
    assert twist(world, 'a/0') == pytest.approx((0.0, 4.0, 0.0))
    world.apply(ChangeBody(name='a/0', pose=(1.0, 2.0, 0.5), frame='b/0'))
    assert world.snapshot().poses[0] == pytest.approx((6.0, 7.0, 0.5))
    changed(world, anchored=True)
    assert twist(world, 'a/0') == pytest.approx((0.0, 0.0, 0.0))
    changed(world, anchored=False)
    world.step(10)
    assert world.snapshot().poses[0] == pytest.approx((6.0, 7.0, 0.5))


def test_bodies_are_moved_together_and_keep_their_motion():
    world = World(settings=NOWHERE)
    spawn(world, 'a/0', ELL, (0.0, 0.0, 0.3), velocity=(1.0, 2.0), spin=3.0)
    spawn(world, 'a/1', BOX, (5.0, 0.0, 0.0), anchored=True)
    spawn(world, 'a/2', BOX, (9.0, 0.0, 0.0))
    before = world.snapshot()

    assert world.apply(MoveBodies(names=('a/0', 'a/1'), by=(1.0, -2.0))) == Answer(
        message='moved 2 bodies'
    )

    moved = world.snapshot().poses - before.poses
    assert moved == pytest.approx(np.array([[1, -2, 0], [1, -2, 0], [0, 0, 0]]))
    assert np.array_equal(world.snapshot().twists, before.twists)


def test_several_are_deleted_with_one_gesture():
    sim = Simulation(settings=NOWHERE)
    for number in range(4):
        sim.perform(spawning_at(number))
    sim.requests.submit(DeleteBodies(names=('a/0', 'a/2')), topic='')
    frame = sim.apply_requests()
    assert frame is not None
    assert frame.snapshot.scene.names == ('a/1', 'a/3')
    sim.undo()
    assert len(sim.world) == 4


def spawning_at(number: int) -> Request:
    return spawning(f'a/{number}', BOX, (3.0 * number, 0.0, 0.0))


@pytest.mark.parametrize('names', [(), ('a/0', 'a/0')])
def test_bodies_are_named_once_each(names):
    for make in (lambda: DeleteBodies(names=names), lambda: MoveBodies(names=names, by=(1, 0))):
        with pytest.raises(Refusal):
            make()
