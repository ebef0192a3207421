# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Limits of readings: a stroke a tenth below a limit has another meaning than one above it."""

from collections.abc import Callable, Sequence
import math

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import Refusal
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import Delete, Join, Spawn
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.world import World
import pytest

from .ways import ANGLE, circle, draw, scribble, square, Way
from ...building import spawning

SHARE = np.linspace(0.0, 1.0, 60)
PLATE = [spawning('a/0', Box(width=1.0, height=1.0))]
# Sides of a square of the area of a plank [m].
SIDE = math.sqrt(2.0)
OVERLAPPING, BESIDE = (
    [spawning(f'a/{n}', Box(width=2.0, height=1.0), (apart * n, 0.0, 0.0)) for n in range(2)]
    for apart in (1.4, 2.1)
)
APART = [spawning(f'a/{n}', Disc(radius=0.3), (4.0 * n, 0.0, 0.0)) for n in range(2)]
WHEEL = [
    spawning('wheel/0', Disc(radius=0.5), (2.0, -0.5, 0.0), anchored=True),
    *(spawning(f'a/{n}', Disc(radius=0.3), (4.0 * n, -0.84, 0.0)) for n in range(2)),
]
ON_FLOOR = [
    spawning('floor/0', Box(width=20.0, height=2.0), (0.0, -1.0, 0.0)),
    spawning('a/0', Box(width=1.0, height=1.0), (0.0, 0.5, 0.0)),
]


STANDING = [spawning('a/0', Disc(radius=0.5))]
NEAR = [spawning(f'a/{n}', Box(width=1.0, height=1.0), (2.0 * n, 0.0, 0.0)) for n in range(2)]
LOOSE = [spawning(f'a/{n}', Disc(radius=0.3), (2.0 * n, 0.0, 0.0)) for n in range(2)]
ROUND = 2.0 * math.pi * SHARE


def bow(straightness: float) -> Floats:
    """Return an arc from (0, 0) to (4, 0) whose chord is a share of its length."""
    halves = np.linspace(0.01, 1.5, 500)
    half = float(np.interp(-straightness, -np.sin(halves) / halves, halves))
    angle, radius = half * (2.0 * SHARE - 1.0), 2.0 / math.sin(half)
    height = radius * (np.cos(angle) - math.cos(half))
    return np.column_stack((2.0 + radius * np.sin(angle), -height))


def over_wheel(bend: float) -> Way:
    """Return a rope from x = 0 to x = 4 that is bent by an angle at (2, 0) [rad]."""
    low = -2.0 * math.tan(bend / 2)
    return [(0.0, low), (2.0, 0.0), (4.0, low)]


def looped(radius: float) -> Floats:
    """Return a line of 4 m with a round loop in its middle [m]."""
    loop = radius * np.column_stack((np.sin(ROUND), 1.0 - np.cos(ROUND)))[1:-1]
    lines = (np.column_stack((SHARE * 2.0 - start, 0.0 * SHARE)) for start in (2.0, 0.0))
    return np.vstack((next(lines), loop, next(lines)))


def bean(dent: float) -> Floats:
    """Return an oval with a dent, in shares of its radius."""
    radius = 1.0 - dent * np.exp(-(((ROUND - math.pi) / 0.5) ** 2))
    return np.column_stack((1.3 * radius * np.cos(ROUND), radius * np.sin(ROUND)))


def squircle(power: float) -> Floats:
    """Return a curve between a circle (1) and a square (0), of powers of cosine and sine."""
    x, y = (np.sign(each) * np.abs(each) ** power for each in (np.cos(ROUND), np.sin(ROUND)))
    return np.column_stack((x, y))


def teeth(count: float, half: float, start: float = 0.0, end: float = 2.0) -> Way:
    """Return a zigzag along the axis x, of lines to and fro across it."""
    step, last = (end - start) / count, int(count)
    return [(start + step * n, half * (-1) ** n if 0 < n < last else 0.0) for n in range(last + 1)]


def down(angle: float, depth: float, radius: float = 0.5) -> Way:
    """Return a line that ends within a disc, at its lower side."""
    x, y = math.sin(angle), -math.cos(angle)
    return [(6.0 * radius * x, 6.0 * radius * y), ((radius - depth) * x, (radius - depth) * y)]


