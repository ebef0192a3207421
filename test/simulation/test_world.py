# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The world carries out requests: bodies come, last and go; snapshots show them."""

import math

import numpy as np
from physsim_ros.model import requests
from physsim_ros.model.answer import Answer
from physsim_ros.model.colors import color_of
from physsim_ros.model.errors import BadProperty, UnknownBody, UnknownJoint, WorldFull
from physsim_ros.model.requests import (
    AtPoint,
    Command,
    Configure,
    Delete,
    DeleteAll,
    DeleteBodies,
    HandRequest,
    OfNamespace,
    Release,
    Request,
)
from physsim_ros.model.scene import Body
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box
from physsim_ros.simulation.world import World
from physsim_ros.simulation.world.world import HANDLERS
import pytest

from ..building import (
    body,
    BOX,
    DISC,
    ELL,
    join,
    names,
    pose,
    RED,
    ROUNDING,
    SHAPES,
    spawn,
    spawning,
    TRIANGLE,
    twist,
)

# Dispatch


def test_every_request_has_a_handler():
    kinds = {each for each in vars(requests).values() if isinstance(each, type)}
    bases = {Request, AtPoint, HandRequest, OfNamespace}
    assert {each for each in kinds if issubclass(each, Request)} - bases == HANDLERS.keys()


# Spawn


def test_a_spawned_body_is_what_was_said_and_where(world):
    answer = world.apply(
        spawning(
            'box/3', Box(width=2.0, height=1.0), (1.0, -2.0, 0.3), color=RED, lifetime=1.0,
            mass=4.0, friction=0.25, elasticity=0.75, velocity=(1.0, 2.0), spin=3.0, group=5,
            sensor=True,
        )
    ).answer  # fmt: skip

    assert answer == Answer(subject='box/3', message='spawned box/3')
    assert body(world, 'box/3') == Body(
        name='box/3', shape=Box(width=2.0, height=1.0), color=RED, mass=4.0, density=2.0,
        friction=0.25, elasticity=0.75, anchored=False, kinematic=False, group=5, sensor=True,
        expires=240,
    )  # fmt: skip
    assert pose(world, 'box/3') == pytest.approx((1.0, -2.0, 0.3), abs=ROUNDING)
    assert twist(world, 'box/3') == pytest.approx((1.0, 2.0, 3.0), abs=ROUNDING)
    assert len(world) == 1
    assert 'box/3' in world
    assert 'box/4' not in world


def test_what_is_not_said_comes_from_the_settings():
    world = World(settings=WorldSettings(density=3.0, friction=0.1, elasticity=0.2))

    spawn(world, 'a/7')

    assert body(world, 'a/7') == Body(
        name='a/7', shape=DISC, color=color_of('a/7'), mass=None, density=3.0, friction=0.1,
        elasticity=0.2, anchored=False, kinematic=False, group=0, sensor=False, expires=None,
    )  # fmt: skip
    assert body(world, 'a/7').total_mass == pytest.approx(3.0 * math.pi / 4, rel=1e-12)


@pytest.mark.parametrize('shape', SHAPES.values(), ids=SHAPES.keys())
@pytest.mark.parametrize('anchored', [False, True])
def test_the_pose_of_any_shape_is_its_origins(shape, anchored, world):
    spawn(world, 'a/0', shape, (3.0, -4.0, 2.5), anchored=anchored)

    assert pose(world, 'a/0') == pytest.approx((3.0, -4.0, 2.5), abs=ROUNDING)


# Delete


def test_a_deleted_body_is_gone_and_its_name_can_be_used_again_and_comes_last(world):
    spawn(world, 'a/0', DISC, mass=3.0, velocity=(1.0, 0.0))
    spawn(world, 'a/1', DISC)

    answer = world.apply(Delete(name='a/0')).answer

    assert answer == Answer(subject='a/0', message='deleted a/0')
    assert names(world) == ('a/1',)
    assert 'a/0' not in world
    with pytest.raises(UnknownBody):
        world.apply(Delete(name='a/0'))
    spawn(world, 'a/0', DISC)
    assert names(world) == ('a/1', 'a/0')
    assert body(world, 'a/0').mass is None
    assert twist(world, 'a/0').tolist() == [0.0, 0.0, 0.0]


