# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bumpers: touched in their sector, by bodies and walls, not by sensors."""

import math

from physsim_ros.model.robots.sensors import Bumper
from physsim_ros.model.shapes import Box
from physsim_ros.sensing.touch import read_bumper
import pytest

from .worlds import add_robot, plane
from ..building import spawn


def bumped(world, row, *bumpers):
    """Return what bumpers have felt in the frame of the next steps."""
    world.reports_contacts = True
    world.step(8)
    snapshot = world.snapshot()
    contacts = world.contacts(snapshot)
    return [read_bumper(snapshot, contacts, row, bumper) for bumper in bumpers]


@pytest.fixture
def touching():
    """Return a world with a block 1 mm before a robot at the origin that looks along x."""
    world = plane()
    spawn(world, 'block/0', Box(width=1.0, height=1.0), (0.599, 0.0, 0.0), anchored=True)
    return world


def test_a_touch_in_front_is_felt_and_one_behind_is_not(touching):
    row = add_robot(touching, velocity=[0.1, 0.0])

    assert bumped(
        touching,
        row,
        Bumper(),
        Bumper(at=(0.0, 0.0, math.pi)),
        Bumper(at=(0.0, 0.0, math.pi), sector=math.tau),
        Bumper(at=(0.0, 0.0, 0.6), sector=1.0),
    ) == [True, False, True, False]


def test_the_front_turns_with_the_robot(touching):
    row = add_robot(touching, pose=(0.0, 0.0, math.pi), velocity=[0.1, 0.0])

    assert bumped(touching, row, Bumper()) == [False]


def test_a_sensor_touches_nobody():
    world = plane()
    spawn(world, 'zone/0', Box(width=1.0, height=1.0), (0.5, 0.0, 0.0), sensor=True)

    assert bumped(world, add_robot(world), Bumper(sector=math.tau)) == [False]


def test_a_wall_of_bounds_touches():
    world = plane(bounds=(-1.0, -1.0, 0.099, 1.0))

    assert bumped(world, add_robot(world, velocity=[0.1, 0.0]), Bumper()) == [True]
