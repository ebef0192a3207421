# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Flight, commands, lost bodies and energy in the engine."""

import math
import time

import numpy as np
from physsim_ros.engine import pymunk_bodies
from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Anchored
from physsim_ros.model.requests import Command, Delete
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Chain
from physsim_ros.simulation.world import World
import pymunk
import pytest

from ..building import (
    BOX,
    command,
    DISC,
    DT,
    ELL,
    G,
    pose,
    ROUNDING_OF_SUMS,
    SHAPES,
    spawn,
    twist,
    unlimit_wrenches,
)

REST = (0.0, 0.0, 0.0)
YARD = WorldSettings(bounds=(-20.0, 0.0, 20.0, 40.0))


# Flight, and what pose and twist are of


@pytest.mark.parametrize('shape', SHAPES.values(), ids=SHAPES.keys())
def test_free_flight_is_exact_for_any_shape(shape):
    world = World()
    spawn(world, 'a/0', shape, (1.0, 2.0, 0.3), velocity=(3.0, 4.0), spin=5.0)
    center = world.snapshot().centers[0]

    world.step(240)

    # Of the centre of mass: the origin of an off-centre shape goes round it.
    assert world.snapshot().centers[0] == pytest.approx(
        np.add(center, (3.0, 4.0 - G / 2)), abs=ROUNDING_OF_SUMS
    )
    assert twist(world, 'a/0') == pytest.approx((3.0, 4.0 - G, 5.0), abs=ROUNDING_OF_SUMS)
    assert pose(world, 'a/0')[2] == pytest.approx(0.3 + 5.0, abs=ROUNDING_OF_SUMS)


def test_a_commanded_pose_is_the_origins_and_a_commanded_twist_the_centres(world):
    spawn(world, 'a/0', ELL, (5.0, 5.0, 1.0))

    command(world, 'a/0', pose=(1.0, 2.0, 0.3), twist=(0.5, -0.5, 2.0))

    assert pose(world, 'a/0') == pytest.approx((1.0, 2.0, 0.3), abs=1e-12)
    assert twist(world, 'a/0').tolist() == [0.5, -0.5, 2.0]
    center = world.snapshot().centers[0]
    world.step(240)
    assert world.snapshot().centers[0] == pytest.approx(
        np.add(center, (0.5, -0.5)), abs=ROUNDING_OF_SUMS
    )


def test_a_commanded_pose_keeps_the_motion_and_a_commanded_twist_the_pose():
    world = World()
    spawn(world, 'a/0', ELL, velocity=(1.0, 2.0), spin=3.0)
    world.step(24)

    command(world, 'a/0', pose=(9.0, 9.0, 0.0))

    assert twist(world, 'a/0') == pytest.approx((1.0, 2.0 - G / 10, 3.0), abs=ROUNDING_OF_SUMS)
    world.step(24)
    assert twist(world, 'a/0') == pytest.approx((1.0, 2.0 - G / 5, 3.0), abs=ROUNDING_OF_SUMS)
    before = pose(world, 'a/0')
    command(world, 'a/0', twist=(1.0, 0.0, 0.0))
    assert pose(world, 'a/0') == pytest.approx(before, abs=1e-12)
    assert twist(world, 'a/0').tolist() == [1.0, 0.0, 0.0]


def test_a_resting_body_that_is_thrown_flies_exactly():
    world = World(settings=YARD)
    spawn(world, 'a/0', BOX, (0.0, 0.5, 0.0))
    world.step(480)
    start = pose(world, 'a/0')

    command(world, 'a/0', twist=(2.0, 5.0, 0.0))
    world.step(120)

    assert pose(world, 'a/0') == pytest.approx(
        np.add(start, (1.0, 2.5 - G / 8, 0.0)), abs=ROUNDING_OF_SUMS
    )


