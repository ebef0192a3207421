# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Range finders: the nearest distance in a cone."""

import math

from physsim_ros.model.robots.sensors import RangeFinder
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.sensing import read_range, Surroundings
import pytest

from .worlds import add_robot, plane, seen
from ..building import spawn


def read(world, row, finder, seed=1):
    return read_range(Surroundings(seen(world, seed)), row, finder)


def test_the_nearest_in_the_cone_counts():
    world = plane()
    spawn(world, 'ahead/0', Box(width=0.2, height=4.0), (2.1, 0.0, 0.0))
    spawn(world, 'aside/0', Disc(radius=0.1), (1.0, 0.35, 0.0))
    row = add_robot(world)

    narrow = read(world, row, RangeFinder(cone=0.2, range=(0.1, 5.0)))
    wide = read(world, row, RangeFinder(cone=1.0, rays=101, range=(0.1, 5.0)))

    assert narrow == pytest.approx(2.0, abs=1e-12)
    assert wide == pytest.approx(math.hypot(1.0, 0.35) - 0.1, abs=1e-3)


@pytest.mark.parametrize('finder', [RangeFinder(rays=1), RangeFinder(cone=0.0)])
def test_a_cone_without_width_is_a_ray_ahead(finder):
    world = plane()
    spawn(world, 'ahead/0', Disc(radius=0.5), (1.0, 0.0, 0.0))

    assert read(world, add_robot(world), finder) == pytest.approx(0.5)


def test_out_of_range_is_infinite():
    world = plane()
    spawn(world, 'ahead/0', Disc(radius=0.5), (1.0, 0.0, 0.0))
    row = add_robot(world)

    assert read(world, row, RangeFinder(range=(0.1, 0.4))) == math.inf
    assert read(world, row, RangeFinder(range=(0.6, 2.0))) == -math.inf


def test_noise_is_that_of_the_seed():
    world = plane()
    spawn(world, 'ahead/0', Disc(radius=0.5), (1.0, 0.0, 0.0))
    row = add_robot(world)
    finder = RangeFinder(noise=0.01)

    assert read(world, row, finder, 1) == read(world, row, finder, 1)
    assert read(world, row, finder, 1) != read(world, row, finder, 2)
    assert read(world, row, finder, 1) == pytest.approx(0.5, abs=0.06)
