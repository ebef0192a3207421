# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The path of a taut rope past rings and around wheels: straight spans along common tangents.

A ring is a wheel of radius 0. Not here: how its length changes as bodies move
(`engine/core/joint_rows.c`).
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
import math
from typing import NamedTuple

from physsim_ros.model.transform import Point


class Span(NamedTuple):
    """
    A straight piece of a rope.

    :ivar start: [m]
    :ivar end: [m]
    :ivar heading: direction of the rope from the one to the other [rad]
    """

    start: Point
    end: Point
    heading: float

    @property
    def length(self) -> float:
        """Return its length [m]."""
        return math.dist(self.start, self.end)


def spans(centers: Sequence[Point], radii: Sequence[float]) -> list[Span]:
    """
    Return the spans of a rope.

    :param centers: of the wheels in the order in which the rope passes them, its ends among them
        [m]
    :param radii: > 0 where it runs counter-clockwise around a wheel, < 0 clockwise [m]
    """
    found = []
    for ((x, y), radius), ((x2, y2), radius2) in pairwise(zip(centers, radii, strict=True)):
        distance, across = math.dist((x, y), (x2, y2)), radius - radius2
        heading = math.atan2(y2 - y, x2 - x)
        # Wheels that lie in each other have no common tangent.
        heading += math.asin(across / distance) if distance > abs(across) else 0.0
        # The centre of a wheel that turns counter-clockwise is on the left.
        right, down = math.sin(heading), -math.cos(heading)
        found.append(
            Span(
                (x + radius * right, y + radius * down),
                (x2 + radius2 * right, y2 + radius2 * down),
                heading,
            )
        )
    return found


def arc(radius: float, heading_in: float, heading_out: float) -> float:
    """
    Return the length of rope that lies on a wheel [m].

    :param radius: as those of `spans` [m]
    :param heading_in: direction in which the rope comes to it [rad]
    :param heading_out: direction in which it goes on [rad]
    """
    turn = math.remainder(heading_out - heading_in, math.tau)
    # Around a wheel it may turn by more than half a turn, never against its side.
    return radius * (turn + (math.copysign(math.tau, radius) if radius * turn < 0.0 else 0.0))


def side(before: Point, center: Point, after: Point) -> float:
    """Return 1 where a line turns to the left at a point, and -1 where to the right."""
    (x, y), (x1, y1), (x2, y2) = before, center, after
    return 1.0 if (x1 - x) * (y2 - y1) - (y1 - y) * (x2 - x1) >= 0.0 else -1.0