def test_all_bodies_of_a_namespace_are_deleted_and_no_others(world):
    for name in ('a/0', 'b/0', 'a/1', 'ab/0', 'a/b/0'):
        spawn(world, name, DISC)

    answer = world.apply(DeleteAll(namespace='a')).answer

    assert answer == Answer(message='deleted 2 bodies')
    assert names(world) == ('b/0', 'ab/0', 'a/b/0')
    assert world.apply(DeleteAll(namespace='ab')).answer == Answer(message='deleted 1 body')
    assert world.apply(DeleteAll(namespace='nobody')).answer == Answer(message='deleted 0 bodies')


def test_bodies_and_joints_are_deleted_together_or_not_at_all(world):
    for number in range(3):
        spawn(world, f'a/{number}', DISC, (3.0 * number, 0.0, 0.0))
        join(world, 'pin', [(3.0 * number, 0.0)], f'j/{number}', b='world')

    with pytest.raises(UnknownJoint) as refused:
        world.apply(DeleteBodies(names=('a/0',), joints=('j/1', 'j/9')))
    assert (refused.value.field, len(world.scene.joints)) == ('joints', 3)
    assert world.apply(DeleteBodies(names=('a/0',), joints=('j/0', 'j/1'))).answer.subject == 'a/0'

    assert names(world) == ('a/1', 'a/2')
    assert [joint.name for joint in world.scene.joints] == ['j/2']
    assert world.apply(DeleteBodies(names=(), joints=('j/2',))).answer.message == 'deleted 1 joint'


# Lifetime


@pytest.mark.parametrize(
    ('rate', 'lifetime', 'steps'),
    [(240.0, 0.1, 24), (240.0, 1e-9, 1), (240.0, 1 / 240, 1), (240.0, 1.5 / 240, 2),
     (1000.0, 0.7, 700), (60.0, 0.05, 3), (10000.0, 30673452 / 10000.0, 30673452)],
)  # fmt: skip
def test_a_lifetime_ends_at_its_step(rate, lifetime, steps):
    world = World(physics_rate=rate)
    spawn(world, 'a/0', DISC)
    world.step(7)

    spawn(world, 'a/0', DISC, lifetime=lifetime)

    assert body(world, 'a/0').expires == 7 + steps
    if steps < 1000:
        world.step(steps - 1)
        assert 'a/0' in world
        world.step(1)
        assert 'a/0' not in world


def test_who_dies_under_another_leaves_it_falling():
    world = World()
    spawn(world, 'floor/0', BOX, (0.0, -0.5, 0.0), anchored=True, lifetime=0.5)
    spawn(world, 'a/0', BOX, (0.0, 0.5, 0.0))
    world.step(120)
    assert pose(world, 'a/0')[1] == pytest.approx(0.5, abs=0.005)

    world.step(120)

    # It rested in the slop of 5 mm, and fell for half a second.
    assert pose(world, 'a/0')[1] == pytest.approx(0.5 - 9.81 / 8, abs=0.02)


# A full world


def test_a_full_world_takes_no_more_but_changes_what_it_has():
    world = World(settings=WorldSettings(max_bodies=2))
    spawn(world, 'a/0')
    spawn(world, 'a/1')

    with pytest.raises(WorldFull):
        spawn(world, 'a/2')
    spawn(world, 'a/1', BOX)
    world.apply(Delete(name='a/0'))
    spawn(world, 'a/2')

    assert names(world) == ('a/1', 'a/2')


def test_a_world_made_smaller_keeps_its_bodies():
    world = World()
    for number in range(3):
        spawn(world, f'a/{number}')

    world.apply(Configure(changes={'max_bodies': 1}))

    assert len(world) == 3
    with pytest.raises(WorldFull):
        spawn(world, 'a/3')


# Frames


