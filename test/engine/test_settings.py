# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Settings that change while the world runs: gravity, damping, walls, iterations, defaults."""

import numpy as np
from physsim_ros.model.requests import Configure
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box
from physsim_ros.simulation.world import World
import pytest

from ..building import DISC, ELL, pose, ROUNDING_OF_SUMS, spawn, stack, twist

REST = (0.0, 0.0, 0.0)
YARD = WorldSettings(bounds=(-20.0, 0.0, 20.0, 40.0))


@pytest.mark.parametrize('gravity', [(0.0, 0.0), (0.0, 9.81), (3.0, -20.0)])
def test_a_change_of_gravity_lets_no_velocity_jump(gravity):
    world = World()
    spawn(world, 'a/0', ELL, REST, velocity=(1.0, 2.0), spin=1.0)
    world.step(24)
    before, center = twist(world, 'a/0'), world.snapshot().centers[0]

    world.apply(Configure(changes={'gravity': gravity}))

    assert twist(world, 'a/0') == pytest.approx(before, abs=ROUNDING_OF_SUMS)
    world.step(240)
    assert twist(world, 'a/0') == pytest.approx(
        np.add(before, (*gravity, 0.0)), abs=ROUNDING_OF_SUMS
    )
    assert world.snapshot().centers[0] == pytest.approx(
        center + before[:2] + np.array(gravity) / 2, abs=ROUNDING_OF_SUMS
    )


def test_damping_takes_its_share_each_second(world):
    spawn(world, 'a/0', DISC, velocity=(8.0, 0.0), spin=4.0)

    world.apply(Configure(changes={'damping': 0.75}))
    world.step(240)
    assert twist(world, 'a/0') == pytest.approx((2.0, 0.0, 1.0), rel=1e-9)
    world.apply(Configure(changes={'damping': 0.0}))
    world.step(240)
    assert twist(world, 'a/0') == pytest.approx((2.0, 0.0, 1.0), rel=1e-9)


def test_damping_of_1_stops_what_is_loose_and_nothing_kinematic(world):
    spawn(world, 'a/0', DISC, velocity=(8.0, 0.0))
    spawn(world, 'robot/0', DISC, (0.0, 5.0, 0.0), velocity=(1.0, 0.0), kinematic=True)

    world.apply(Configure(changes={'damping': 1.0}))
    world.step(240)

    assert twist(world, 'a/0').tolist() == [0.0, 0.0, 0.0]
    assert pose(world, 'robot/0')[0] == pytest.approx(1.0, abs=ROUNDING_OF_SUMS)


def test_walls_are_raised_moved_and_taken_down_while_the_world_runs(world):
    spawn(world, 'a/0', DISC, velocity=(4.0, 0.0))

    world.apply(Configure(changes={'bounds': (-5.0, -5.0, 5.0, 5.0)}))
    world.step(480)
    assert pose(world, 'a/0')[0] == pytest.approx(9.0 - 8.0, abs=0.05)
    world.apply(Configure(changes={'bounds': (-2.0, -5.0, 5.0, 5.0)}))
    world.step(240)
    # At x = -1.5 it turned back: 2.5 m there, 1.5 m back.
    assert pose(world, 'a/0')[0] == pytest.approx(0.0, abs=0.05)
    world.apply(Configure(changes={'bounds': None}))
    assert world.save().memory.walls == 0
    world.step(480)
    assert pose(world, 'a/0')[0] == pytest.approx(8.0, abs=0.05)


def test_walls_are_made_of_the_default_material():
    world = World(settings=WorldSettings(gravity=(0.0, 0.0), bounds=(-5.0, -5.0, 5.0, 5.0)))
    spawn(world, 'a/0', DISC, (3.0, 0.0, 0.0), velocity=(4.0, 0.0), elasticity=1.0)

    world.apply(Configure(changes={'elasticity': 0.25}))
    world.step(240)

    assert twist(world, 'a/0')[0] == pytest.approx(-4.0 * 0.5, abs=1e-6)


@pytest.mark.parametrize(
    'changes',
    [{'density': 2.0}, {'command_timeout': 2.0}, {'max_bodies': 99}, {'iterations': 16},
     {'bounds': (-20.0, 0.0, 20.0, 40.0)}],
)  # fmt: skip
def test_a_stack_on_a_wall_does_not_stir_at_what_does_not_concern_it(changes):
    world, other = World(settings=YARD), World(settings=YARD)
    for each in (world, other):
        stack(each, 6)
        each.step(480)

    world.apply(Configure(changes=changes))
    for each in (world, other):
        each.step(60)

    assert np.array_equal(world.snapshot().poses, other.snapshot().poses)


def test_more_iterations_hold_a_stack_better():
    speeds = []
    for iterations in (1, 30):
        world = World(settings=YARD)
        stack(world, 8)
        world.apply(Configure(changes={'iterations': iterations}))
        world.step(120)
        speeds.append(float(np.abs(world.snapshot().twists).max()))

    assert speeds[0] > 2 * speeds[1]


def test_a_heavy_box_lies_on_a_light_one():
    world = World()
    spawn(world, 'floor/0', Box(width=10.0, height=1.0), (0.0, -0.5, 0.0), anchored=True)
    for number, mass in enumerate((1.0, 30.0)):
        box = Box(width=0.5, height=0.5)
        spawn(world, f'box/{number}', box, (0.0, 0.25 + 0.5 * number, 0.0), mass=mass)
    for _ in range(100):
        world.step(24)
        assert pose(world, 'box/1') == pytest.approx((0.0, 0.75, 0.0), abs=5e-3)


def test_a_change_of_defaults_changes_no_body(world):
    spawn(world, 'a/0', DISC)
    before = world.snapshot().scene.bodies[0]

    world.apply(Configure(changes={'density': 9.0, 'friction': 0.1, 'elasticity': 0.1}))
    spawn(world, 'a/1', DISC, (3.0, 0.0, 0.0))

    first, second = world.snapshot().scene.bodies
    assert first == before
    assert (second.density, second.friction, second.elasticity) == (9.0, 0.1, 0.1)
