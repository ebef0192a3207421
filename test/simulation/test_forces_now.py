# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The forces of a world that has made no step yet, against those that its steps report."""

import math

from physsim_ros.files import load_world, shipped_lessons
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import Join
from physsim_ros.model.settings import WorldSettings
from physsim_ros.simulation.world import forces_now, World
import pytest

from ..building import BOX, DISC, spawn

RATE = 240.0
G = 9.81
YARD = WorldSettings(bounds=(-20.0, 0.0, 20.0, 40.0))


def lesson(name: str) -> WorldState:
    """Return the world of a lesson."""
    return load_world(shipped_lessons() / f'{name}.yaml')


def test_a_block_on_a_slope_has_its_normal_force_before_the_first_step():
    solved = forces_now(lesson('slope'), RATE)
    contacts, snapshot = solved
    ((slope, ice),) = contacts.pairs.tolist()
    assert (snapshot.scene.names[slope], snapshot.scene.names[ice]) == ('slope/0', 'ice/0')
    (force,) = contacts.impulses * RATE / contacts.steps
    assert math.hypot(*force) == pytest.approx(2.0 * G * math.cos(math.radians(30.0)), rel=1e-3)


def test_the_rod_of_a_pendulum_bears_its_weight_along_the_rod():
    state = lesson('pendulum')
    solved = forces_now(state, RATE)
    (body,), (pull,) = state.bodies, solved[1].pulls
    # At rest, the part of the weight along the rod, which ends at the origin of heights.
    lean = math.atan2(pull[0], -pull[1])
    assert math.hypot(*pull) == pytest.approx(body.body.total_mass * G * math.cos(lean), rel=5e-3)


def test_what_falls_or_hits_has_no_force_and_what_bounces_rests():
    world = World(physics_rate=RATE, settings=YARD)
    spawn(world, 'rests/0', BOX, (0.0, 0.5, 0.0), elasticity=1.0)
    spawn(world, 'hits/0', BOX, (4.0, 0.5, 0.0), velocity=(0.0, -0.1))
    spawn(world, 'falls/0', DISC, (8.0, 5.0, 0.0))
    before = world.digest()
    solved = forces_now(world.save(), RATE)
    contacts, snapshot = solved
    names = [snapshot.scene.names[row] for row in contacts.pairs[:, 0]]
    assert names == ['rests/0']
    weight = snapshot.scene.bodies[0].total_mass * G
    assert contacts.impulses[0] * RATE == pytest.approx((0.0, -weight), rel=1e-3, abs=1e-5)
    # The world is as it was.
    assert world.digest() == before
    assert world.step_count == 0


@pytest.mark.parametrize(('count', 'share'), [(1, 1e-3), (3, 2e-3), (5, 5e-3)])
def test_the_loads_of_a_stack_are_those_of_later_steps(count, share):
    world = World(physics_rate=RATE, settings=YARD)
    for number in range(count):
        spawn(world, f'a/{number}', BOX, (0.0, 0.5 + number, 0.0))
    solved = forces_now(world.save(), RATE)
    world.reports_contacts = True
    world.step(120)
    world.clear_contacts()
    world.step(1)
    later = world.contacts(world.snapshot())
    assert solved[0].pairs.tolist() == later.pairs.tolist()
    assert solved[0].impulses[:, 1] == pytest.approx(later.impulses[:, 1], rel=share)


def test_a_rod_that_bears_nothing_has_no_force_beside_a_body_at_rest():
    world = World(physics_rate=RATE, settings=YARD)
    spawn(world, 'rests/0', BOX, (0.0, 0.5, 0.0))
    spawn(world, 'bob/0', DISC, (6.0, 5.0, 0.0))
    world.apply(Join(name='rod/0', kind=JointKind.ROD, points=((6.0, 5.0), (5.0, 5.0)), a='bob/0'))

    _, snapshot = forces_now(world.save(), RATE)

    # While the box comes to rest, the bob begins to fall on its circle.
    (force,) = snapshot.forces
    assert force < 2e-3 * snapshot.scene.bodies[1].total_mass * G


def test_a_world_that_is_too_large_is_not_solved():
    world = World(physics_rate=RATE)
    for number in range(201):
        spawn(world, f'a/{number}', DISC, (2.0 * number, 0.5, 0.0))
    assert forces_now(world.save(), RATE) is None


def test_what_would_fall_on_something_later_has_no_force_while_others_come_to_rest():
    world = World(physics_rate=RATE, settings=YARD)
    for number in range(10):
        spawn(world, f'stack/{number}', BOX, (0.0, 0.5 + number, 0.0))
    spawn(world, 'falls/0', BOX, (5.0, 0.502, 0.0))

    contacts, snapshot = forces_now(world.save(), RATE)

    touching = {snapshot.scene.names[row] for row in contacts.pairs.flat if row >= 0}
    assert touching == {f'stack/{number}' for number in range(10)}
