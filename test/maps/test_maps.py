# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Maps of worlds, and worlds of maps."""

import math

import numpy as np
from physsim_ros.maps import anchored_grid, Grid, MOST_CELLS, walls_of
from physsim_ros.model.errors import BadProperty, BadSize, Malformed, WorldFull
from physsim_ros.model.shapes import Box, Disc
import pytest

from ..building import body_at, SHAPES, spawn
from ..sensing.worlds import plane

CORNER = np.array([[True, True, True], [True, False, False]])


def grid_of(world, resolution=0.1):
    return anchored_grid(world.snapshot(), resolution)


def centers_of(grid):
    """Return (rows, columns, 2) float64: the centres of the cells, world."""
    x, y, yaw = grid.origin
    rows, columns = grid.occupied.shape
    ahead = (np.arange(columns) + 0.5) * grid.resolution
    aside = (np.arange(rows)[:, None] + 0.5) * grid.resolution
    cos, sin = math.cos(yaw), math.sin(yaw)
    return np.stack((x + cos * ahead - sin * aside, y + sin * ahead + cos * aside), axis=-1)


def test_walls_of_a_grid_are_its_rectangles_in_the_world():
    grid = Grid(occupied=CORNER, resolution=0.5, origin=(1.0, 2.0, math.pi / 2))

    long, short = walls_of(grid, 'walls', 10)

    assert (long.name, short.name) == ('walls/0', 'walls/1')
    assert (long.shape, short.shape) == (Box(width=1.5, height=0.5), Box(width=0.5, height=0.5))
    # Along the grid's own axes: x is up, y to the left.
    assert long.pose == pytest.approx((0.75, 2.75, math.pi / 2))
    assert short.pose == pytest.approx((0.25, 2.25, math.pi / 2))
    assert long.properties.anchored
    assert short.properties.anchored


@pytest.mark.parametrize('shape', SHAPES)
def test_a_cell_is_occupied_where_its_centre_lies_in_an_anchored_body(shape):
    world = plane()
    spawn(world, 'thing/0', SHAPES[shape], (1.0, -0.7, 0.4), anchored=True)

    grid = grid_of(world, 0.07)

    assert grid.occupied.any()
    covered = [
        [body_at(world, tuple(point)) is not None for point in row]
        for row in centers_of(grid).tolist()
    ]
    assert np.array_equal(grid.occupied, covered)


def test_what_moves_and_what_is_a_sensor_is_not_on_the_map():
    world = plane()
    spawn(world, 'free/0', Disc(radius=1.0))
    spawn(world, 'kinematic/0', Disc(radius=1.0), kinematic=True)
    spawn(world, 'zone/0', Disc(radius=1.0), anchored=True, sensor=True)

    assert grid_of(world).occupied.shape == (0, 0)


def test_the_map_of_a_bounded_world_has_a_ring_of_wall():
    world = plane(bounds=(-1.0, 0.0, 1.0, 0.5))
    spawn(world, 'post/0', Box(width=0.1, height=0.1), (0.25, 0.25, 0.0), anchored=True)

    grid = grid_of(world)

    assert grid.occupied.shape == (7, 22)
    assert grid.origin == pytest.approx((-1.1, -0.1, 0.0))
    inside = grid.occupied[1:-1, 1:-1]
    assert grid.occupied.sum() == 7 * 22 - 5 * 20 + 1
    assert np.argwhere(inside).tolist() == [[2, 12]]


def test_a_grid_is_the_same_after_it_was_a_world():
    pick = np.random.default_rng(3)
    occupied = pick.random((20, 30)) < 0.4
    grid = Grid(occupied=occupied, resolution=0.25, origin=(-3.0, 2.0, 0.0))
    world = plane()
    for wall in walls_of(grid, 'walls', 1000):
        world.apply(wall)

    again = grid_of(world, 0.25)

    rows, columns = (slice(each.min(), each.max() + 1) for each in np.nonzero(occupied))
    assert np.array_equal(again.occupied, occupied[rows, columns])


@pytest.mark.parametrize(
    ('resolution', 'error'),
    [(math.nan, Malformed), (0.0, BadSize), (-1.0, BadSize), (1e9, BadSize), (1e-3, WorldFull)],
)
def test_resolutions_that_cannot_be_are_refused(resolution, error):
    world = plane(bounds=(-100.0, -100.0, 100.0, 100.0))

    with pytest.raises(error):
        grid_of(world, resolution)


def test_a_map_of_a_gigabyte_is_refused_before_there_is_one():
    world = plane(bounds=(-50_000.0, -50_000.0, 50_000.0, 50_000.0))

    with pytest.raises(WorldFull, match=str(MOST_CELLS)):
        grid_of(world, 0.05)


@pytest.mark.parametrize(
    ('changes', 'error'),
    [
        ({'occupied': np.zeros(4, bool)}, Malformed),
        ({'occupied': np.zeros((2, 2))}, Malformed),
        ({'resolution': math.inf}, Malformed),
        ({'resolution': 1e-9}, BadSize),
        ({'resolution': 9e4}, BadSize),
        ({'origin': (0.0, math.nan, 0.0)}, Malformed),
        ({'origin': (1e9, 0.0, 0.0)}, BadProperty),
    ],
)
def test_grids_that_cannot_be_are_refused(changes, error):
    with pytest.raises(error):
        Grid(**{'occupied': CORNER, 'resolution': 0.5} | changes)
