# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A world renewed from its own state goes on as if nothing had been, and always alike."""

from itertools import pairwise

import numpy as np
from physsim_ros.model.requests import Delete, Restore
from physsim_ros.model.settings import WorldSettings
from physsim_ros.simulation.world import World

from ..building import BOX, G, join, pose, spawn, stack

FLOOR = WorldSettings(bounds=(-10.0, 0.0, 10.0, 20.0))


def settled(count: int = 10) -> World:
    world = World(settings=FLOOR)
    stack(world, count)
    world.step(2400)
    return world


def fastest(world: World) -> float:
    return float(np.abs(world.snapshot().twists).max())


def test_a_resting_stack_does_not_stir_where_it_is_renewed():
    world = settled()
    before = world.snapshot()
    stirred = []
    for _ in range(5):
        world.renew()
        for _ in range(60):
            world.step(1)
            stirred.append(fastest(world))
    # The contract allows 0.01 m/s.
    assert max(stirred) < 1e-3
    np.testing.assert_allclose(world.snapshot().poses, before.poses, atol=1e-4)


def test_joints_of_a_renewed_world_have_the_impulses_of_before():
    world = World(settings=WorldSettings(gravity=(3.0, -G)))
    spawn(world, 'bob/0', BOX, (0.0, -2.0, 0.0))
    join(world, 'axle', [(0.0, 0.0)], a='bob/0', b='world')
    world.step(240)

    before = world.renew().memory.joints
    after = world.renew().memory.joints

    assert np.all(before[0] != 0.0)
    np.testing.assert_array_equal(after, before)


def test_who_resumes_at_a_letting_go_goes_on_alike():
    world, saved, resumed = settled(6), World(), World()
    world.apply(Delete(name='stack/2'))
    before, digest = world.snapshot(), world.digest()
    state, key = world.save(), world.renew()
    assert world.digest() == digest
    np.testing.assert_array_equal(world.snapshot().twists, before.twists)
    resumed.resume(key)
    saved.apply(Restore(state=state))
    for each in (world, saved, resumed):
        each.step(60)
    assert resumed.digest() == world.digest()
    np.testing.assert_array_equal(saved.snapshot().poses, world.snapshot().poses)


def test_bodies_of_the_space_before_last_are_as_good_as_new():
    one, other = settled(5), settled(5)
    for _ in range(4):
        one.step(100)
        other.step(100)
        one.build_bodies(100)
        one.renew()
        other.renew()
        assert one.digest() == other.digest()


def test_a_call_that_builds_ahead_does_no_more_than_it_is_told():
    world = settled(8)
    for number in range(4):
        ends = f'stack/{2 * number}', f'stack/{2 * number + 1}'
        points = [tuple(pose(world, each)[:2]) for each in ends]
        join(world, 'rod', points, name=f'rod/{number}', a=ends[0], b=ends[1])
    world.step(4)
    retired = world.space
    world.renew()
    left = [(4, 8)]
    while not world.is_built_ahead:
        world.build_bodies(1)
        left.append((len(retired.joints.by_name), len(retired.bodies.by_name)))
    assert left[-1] == (0, 0)
    assert all(sum(before) - sum(after) <= 1 for before, after in pairwise(left))


def test_what_has_changed_since_is_not_taken_from_before():
    one, other = settled(4), settled(4)
    for world in (one, other):
        world.renew()
        spawn(world, 'stack/1', BOX, (3.0, 0.5, 0.0), density=7.0)
        spawn(world, 'new/0', BOX, (5.0, 0.5, 0.0))
        world.step(50)
    one.build_bodies(100)
    one.renew()
    other.renew()
    one.step(200)
    other.step(200)
    assert one.digest() == other.digest()


def test_impulses_of_the_frame_are_taken_over():
    one, other = settled(2), settled(2)
    for world in (one, other):
        world.reports_contacts = True
        world.step(4)
        world.contacts(world.snapshot())
        world.step(2)
    one.renew()
    one.step(2)
    other.step(2)
    got, expected = (world.contacts(world.snapshot()) for world in (one, other))
    np.testing.assert_array_equal(got.pairs, expected.pairs)
    np.testing.assert_allclose(got.impulses, expected.impulses, rtol=1e-6, atol=1e-9)
