# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Small scenes whose cost is measured beside the bare engine: free bodies, and machines."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
import math
from typing import Any

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.requests import Configure, Join, Request, Spawn
from physsim_ros.model.shapes import Box, Chain, Disc, Shape

Requests = Iterator[Request]


def _body(name: str, shape: Shape, x: float, y: float, yaw: float = 0.0, **said: Any) -> Spawn:
    return Spawn(name=name, shape=shape, pose=(x, y, yaw), properties=Properties(**said))


def _floor() -> Spawn:
    return _body('floor/0', Box(width=200.0, height=2.0), 0.0, -1.0, anchored=True)


def _join(
    name: str, kind: str, points: Sequence[tuple[float, float]], a: str, b: str, **said: Any
) -> Join:
    return Join(
        name=name,
        kind=JointKind(kind),
        points=tuple(points),
        a=a,
        b=b,
        properties=JointProperties(**said),
    )


def rolling(count: int = 10) -> Requests:
    """Yield discs that fall onto a floor and roll."""
    yield _floor()
    for number in range(count):
        place = 3.0 * number, 0.5 + 0.1 * number
        yield _body(f'disc/{number}', Disc(radius=0.25), *place, velocity=(1.0, 0.0))


def stack() -> Requests:
    """Yield ten boxes on each other; the lowest is pushed so that none of them sleeps."""
    yield _floor()
    for number in range(10):
        yield _body(f'box/{number}', Box(width=0.5, height=0.5), 0.0, 0.25 + 0.5 * number)


def heap() -> Requests:
    """Yield a hundred discs and boxes that fall into a bin."""
    yield Configure(changes={'bounds': (-3.0, 0.0, 3.0, 100.0)})
    for number in range(100):
        shape = Disc(radius=0.25) if number % 2 else Box(width=0.5, height=0.5)
        x, y = number % 10 * 0.58 - 2.6, 0.4 + number // 10 * 0.6
        yield _body(f'body/{number}', shape, x + 0.02 * (number % 3), y, elasticity=0.0)


def tiles() -> Requests:
    """Yield a box that slides over tiles."""
    for number in range(40):
        tile = Box(width=1.0, height=1.0)
        yield _body(f'tile/{number}', tile, float(number), -0.5, anchored=True, friction=0.05)
    box = Box(width=0.5, height=0.5)
    yield _body('box/0', box, 0.0, 0.25, velocity=(6.0, 0.0), friction=0.05)


def gas() -> Requests:
    """Yield 48 elastic discs in a box."""
    yield Configure(changes={'bounds': (-3.0, -3.0, 3.0, 3.0), 'gravity': (0.0, 0.0)})
    for number in range(48):
        x, y = number % 7 * 0.8 - 2.4, number // 7 * 0.8 - 2.4
        velocity = 3.0 * math.cos(number), 3.0 * math.sin(number)
        disc = Disc(radius=0.15)
        yield _body(f'disc/{number}', disc, x, y, elasticity=1.0, friction=0.0, velocity=velocity)
    yield Configure(changes={'elasticity': 1.0, 'friction': 0.0})


def racer() -> Requests:
    """Yield a disc that races in a box of thin walls."""
    corners = ((-4.0, -4.0), (4.0, -4.0), (4.0, 4.0), (-4.0, 4.0), (-4.0, -4.0))
    walls = Chain(points=corners, thickness=0.02)
    yield Configure(changes={'gravity': (0.0, 0.0)})
    yield _body('walls/0', walls, 0.0, 0.0, anchored=True, elasticity=1.0, friction=0.0)
    velocity = (40.0, 17.0)
    yield _body(
        'disc/0', Disc(radius=0.1), 0.0, 0.0, velocity=velocity, elasticity=1.0, friction=0.0
    )


def pendulum(count: int = 1) -> Requests:
    """Yield pendulums side by side."""
    for number in range(count):
        x = 3.0 * number
        yield _body(f'bob/{number}', Disc(radius=0.2), x + 1.0, 0.0)
        yield _join(f'axle/{number}', 'axle', ((x, 0.0),), f'bob/{number}', 'world')


def double_pendulum() -> Requests:
    """Yield two rods that swing on each other."""
    for number in range(2):
        rod = Box(width=1.0, height=0.1)
        yield _body(f'rod/{number}', rod, 0.5 + number, 0.0, group=1)
        other = f'rod/{number - 1}' if number else 'world'
        yield _join(f'axle/{number}', 'axle', ((float(number), 0.0),), f'rod/{number}', other)


def chain(links: int = 50) -> Requests:
    """Yield a chain that swings."""
    for number in range(links):
        link = Box(width=0.2, height=0.05)
        yield _body(f'link/{number}', link, 0.2 * number + 0.1, 0.0, mass=0.1, group=1)
        other = f'link/{number - 1}' if number else 'world'
        yield _join(f'axle/{number}', 'axle', ((0.2 * number, 0.0),), f'link/{number}', other)


def bridge() -> Requests:
    """Yield a bridge of planks with a box on it."""
    for number in range(10):
        plank = Box(width=1.0, height=0.2)
        yield _body(f'plank/{number}', plank, number + 0.5, 0.0, mass=1.0, group=1)
        other = f'plank/{number - 1}' if number else 'world'
        yield _join(f'axle/{number}', 'axle', ((float(number), 0.0),), f'plank/{number}', other)
    yield _join('axle/10', 'axle', ((10.0, 0.0),), 'plank/9', 'world')
    yield _body('box/0', Box(width=0.8, height=0.8), 5.0, 0.5, mass=10.0)


def car() -> Requests:
    """Yield a car whose wheels a motor drives over a floor."""
    yield _floor()
    yield _body('car/0', Box(width=2.0, height=0.4), 0.0, 0.6, group=1)
    for number, x in enumerate((-0.7, 0.7)):
        yield _body(f'wheel/{number}', Disc(radius=0.35), x, 0.36, group=1, friction=1.0)
        said = {'rate': -6.0, 'max_torque': 30.0}
        yield _join(f'motor/{number}', 'motor', ((x, 0.36),), f'wheel/{number}', 'car/0', **said)


def cradle() -> Requests:
    """Yield a cradle of five balls, one of them swung."""
    for number in range(5):
        x = 0.4 * number
        at = (x - 1.0, 1.0) if number == 0 else (x, 0.0)
        yield _body(f'ball/{number}', Disc(radius=0.2), *at, elasticity=1.0, friction=0.0)
        yield _join(f'rod/{number}', 'rod', (at, (x, 1.0)), f'ball/{number}', 'world')


def bob_on_spring() -> Requests:
    """Yield a bob that swings up and down on a spring."""
    yield _body('bob/0', Disc(radius=0.2), 0.0, 0.0, mass=1.0)
    said = {'stiffness': 50.0, 'rest_length': 1.0}
    yield _join('spring/0', 'spring', ((0.0, 0.0), (0.0, 1.5)), 'bob/0', 'world', **said)


FREE: dict[str, Callable[[], Requests]] = {
    'ten fall and roll': rolling,
    'stack of ten': stack,
    'a hundred in a heap': heap,
    'a box slides over tiles': tiles,
    'elastic gas of 48': gas,
    'a disc races in thin walls': racer,
}
MACHINES: dict[str, Callable[[], Requests]] = {
    'pendulum': pendulum,
    'double pendulum': double_pendulum,
    'chain of fifty': chain,
    'bridge with a box': bridge,
    'car with a motor': car,
    'cradle of five': cradle,
    'bob on a spring': bob_on_spring,
    'thirty pendulums': lambda: pendulum(30),
}