@pytest.mark.parametrize('shape', [DISC, ELL], ids=['centred', 'off-centre'])
@pytest.mark.parametrize('anchored', [False, True])
def test_a_pose_may_be_relative_to_a_turned_body(shape, anchored, world):
    spawn(world, 'table/0', shape, (2.0, 1.0, math.pi / 2), anchored=anchored)

    spawn(world, 'cup/0', DISC, (3.0, 1.0, 0.2), frame='table/0')

    # Ahead along its x axis is up; left of it is to the left.
    assert pose(world, 'cup/0') == pytest.approx((1.0, 4.0, math.pi / 2 + 0.2), abs=1e-12)


def test_a_frame_is_where_the_body_is_by_then(world):
    spawn(world, 'table/0', DISC, velocity=(1.0, 0.0), spin=math.pi / 2)
    world.step(240)

    spawn(world, 'cup/0', DISC, (3.0, 0.0, 0.0), frame='table/0')

    assert pose(world, 'cup/0') == pytest.approx((1.0, 3.0, math.pi / 2), abs=1e-9)
    # It is put there, not tied to it.
    assert twist(world, 'cup/0').tolist() == [0.0, 0.0, 0.0]


def test_a_body_can_be_moved_relative_to_itself(world):
    spawn(world, 'a/0', DISC, (1.0, 1.0, math.pi))

    spawn(world, 'a/0', DISC, (2.0, 0.0, 0.0), frame='a/0')

    assert pose(world, 'a/0') == pytest.approx((-1.0, 1.0, math.pi), abs=1e-12)


def test_commanded_poses_may_be_relative_to_a_body_that_is_moved_too(world):
    spawn(world, 'a/0', DISC, (1.0, 0.0, math.pi / 2))
    spawn(world, 'a/1', DISC)

    world.apply(
        Command(names=('a/0', 'a/1'), poses=((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)), frame='a/0')
    )

    assert pose(world, 'a/0') == pytest.approx((1.0, 1.0, math.pi / 2), abs=1e-12)
    assert pose(world, 'a/1') == pytest.approx((0.0, 0.0, math.pi / 2), abs=1e-12)


# Time


def test_time_is_the_steps_and_never_a_running_sum():
    world = World(physics_rate=300.0)

    world.step(7)

    assert world.step_count == world.snapshot().step == 7
    assert world.stamp == world.snapshot().stamp == 23_333_333


def test_a_snapshot_is_not_changed_by_what_follows(world):
    spawn(world, 'a/0', TRIANGLE, velocity=(1.0, 0.0))
    snapshot = world.snapshot()
    poses, twists = snapshot.poses.copy(), snapshot.twists.copy()

    snapshot.poses.flags.writeable = False
    world.step(10)
    world.apply(DeleteAll())

    assert np.array_equal(snapshot.poses, poses)
    assert np.array_equal(snapshot.twists, twists)
    assert snapshot.scene.names == ('a/0',)


def test_a_scene_is_the_same_object_until_something_changes(world):
    spawn(world, 'a/0', DISC)
    scene = world.snapshot().scene

    world.step(3)
    world.apply(Command(names=('a/0',), poses=((1.0, 0.0, 0.0),)))
    assert world.snapshot().scene is scene

    join(world, 'axle', [(1.0, 0.0)])
    joined = world.snapshot().scene
    assert joined is not scene
    spawn(world, 'a/0', DISC, (1.0, 0.0, 0.0), color=RED)
    assert world.snapshot().scene is not joined


def test_a_region_of_a_medium_is_not_released(world):
    region = {'anchored': True, 'sensor': True, 'medium': {'density': 1000.0}}
    spawn(world, 'pool/0', BOX, **region)
    digest = world.digest()

    with pytest.raises(BadProperty) as refused:
        world.apply(Release(point=(0.0, 0.0)))

    assert refused.value.field == 'point'
    assert world.digest() == digest
    # A kinematic one moves on, as it may.
    spawn(world, 'flow/0', BOX, (5.0, 0.0, 0.0), kinematic=True, **region)
    world.apply(Release(point=(5.0, 0.0)))
    assert not world.scene.bodies[1].anchored
