# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Small scenes whose cost is measured beside the bare engine: free bodies, and machines."""

from __future__ import annotations

from collections.abc import Callable
import math
from test.laws.scenes import floor, join, NOWHERE, spawn, walls

from physsim_ros.model.requests import Configure
from physsim_ros.model.shapes import Box, Chain, Disc
from physsim_ros.simulation.simulation import Simulation

Scene = Callable[[Simulation], None]
BOX = Box(width=0.5, height=0.5)


def rolling(sim: Simulation) -> None:
    """Add discs that fall onto a floor and roll."""
    floor(sim)
    for number in range(10):
        place = (3.0 * number, 0.5 + 0.1 * number, 0.0)
        spawn(sim, f'disc/{number}', Disc(radius=0.25), place, velocity=(1.0, 0.0))


def stack(sim: Simulation) -> None:
    """Add ten boxes on each other."""
    floor(sim)
    for number in range(10):
        spawn(sim, f'box/{number}', BOX, (0.0, 0.25 + 0.5 * number, 0.0))


def heap(sim: Simulation) -> None:
    """Add a hundred discs and boxes that fall into a bin."""
    walls(sim, -3.0, 0.0, 3.0, 100.0)
    for number in range(100):
        shape = Disc(radius=0.25) if number % 2 else BOX
        x, y = number % 10 * 0.58 - 2.6, 0.4 + number // 10 * 0.6
        spawn(sim, f'body/{number}', shape, (x + 0.02 * (number % 3), y, 0.0), elasticity=0.0)


def tiles(sim: Simulation) -> None:
    """Add a box that slides over tiles."""
    tile = Box(width=1.0, height=1.0)
    for number in range(40):
        place = (float(number), -0.5, 0.0)
        spawn(sim, f'tile/{number}', tile, place, anchored=True, friction=0.05)
    spawn(sim, 'box/0', BOX, (0.0, 0.25, 0.0), velocity=(6.0, 0.0), friction=0.05)


def gas(sim: Simulation) -> None:
    """Add 48 elastic discs in a box."""
    walls(sim, -3.0, -3.0, 3.0, 3.0)
    smooth = {'elasticity': 1.0, 'friction': 0.0}
    sim.perform(Configure(changes={'gravity': NOWHERE, **smooth}))
    for number in range(48):
        place = (number % 7 * 0.8 - 2.4, number // 7 * 0.8 - 2.4, 0.0)
        velocity = 3.0 * math.cos(number), 3.0 * math.sin(number)
        spawn(sim, f'disc/{number}', Disc(radius=0.15), place, velocity=velocity, **smooth)


def racer(sim: Simulation) -> None:
    """Add a disc that races in a box of thin walls."""
    corners = ((-4.0, -4.0), (4.0, -4.0), (4.0, 4.0), (-4.0, 4.0), (-4.0, -4.0))
    smooth = {'elasticity': 1.0, 'friction': 0.0}
    sim.perform(Configure(changes={'gravity': NOWHERE}))
    spawn(sim, 'walls/0', Chain(points=corners, thickness=0.02), anchored=True, **smooth)
    spawn(sim, 'disc/0', Disc(radius=0.1), velocity=(40.0, 17.0), **smooth)


def pendulum(sim: Simulation, count: int = 1) -> None:
    """Add pendulums side by side."""
    for number in range(count):
        x = 3.0 * number
        spawn(sim, f'bob/{number}', Disc(radius=0.2), (x + 1.0, 0.0, 0.0))
        join(sim, f'axle/{number}', 'axle', [(x, 0.0)], a=f'bob/{number}', b='world')


def row(sim: Simulation, name: str, count: int, shape: Box, **said: float) -> None:
    """Add boxes in a row, each joined to the one before by an axle, the first to the world."""
    for number in range(count):
        x = shape.width * number
        spawn(sim, f'{name}/{number}', shape, (x + shape.width / 2, 0.0, 0.0), group=1, **said)
        other = f'{name}/{number - 1}' if number else 'world'
        join(sim, f'axle/{number}', 'axle', [(x, 0.0)], a=f'{name}/{number}', b=other)


def double_pendulum(sim: Simulation) -> None:
    """Add two rods that swing on each other."""
    row(sim, 'rod', 2, Box(width=1.0, height=0.1))


def chain(sim: Simulation) -> None:
    """Add a chain of fifty links that swings."""
    row(sim, 'link', 50, Box(width=0.2, height=0.05), mass=0.1)


def bridge(sim: Simulation, mass: float = 10.0) -> None:
    """Add a bridge of planks of 1 kg with a box of some mass on it."""
    row(sim, 'plank', 10, Box(width=1.0, height=0.2), mass=1.0)
    join(sim, 'axle/10', 'axle', [(10.0, 0.0)], a='plank/9', b='world')
    spawn(sim, 'box/0', Box(width=0.8, height=0.8), (5.0, 0.5, 0.0), mass=mass)


def car(sim: Simulation) -> None:
    """Add a car whose wheels a motor drives over a floor."""
    floor(sim)
    spawn(sim, 'car/0', Box(width=2.0, height=0.4), (0.0, 0.6, 0.0), group=1)
    driven = {'rate': -6.0, 'max_torque': 30.0}
    for number, x in enumerate((-0.7, 0.7)):
        wheel = f'wheel/{number}'
        spawn(sim, wheel, Disc(radius=0.35), (x, 0.36, 0.0), group=1, friction=1.0)
        join(sim, f'motor/{number}', 'motor', [(x, 0.36)], a=wheel, b='car/0', **driven)


def cradle(sim: Simulation) -> None:
    """Add a cradle of five balls, one of them swung."""
    for number in range(5):
        x, ball = 0.4 * number, f'ball/{number}'
        at = (x, 0.0) if number else (x - 1.0, 1.0)
        spawn(sim, ball, Disc(radius=0.2), (*at, 0.0), elasticity=1.0, friction=0.0)
        join(sim, f'rod/{number}', 'rod', [at, (x, 1.0)], a=ball, b='world')


def bob_on_spring(sim: Simulation) -> None:
    """Add a bob that swings up and down on a spring."""
    spawn(sim, 'bob/0', Disc(radius=0.2), mass=1.0)
    said = {'stiffness': 50.0, 'rest_length': 1.0}
    join(sim, 'spring/0', 'spring', [(0.0, 0.0), (0.0, 1.5)], a='bob/0', b='world', **said)


FREE: dict[str, Scene] = {
    'ten fall and roll': rolling,
    'stack of ten': stack,
    'a hundred in a heap': heap,
    'a box slides over tiles': tiles,
    'elastic gas of 48': gas,
    'a disc races in thin walls': racer,
}
MACHINES: dict[str, Scene] = {
    'pendulum': pendulum,
    'double pendulum': double_pendulum,
    'chain of fifty': chain,
    'bridge with a box': bridge,
    'car with a motor': car,
    'cradle of five': cradle,
    'bob on a spring': bob_on_spring,
    'thirty pendulums': lambda sim: pendulum(sim, 30),
}
