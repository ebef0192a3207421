# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The outlines that people draw, about one metre across; corners in order, never quite right."""

from __future__ import annotations

from collections.abc import Callable
import math

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Random = np.random.Generator


def regular(rng: Random, count: int, radius: float = 0.5) -> Floats:
    """Return a regular polygon."""
    angle = np.arange(count) * 2.0 * math.pi / count
    angle = angle + rng.uniform(-0.12, 0.12, count) * 2.0 * math.pi / count
    radii = radius * rng.uniform(0.93, 1.07, count)
    return np.column_stack((radii * np.cos(angle), radii * np.sin(angle)))


def triangle(rng: Random) -> Floats:
    """Return a triangle, none of its angles below 20 degrees."""
    while True:
        path = rng.uniform(-0.5, 0.5, (3, 2))
        sides = np.hypot(*(np.roll(path, -1, axis=0) - path).T)
        a, b, c = np.sort(sides)
        # No angle below 20 degrees.
        if a > 0.35 * c and (b**2 + c**2 - a**2) / (2 * b * c) < 0.94:
            return np.asarray(path / c, dtype=np.float64)


def trapezoid(rng: Random) -> Floats:
    """Return a trapezoid."""
    top, high, lean = rng.uniform(0.25, 0.55), rng.uniform(0.35, 0.7), rng.uniform(-0.15, 0.15)
    return nudged(rng, [(-0.5, 0), (0.5, 0), (lean + top / 2, high), (lean - top / 2, high)])


def rhombus(rng: Random) -> Floats:
    """Return a slanted quadrangle."""
    lean, high = rng.uniform(0.3, 0.6), rng.uniform(0.3, 0.6)
    return nudged(rng, [(-0.5, 0), (0.3, 0), (0.3 + lean, high), (-0.5 + lean, high)])


def ell(rng: Random) -> Floats:
    """Return an L."""
    a, b = rng.uniform(0.3, 0.6, 2)
    return nudged(rng, [(0, 0), (1, 0), (1, b), (a, b), (a, 1), (0, 1)])


def house(rng: Random) -> Floats:
    """Return a house."""
    wall = rng.uniform(0.4, 0.7)
    roof = wall + rng.uniform(0.3, 0.5)
    return nudged(rng, [(0, 0), (1, 0), (1, wall), (0.5, roof), (0, wall)])


def star(rng: Random) -> Floats:
    """Return a star of five points."""
    angle = np.arange(10) * math.pi / 5
    radius = np.where(np.arange(10) % 2, rng.uniform(0.2, 0.26), 0.5)
    return nudged(rng, np.column_stack((radius * np.cos(angle), radius * np.sin(angle))))


def dart(rng: Random) -> Floats:
    """Return a dart."""
    return nudged(rng, [(0.5, 0), (-0.5, 0.45), (rng.uniform(-0.25, 0.0), 0), (-0.5, -0.45)])


def tee(rng: Random) -> Floats:
    """Return a T."""
    a, b = rng.uniform(0.3, 0.4), rng.uniform(0.5, 0.65)
    return nudged(rng, [(a, 0), (1 - a, 0), (1 - a, b), (1, b), (1, 1), (0, 1), (0, b), (a, b)])


POLYGONS: tuple[Callable[[Random], Floats], ...] = (
    triangle,
    triangle,
    lambda rng: regular(rng, 3),
    trapezoid,
    rhombus,
    lambda rng: regular(rng, 5),
    lambda rng: regular(rng, 6),
    ell,
    house,
    star,
    dart,
    tee,
)


def nudged(rng: Random, points: Floats | list[tuple[float, float]]) -> Floats:
    """Move each point a little."""
    path = np.array(points, dtype=np.float64)
    return path + rng.uniform(-0.025, 0.025, path.shape)
