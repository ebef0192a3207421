# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Scenes that have frozen a world once: small in the tests, at full size in `make soak`.

A function each, with its size as argument; it returns the requests.
"""

from __future__ import annotations

import math

from physsim_ros.model.requests import Request, Spawn
from physsim_ros.model.shapes import Box, Compound, Disc


def one_pose(count: int = 3000) -> list[Request]:
    """Return discs whose poses somebody has forgotten."""
    return [Spawn(name=f'spawn/{number}', shape=Disc(radius=0.5)) for number in range(count)]


def sphere_lists(count: int = 4, centers: int = 1000) -> list[Request]:
    """Return compounds of discs that do not overlap each other, all in one place."""
    side = math.ceil(math.sqrt(centers))
    grid = tuple((float(k % side), float(k // side)) for k in range(centers))
    shape = Compound(element=Disc(radius=0.5), centers=grid)
    return [Spawn(name=f'list/{number}', shape=shape) for number in range(count)]


def coincident_lists(count: int = 4, centers: int = 1000) -> list[Request]:
    """Return compounds of discs that lie on each other, all in one place."""
    shape = Compound(element=Disc(radius=0.5), centers=((0.0, 0.0),) * centers)
    return [Spawn(name=f'list/{number}', shape=shape) for number in range(count)]


def crossing_rods(count: int = 3000) -> list[Request]:
    """Return thin rods whose centres are apart, and all of which cross each other."""
    return [
        Spawn(
            name=f'rod/{number}',
            shape=Box(width=50.0, height=0.02),
            pose=(math.cos(number) * 3.0, math.sin(number) * 3.0, math.pi * number / count),
        )
        for number in range(count)
    ]
