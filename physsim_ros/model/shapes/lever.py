# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The lever of a shape: the mean distance of its points from its centroid.

Friction with the floor under a body that turns has this lever, where the body presses evenly: two
thirds of the radius of a disc.
"""

from __future__ import annotations

from functools import lru_cache
import math

from physsim_ros.model.shapes.form import Capsule, Circle, Convex, Form, Piece
from physsim_ros.model.transform import Point

# Corners of the polygon that counts for a round piece which is not about the centroid; its mean
# distance is within 1e-4 of the radius.
_CORNERS = 48


@lru_cache(maxsize=4096)
def lever_of(form: Form) -> float:
    """Return the mean distance of the points of a shape from its centroid [m]."""
    sums = [_sum_of_distances(piece, form.centroid) for piece in form.pieces]
    return math.fsum(total for _, total in sums) / math.fsum(area for area, _ in sums)


def _sum_of_distances(piece: Piece, center: Point) -> tuple[float, float]:
    """Return the area of a piece [m²], and the integral over it of the distance [m³]."""
    match piece:
        case Circle(middle, radius) if middle == center:
            return math.pi * radius**2, 2.0 / 3.0 * math.pi * radius**3
        case Circle(middle, radius):
            return _of_polygon(_round(middle, radius, 0.0, _CORNERS), center)
        case Capsule(start, end, radius):
            along = math.atan2(end[1] - start[1], end[0] - start[0])
            half = _CORNERS // 2
            first = _round(end, radius, along - math.pi / 2, half)
            return _of_polygon(first + _round(start, radius, along + math.pi / 2, half), center)
        case Convex(vertices):
            return _of_polygon(list(vertices), center)


def _round(middle: Point, radius: float, begin: float, count: int) -> list[Point]:
    """Return corners of a full or half circle of the same area, counter-clockwise."""
    step = math.tau / _CORNERS
    # The area of a polygon is that of the circle times sin(step) / step.
    outer = radius * math.sqrt(step / math.sin(step))
    angles = (begin + step * (number + 0.5) for number in range(count))
    return [
        (middle[0] + outer * math.cos(angle), middle[1] + outer * math.sin(angle))
        for angle in angles
    ]


def _of_polygon(corners: list[Point], center: Point) -> tuple[float, float]:
    """Return the area of a polygon, and the integral of the distance from a point over it."""
    area = total = 0.0
    x0, y0 = corners[-1][0] - center[0], corners[-1][1] - center[1]
    for corner in corners:
        x1, y1 = corner[0] - center[0], corner[1] - center[1]
        doubled = x0 * y1 - y0 * x1
        length = math.hypot(x1 - x0, y1 - y0)
        area += doubled / 2
        if doubled and length:
            # A triangle from the point to an edge at height h: in polar coordinates h³/3 times
            # the integral of sec³, from t0 to t1 along the edge, by its tangents; negative where
            # the polygon does not lie on that side.
            height = doubled / length
            t0 = (x0 * (x1 - x0) + y0 * (y1 - y0)) / length / abs(height)
            t1 = (x1 * (x1 - x0) + y1 * (y1 - y0)) / length / abs(height)
            total += height**3 / 6 * (_secant_cubed(t1) - _secant_cubed(t0))
        x0, y0 = x1, y1
    return area, total


def _secant_cubed(tangent: float) -> float:
    """Return twice the integral of sec³ from 0 to the angle of a tangent."""
    return tangent * math.hypot(1.0, tangent) + math.asinh(tangent)