def test_an_anchored_body_takes_a_pose_only(world):
    spawn(world, 'a/0', BOX, anchored=True)

    command(world, 'a/0', pose=(1.0, 2.0, 0.3))
    assert pose(world, 'a/0').tolist() == [1.0, 2.0, 0.3]
    for rows in ({'twist': REST}, {'wrench': REST}, {'pose': REST, 'twist': (1.0, 0.0, 0.0)}):
        with pytest.raises(Anchored):
            command(world, 'a/0', **rows)
    assert pose(world, 'a/0').tolist() == [1.0, 2.0, 0.3]


def test_a_command_moves_many_bodies_at_once(world):
    for number in range(3):
        spawn(world, f'a/{number}', DISC)
    poses, twists = ((1.0, 0.0, 0.0), (2.0, 0.0, 0.0)), ((3.0, 0.0, 0.0), (4.0, 0.0, 0.0))

    answer = world.apply(Command(names=('a/2', 'a/0'), poses=poses, twists=twists)).answer

    assert answer == Answer(message='set pose and velocity of 2 bodies')
    assert world.snapshot().poses[:, 0].tolist() == [2.0, 0.0, 1.0]
    assert world.snapshot().twists[:, 0].tolist() == [4.0, 0.0, 3.0]


# Lost bodies


def test_a_body_that_leaves_the_range_of_numbers_is_removed_and_told(world):
    unlimit_wrenches(world)
    spawn(world, 'a/0', DISC, mass=1e-9)
    spawn(world, 'a/1', DISC, (5.0, 0.0, 0.0), velocity=(1.0, 0.0))
    command(world, 'a/0', wrench=(-1e12, 0.0, 0.0))

    lost = [world.step(4) for _ in range(3)]

    assert lost == [('a/0',), (), ()]
    assert 'a/0' not in world
    assert pose(world, 'a/1') == pytest.approx((5.0 + 12 * DT, 0.0, 0.0), abs=ROUNDING_OF_SUMS)


@pytest.mark.parametrize(('speed', 'lost'), [(0.5e12, ()), (2e12, ('a/0',))])
def test_a_body_is_lost_from_a_speed_of_1e12_metres_a_second_on(world, speed, lost):
    unlimit_wrenches(world)
    spawn(world, 'a/0', DISC, mass=1e-3)
    command(world, 'a/0', wrench=(speed * 1e-3 / DT, 0.0, 0.0))

    assert world.step(1) == lost


def test_a_body_that_is_lost_in_the_last_step_of_its_life_goes_once(world):
    unlimit_wrenches(world)
    spawn(world, 'a/0', DISC, mass=1e-9, lifetime=DT)
    command(world, 'a/0', wrench=(-1e12, 0.0, 0.0))

    lost = world.step(4)

    assert lost == ('a/0',)
    assert 'a/0' not in world


# Energy and momentum


def test_energy_and_momentum_are_those_of_the_formulas():
    world = World(settings=WorldSettings(gravity=(1.0, -G)))
    empty = world.snapshot()
    assert (empty.kinetic_energy, empty.potential_energy) == (0.0, 0.0) == empty.momentum
    spawn(world, 'a/0', ELL, (1.0, 2.0, 0.0), mass=3.0, velocity=(4.0, 5.0), spin=6.0)
    spawn(world, 'a/1', DISC, (9.0, 9.0, 0.0), mass=2.0, velocity=(-1.0, 0.0))
    spawn(world, 'a/2', DISC, (20.0, 9.0, 0.0), mass=2.0, velocity=(7.0, 0.0), kinematic=True)
    spawn(world, 'a/3', DISC, (30.0, 9.0, 0.0), mass=2.0, anchored=True)

    snapshot = world.snapshot()

    moment = 3.0 * ELL.form.gyration
    assert snapshot.kinetic_energy == pytest.approx(
        3.0 * 41.0 / 2 + moment * 36.0 / 2 + 2.0 * 1.0 / 2, rel=1e-12
    )
    center = (1.0 + 5.0 / 6.0, 2.0 + 5.0 / 6.0)
    assert snapshot.potential_energy == pytest.approx(
        -3.0 * (center[0] - G * center[1]) - 2.0 * (9.0 - G * 9.0), rel=1e-12
    )
    assert snapshot.momentum == pytest.approx((3.0 * 4.0 - 2.0, 15.0), rel=1e-12)


