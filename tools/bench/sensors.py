# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The cost of sensors: laser scans beside the own queries of the engine; walls of a map."""

from collections.abc import Callable
import math
import statistics
from test.building import spawn
import time

import numpy as np
from physsim_ros.maps import Grid, walls_of
from physsim_ros.model.robots.sensors import Laser
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.sensing import read_laser, Surroundings
from physsim_ros.simulation.world import World
import pymunk

from .bodies import timed

SHAPES = 1000
# Half the side of the square of bodies [m], and of the clearing for robots.
HALF, CLEARING = 12.0, 0.5
LASER = Laser(beams=720, range=(0.1, 12.0))
SCANS = 50


def scene(robots: int) -> World:
    """Return a world of discs and boxes, and robots in a row in the middle, the first rows."""
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    for number in range(robots):
        place = (2.0 * number - robots + 1.0, 0.0, 0.0)
        spawn(world, f'robot/{number}', Disc(radius=0.1), place)
    pick = np.random.default_rng(1)
    for number in range(SHAPES):
        x, y, yaw = pick.uniform(-HALF, HALF, 3).tolist()
        # Beside the row.
        y = math.copysign(max(abs(y), CLEARING), y)
        shape = Disc(radius=0.1) if number % 2 else Box(width=0.3, height=0.2)
        spawn(world, f'thing/{number}', shape, (x, y, yaw), anchored=True)
    return world


def table() -> None:
    """Print the cost of a frame with 1 and 10 lasers, and that of the walls of a map."""
    print(f'\nA scan of {LASER.beams} beams by each robot, {SHAPES} discs and boxes: median [ms]')
    print('robots    scans    segment_query_first')
    for robots in (1, 10):
        world = scene(robots)
        scans = _median(_scan, world, robots)
        queries = _median(_query, world, robots)
        print(f'{robots:6} {scans:8.2f} {queries:22.2f}')
    _maps()


def _scan(world: World, robots: int) -> None:
    surroundings = Surroundings(world.snapshot())
    for row in range(robots):
        read_laser(surroundings, row, LASER)


def _query(world: World, robots: int) -> None:
    space, everything, reach = world.space.pm_space, pymunk.ShapeFilter(), LASER.range[1]
    for x, y, yaw in world.snapshot().poses[:robots].tolist():
        for number in range(LASER.beams):
            angle = yaw + LASER.increment * number
            end = x + reach * math.cos(angle), y + reach * math.sin(angle)
            space.segment_query_first((x, y), end, 0.0, everything)


def _median(work: Callable[[World, int], None], world: World, robots: int) -> float:
    return statistics.median(timed(lambda: work(world, robots)) for _ in range(SCANS))


def _maps() -> None:
    print('\nWalls of a map of 1,000 by 1,000 cells [s]')
    cells = np.zeros((1000, 1000), dtype=np.bool_)
    cells[::50] = cells[:, ::50] = True
    specks = np.random.default_rng(1).integers(0, 1000, (2, 5000))
    cells[specks[0], specks[1]] = True
    began = time.perf_counter()
    walls = walls_of(Grid(occupied=cells, resolution=0.05), 'map', 1_000_000)
    cost = time.perf_counter() - began
    print(f'{len(walls)} boxes of a grid of walls with 5,000 specks: {cost:.2f}')