# Bodies, a stroke of a measure, values of the measure on either side of a limit, the readings.
LIMITS: dict[
    str,
    tuple[
        Sequence[Spawn],
        Callable[[float], Way | Floats],
        tuple[float, float],
        tuple[str, str],
    ],
] = {
    'diameter of an axle on one body': (
        PLATE, lambda it: circle(0.0, 0.0, it / 2), (0.45, 0.55), ('axle world', 'disc'),
    ),
    'diameter of an axle on two bodies': (
        OVERLAPPING, lambda it: circle(0.7, 0.0, it * SIDE / 2), (0.67, 0.83),
        ('axle', 'disc'),
    ),
    'side of a weld over a gap': (
        BESIDE, lambda it: square(1.05, 0.0, it * SIDE / 2), (0.45, 0.55),
        ('pin', 'rectangle'),
    ),
    'straightness of a line between bodies': (
        APART, bow, (0.9, 0.98), ('rope', 'rod'),
    ),
    'bend of a rope on a wheel': (
        WHEEL, over_wheel,
        (math.radians(41), math.radians(50)), ('rope', 'rope wheel/0'),
    ),
    'share of a scribble on a body that it covers': (
        ON_FLOOR, lambda it: scribble(0.0, 0.6 - 1.2 * it, 1.3, 1.2), (0.27, 0.33),
        ('deletion a/0', 'deletion floor/0 a/0'),
    ),
    'distance of the tail of an arrow from a body': (
        PLATE, lambda it: [(0.5 + it, 0), (3, 0), (2.5, 0.3), (3, 0), (2.5, -0.3)],
        (0.13, 0.17), ('velocity', 'gravity'),
    ),
    'aspect of a circle': (
        [], lambda it: np.column_stack((np.cos(ANGLE), it * np.sin(ANGLE))),
        (0.53, 0.63), ('polygon', 'disc'),
    ),
    'corners of an axle': (
        [spawning('a/0', Box(width=6.0, height=4.0))],
        lambda it: np.array(
            [(0.3 * math.cos(a), 0.3 * math.sin(a)) for a in np.linspace(0.4, 6.7, int(it) + 1)]
        ).tolist(),
        (4, 5), ('rectangle', 'axle world'),
    ),
    'overhang of an axle over a second body': (
        [spawning(f'a/{n}', Box(width=3.0, height=3.0), (3.0 * n, 0.0, 0.0)) for n in range(2)],
        lambda it: circle(1.5 - it, 0.0, 0.3), (0.2, 0.25), ('axle', 'axle world'),
    ),
    'gap of a circle': (
        [], lambda it: np.column_stack((np.cos(ROUND * it), np.sin(ROUND * it))),
        (0.8, 0.85), ('wall', 'disc'),
    ),
    'gap in a side of a square': (
        [], lambda it: [(it, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0), (0.0, 0.0)],
        (1.1, 1.4), ('rectangle', 'wall'),
    ),
    'shrinking of a circle that is drawn twice': (
        [], lambda it: np.column_stack((np.cos(2.0 * ROUND), np.sin(2.0 * ROUND)))
        * (1.0 - it * SHARE)[:, None], (0.4, 0.5), ('disc', ''),
    ),
    'radius of a loop of a line': ([], looped, (0.1, 0.16), ('wall', '')),
    'dent of a bean': ([], bean, (0.5, 0.65), ('disc', 'polygon')),
    'roundness of a square': ([], squircle, (0.4, 0.6), ('rectangle', 'disc')),
    'slant of a trapezoid': (
        [], lambda it: [(0.0, 0.0), (2.0, 0.0), (2.0 - it, 1.0), (it, 1.0), (0.0, 0.0)],
        (0.3, 0.4), ('rectangle', 'polygon'),
    ),
    'swings of a scribble': (
        PLATE,
        lambda it: [(1.3 * (n / it - 0.5), 1.2 * (n % 2 - 0.5)) for n in range(int(it) + 1)],
        (5, 6), ('wall', 'deletion a/0'),
    ),
    'lines of a zigzag between bodies': (
        APART, lambda it: teeth(it, 0.3, end=4.0), (3, 4), ('rope', 'spring'),
    ),
    'height of swings between bodies': (
        LOOSE, lambda it: [(n / 10, it * (n % 2 - 0.5)) for n in range(21)], (0.5, 1.0),
        ('spring', 'deletion a/0 a/1'),
    ),
    'length of a spring on its bodies': (
        NEAR, lambda it: teeth(12, 0.3, -it, 2.0 + it), (0.2, 0.4), ('spring', 'wall'),
    ),
    'depth of the end of a post in a ball': (
        STANDING, lambda it: down(0.0, it), (0.14, 0.19), ('wall', 'rod world'),
    ),
    'slope of a post under a ball': (
        STANDING, lambda it: down(math.radians(it), 0.05), (40, 50), ('wall', 'rod world'),
    ),
    'height of round teeth between bodies': (
        APART, lambda it: np.column_stack((4.0 * SHARE, 2.0 * it * np.sin(6.0 * ROUND))),
        (0.07, 0.09), ('rod', 'spring'),
    ),
    'size of a scribble across a thin body and on another': (
        [
            spawning('a/0', Box(width=2.0, height=0.12)),
            spawning('a/1', Box(width=0.3, height=0.3), (0.0, 0.3, 0.0)),
        ],
        lambda it: scribble(0.0, 0.15, it, 0.8 * it),
        (0.9, 1.2), ('deletion a/1', 'deletion a/0 a/1'),
    ),
    'slope of a line down to beside the upper side of a body': (
        PLATE,
        lambda it: [(3.0 * math.tan(math.radians(it)), 3.6), (0.0, 0.6)],
        (40, 50), ('rod world', 'wall'),
    ),
    'height of a roof': (
        [], lambda it: [(0, 0), (2, 0), (2, 1), (1, 1.0 + it), (0, 1), (0, 0)],
        (0.25, 0.45), ('rectangle', 'polygon'),
    ),
    'overhang of a line on a body': (
        [spawning('a/0', Box(width=4.0, height=3.0))], lambda it: [(-1.5, 0.0), (2.0 + it, 0.5)],
        (0.1, 0.25), ('hatching', 'rod world'),
    ),
}  # fmt: skip


@pytest.mark.parametrize(('bodies', 'way', 'values', 'readings'), LIMITS.values(), ids=LIMITS)
def test_a_meaning_ends_at_its_limit(
    bodies: Sequence[Spawn],
    way: Callable[[float], Way | Floats],
    values: tuple[float, float],
    readings: tuple[str, str],
) -> None:
    for value, expected in zip(values, readings, strict=True):
        world = World()
        for body in bodies:
            world.apply(body)

        try:
            reading = draw(world, way(value))
        except Refusal:
            assert expected == ''
            continue

        words = [reading.meaning]
        for each in reading.requests:
            words += [each.name] if isinstance(each, Delete) else []
            words += (each.properties.over or ()) if isinstance(each, Join) else ()
            words += [WORLD] if isinstance(each, Join) and each.b == WORLD else []
        assert ' '.join(words) == expected
