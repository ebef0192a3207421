# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Strokes of the tests, point by point, and their reading in a world."""

from collections.abc import Sequence
import itertools
import math
from typing import Any

import numpy as np
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.stages import Reading
from physsim_ros.model.arrays import Floats
from physsim_ros.model.requests import Join, Spawn
from physsim_ros.simulation.world import World

from ..single_stroke import interpret_stroke

SETTINGS = DrawingSettings()
ANGLE = np.linspace(0.0, 2.0 * math.pi, 60)
Way = Sequence[tuple[float, float]]


def draw(world: World, way: Way | Floats, **said: Any) -> Reading:
    """Read a stroke from point to point; what is said are settings of drawing."""
    points = np.array(way, dtype=np.float64)
    if len(points) < 40:
        sides = itertools.pairwise(points)
        points = np.vstack([np.linspace(a, b, 25, endpoint=False) for a, b in sides])
        points = np.vstack((points, way[-1]))
    before = world.digest()
    try:
        return interpret_stroke(points, SceneQuery(world.snapshot()), DrawingSettings(**said))
    finally:
        assert world.digest() == before


def built(reading: Reading, shape: type = object) -> Spawn:
    """Return the only request of a reading: a body of a shape."""
    (request,) = reading.requests
    assert isinstance(request, Spawn)
    assert isinstance(request.shape, shape)
    return request


def joined(reading: Reading) -> Join:
    """Return the only request of a reading: a joint."""
    (request,) = reading.requests
    assert isinstance(request, Join)
    return request


def carry_out(world: World, reading: Reading) -> None:
    for request in reading.requests:
        world.apply(request)


def circle(x: float, y: float, radius: float) -> Floats:
    return np.column_stack((x + radius * np.cos(ANGLE), y + radius * np.sin(ANGLE)))


def zigzag(start: tuple[float, float], end: tuple[float, float], teeth: int = 8) -> Way:
    (x0, y0), (x1, y1) = start, end
    length = math.dist(start, end)
    ux, uy = (x1 - x0) / length, (y1 - y0) / length
    ways = [start]
    for number in range(1, teeth):
        share, aside = number / teeth, 0.1 * length * (-1) ** number
        ways.append(
            (
                x0 + share * (x1 - x0) - aside * uy,
                y0 + share * (y1 - y0) + aside * ux,
            )
        )
    return [*ways, end]


def cross(x: float, y: float, half: float = 0.2) -> Way:
    return [
        (x - half, y + half), (x + half, y - half), (x + half, y + half), (x - half, y - half),
    ]  # fmt: skip


def scribble(x: float, y: float, width: float, height: float) -> Way:
    return [(x + width * (n / 12 - 0.5), y + height * ((n % 2) - 0.5)) for n in range(13)]


def rectangle(x: float, y: float, width: float, height: float, skew: float = 0.0) -> Way:
    return [(x, y), (x + width, y + skew), (x + width, y + height), (x, y + height), (x, y)]


def square(x: float, y: float, half: float) -> Way:
    return [
        (x - half, y - half), (x + half, y - half), (x + half, y + half), (x - half, y + half),
        (x - half, y - half),
    ]  # fmt: skip


def round_arrow(x: float, y: float, radius: float, sweep: float, start: float = -1.0) -> Floats:
    """Return an arc about a point, from an angle by an angle, with a head of two barbs."""
    turn = start + np.linspace(0.0, sweep, 60)
    arc = np.column_stack((x + radius * np.cos(turn), y + radius * np.sin(turn)))
    tip, ahead = arc[-1], arc[-1] - arc[-3]
    ahead /= np.hypot(*ahead)
    aside = np.array((-ahead[1], ahead[0]))
    barbs = [tip + radius * 0.35 * (-ahead + side * aside) for side in (0.8, -0.8)]
    head = np.vstack(
        [np.linspace(a, b, 8) for a, b in ((tip, barbs[0]), (barbs[0], tip), (tip, barbs[1]))]
    )
    return np.vstack((arc, head))
