# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Limits of readings: a stroke a tenth below a limit has another meaning than one above it."""

from collections.abc import Callable, Sequence
import math

import numpy as np
from physsim_ros.model.arrays import Floats
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
        PLATE, lambda it: circle(0.0, 0.0, it / 2), (0.45, 0.55), ('axle', 'disc'),
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

        reading = draw(world, way(value))

        words = [reading.meaning]
        for each in reading.requests:
            words += [each.name] if isinstance(each, Delete) else []
            words += (each.properties.over or ()) if isinstance(each, Join) else ()
        assert ' '.join(words) == expected
