# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Wrenches: accelerations, timeouts, and their beginning and end without a jump of velocity."""

import math

from physsim_ros.model.requests import Command, Configure
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Disc
from physsim_ros.simulation.world import World
import pytest

from ..building import (
    BOX,
    command,
    DISC,
    DT,
    pose,
    ROUNDING_OF_SUMS,
    spawn,
    twist,
    unlimit_wrenches,
)

REST = (0.0, 0.0, 0.0)


def test_a_torque_gives_its_angular_acceleration_exactly(world):
    unlimit_wrenches(world)
    spawn(world, 'a/0', Disc(radius=0.5), REST, mass=4.0, spin=1.0)

    command(world, 'a/0', wrench=(0.0, 0.0, 1.5))
    world.step(240)

    # I = ½ m r² = 0.5 kg m², so 3 rad/s².
    assert pose(world, 'a/0') == pytest.approx((0.0, 0.0, 1.0 + 1.5), abs=ROUNDING_OF_SUMS)
    assert twist(world, 'a/0') == pytest.approx((0.0, 0.0, 4.0), abs=ROUNDING_OF_SUMS)


def test_a_force_acts_in_world_axes_whichever_way_the_body_turns(world):
    unlimit_wrenches(world)
    spawn(world, 'a/0', BOX, (0.0, 0.0, 1.0), mass=1.0, spin=7.0)

    command(world, 'a/0', wrench=(1.0, 0.0, 0.0))
    world.step(240)

    assert twist(world, 'a/0') == pytest.approx((1.0, 0.0, 7.0), abs=ROUNDING_OF_SUMS)


# A timeout of 0 is no limit.
@pytest.mark.parametrize(
    ('timeout', 'steps'), [(0.5, 120), (0.1, 24), (1e-6, 1), (0.0101, 3), (0.0, math.inf)]
)
def test_a_wrench_acts_for_the_timeout_of_simulation_time(timeout, steps):
    world = World(settings=WorldSettings(gravity=(0.0, 0.0), command_timeout=timeout))
    spawn(world, 'a/0', DISC, mass=1.0)
    world.step(5)

    command(world, 'a/0', wrench=(240.0, 0.0, 0.0))
    for step in range(1, 140):
        world.step(1)
        assert twist(world, 'a/0')[0] == pytest.approx(min(step, steps), abs=1e-9)


@pytest.mark.parametrize(
    ('before', 'after', 'steps'), [(0.0, 0.1, 24), (2.0, 0.1, 24), (0.5, 2.0, 110)]
)
def test_another_timeout_holds_for_a_wrench_that_acts(before, after, steps):
    world = World(settings=WorldSettings(gravity=(0.0, 0.0), command_timeout=before))
    spawn(world, 'a/0', DISC, mass=1.0)
    command(world, 'a/0', wrench=(240.0, 0.0, 0.0))
    world.step(10)
    world.apply(Configure(changes={'command_timeout': after}))
    world.step(600)
    # Never longer than it was given when it was asked for.
    assert twist(world, 'a/0')[0] == pytest.approx(10 + steps, abs=1e-9)


def test_a_wrench_acts_until_the_next_one(world):
    spawn(world, 'a/0', DISC, mass=1.0)
    command(world, 'a/0', wrench=(1.0, 0.0, 0.0))
    world.step(60)
    # A new one counts from anew, 0.5 s.
    command(world, 'a/0', wrench=(0.0, 2.0, 0.0))
    world.step(100)
    assert twist(world, 'a/0') == pytest.approx((0.25, 200 * DT, 0.0), abs=ROUNDING_OF_SUMS)
    world.step(100)
    assert twist(world, 'a/0') == pytest.approx((0.25, 1.0, 0.0), abs=ROUNDING_OF_SUMS)

    command(world, 'a/0', wrench=(1.0, 0.0, 0.0))
    command(world, 'a/0', wrench=REST)
    world.step(24)
    assert twist(world, 'a/0') == pytest.approx((0.25, 1.0, 0.0), abs=ROUNDING_OF_SUMS)


def test_a_wrench_begins_and_ends_without_a_jump_of_velocity(world):
    spawn(world, 'a/0', DISC, mass=1.0, velocity=(1.0, 0.0))

    command(world, 'a/0', wrench=(100.0, 0.0, 10.0))
    assert twist(world, 'a/0') == pytest.approx((1.0, 0.0, 0.0), abs=ROUNDING_OF_SUMS)
    world.step(120)
    assert twist(world, 'a/0')[0] == pytest.approx(51.0, abs=1e-9)
    command(world, 'a/0', wrench=REST)
    assert twist(world, 'a/0')[0] == pytest.approx(51.0, abs=1e-9)


def test_a_wrench_that_only_one_of_two_is_given_moves_only_that(world):
    for number in range(2):
        spawn(world, f'a/{number}', DISC, (5.0 * number, 0.0, 0.0), mass=1.0)

    world.apply(Command(names=('a/1', 'a/0'), wrenches=((1.0, 0.0, 0.0), REST)))
    world.step(24)

    assert twist(world, 'a/0').tolist() == [0.0, 0.0, 0.0]
    assert twist(world, 'a/1')[0] == pytest.approx(0.1, abs=ROUNDING_OF_SUMS)
