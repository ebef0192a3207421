# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The cost of fast bodies: a crowd of small discs that falls and lands, and crowds of 20 km/s."""

from functools import partial
from test.building import spawn
import time

import numpy as np
from physsim_ros.model.requests import Configure
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Compound, Disc, Shape
from physsim_ros.simulation.world import World

from .bodies import timed

FRAMES = 100
STEPS = 5


def crowd(count: int) -> World:
    """Return discs of 10 cm in rows of a hundred, 5 m above the ground."""
    world = World()
    world.apply(Configure(changes={'bounds': (-10.0, 0.0, 10.0, 30.0)}))
    for number in range(count):
        row, column = divmod(number, 100)
        pose = (0.15 * column - 8.0, 5.0 + 0.15 * row, 0.0)
        spawn(world, f'disc/{number}', Disc(radius=0.05), pose)
    return world


def fast_crowd(count: int, shape: Shape, speed: float) -> World:
    """Return bodies in 50 m by 50 m that fly in all directions, without gravity."""
    world = World(settings=WorldSettings(gravity=(0.0, 0.0)))
    pick = np.random.default_rng(1)
    for number in range(count):
        pose = (*pick.uniform(0.0, 50.0, 2).tolist(), 0.0)
        velocity = tuple(pick.normal(0.0, speed, 2).tolist())
        spawn(world, f'fast/{number}', shape, pose, velocity=velocity)
    return world


def table() -> None:
    """Print both."""
    _falling()
    _flying()


def _flying() -> None:
    print(f'\nA step of a crowd that flies in 50 m x 50 m: mean CPU of {STEPS} [ms]')
    grid = np.stack(np.meshgrid(np.arange(30), np.arange(30)), -1).reshape(-1, 2) * 0.2
    centers = tuple((float(x), float(y)) for x, y in grid)
    for what, count, shape, speed in (
        ('boxes of 20 cm at 20 km/s', 2000, Box(width=0.2, height=0.2), 2e4),
        ('discs of 20 cm at 20 km/s', 8000, Disc(radius=0.1), 2e4),
        (
            'lists of 900 spheres at 1 km/s',
            40,
            Compound(element=Disc(radius=0.1), centers=centers),
            1e3,
        ),
    ):
        began = time.process_time()
        world = fast_crowd(count, shape, speed)
        spawned = time.process_time()
        world.step(STEPS)
        cost = (time.process_time() - spawned) / STEPS
        spawning = spawned - began
        print(f'{count:6} {what:31} {cost * 1e3:7.0f}, spawned in {spawning:.1f} s')


def _falling() -> None:
    print('\nA frame of 4 steps while small discs fall from 5 m [ms]')
    print('bodies    mean  longest')
    for count in (100, 1000):
        world = crowd(count)
        costs = [timed(partial(world.step, 4)) for _ in range(FRAMES)]
        print(f'{count:6} {sum(costs) / FRAMES:7.1f} {max(costs):8.1f}')