def test_a_body_that_is_faster_than_any_number_is_lost(world):
    for number in range(3):
        spawn(world, f'a/{number}', BOX, (1.0 * number, 0.0, 0.0))
    world.space.bodies.by_name['a/1'].pm_body.velocity = (1e300, 0.0)
    assert 'a/1' in world.step(1)
    world.step(100)
    assert world.snapshot().scene.names[0] == 'a/0'
    assert pose(world, 'a/0').tolist() == [0.0, 0.0, 0.0]


# Where nothing can move


def test_a_body_falls_as_exactly_after_steps_in_which_nothing_could_move():
    fallen = []
    for still in (240, 0):
        world = World(settings=YARD)
        spawn(world, 'floor/0', BOX, (5.0, 0.5, 0.0), anchored=True)
        world.step(still)
        spawn(world, 'a/0', ELL, (0.0, 8.0, 0.3), spin=1.0)
        world.step(600)
        assert world.step_count == still + 600
        fallen.append((world.snapshot().poses.tobytes(), world.snapshot().twists.tobytes()))

    assert fallen[0] == fallen[1]


def test_the_contacts_of_the_last_body_that_could_move_end_with_it(world):
    world.reports_contacts = True
    spawn(world, 'floor/0', BOX, (0.0, -0.5, 0.0), anchored=True)
    spawn(world, 'a/0', BOX, (0.0, 0.5, 0.0))
    world.step(8)
    assert len(world.contacts(world.snapshot()).pairs) == 1
    world.step(3)
    world.apply(Delete(name='a/0'))
    world.step(1)
    assert len(world.contacts(world.snapshot()).pairs) == 0


def test_a_body_that_cannot_move_is_gone_when_its_life_ends(world):
    spawn(world, 'floor/0', BOX, (0.0, 0.0, 0.0), anchored=True, lifetime=0.5)
    world.step(119)
    assert 'floor/0' in world
    world.step(1)
    assert 'floor/0' not in world


@pytest.mark.parametrize('shape', [BOX, DISC], ids=['box', 'disc'])
def test_a_point_is_of_a_body_up_to_a_hundred_millionth_of_a_metre_from_it(world, shape):
    spawn(world, 'a/0', shape, (0.0, 0.0, 0.0))
    assert world.space.bodies.at((0.5 + 5e-10, 0.0)) == ['a/0']
    assert world.space.bodies.at((0.5 + 1e-8, 0.0)) == []


@pytest.mark.cost
def test_many_pieces_in_a_row_enter_the_engine_in_any_place_of_its_tree(monkeypatch):
    """One after the other they make a tree as deep as there are pieces."""
    points = tuple((0.06 * number, math.sin(0.1 * number)) for number in range(1000))
    world = World()
    spawn(world, 'a/0', Chain(points=points, thickness=0.1))
    (chain,) = world.scene.bodies

    def duration(block: int) -> float:
        monkeypatch.setattr(pymunk_bodies, '_BLOCK', block)
        pm_space = pymunk.Space()
        made = [pymunk_bodies.build_body(chain).pm_body for _ in range(6)]
        for number, pm_body in enumerate(made):
            pm_body.position = 0.0, 3.0 * number
        began = time.thread_time()
        for pm_body in made:
            pm_space.add(pm_body, *pm_body.shapes)
        return time.thread_time() - began

    block = pymunk_bodies._BLOCK  # noqa: SLF001 - what is tested
    assert min(duration(block) for _ in range(3)) < 0.7 * min(duration(1000) for _ in range(3))
