# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Plane geometry: angles, axes, small systems of equations, graphs; polylines, (n, 2) float64 [m].

Laws: the same bits on every x86-64 processor with FMA. BLAS and LAPACK (`@`, `dot`, `linalg`,
`convolve`) choose kernels by processor, and so do NumPy's loops for arctan2, exp, log and powers
but squares: here are closed forms, and the functions of `math`. Every function returns a fresh
array, and leaves its arguments as they are.
"""

from __future__ import annotations

from collections.abc import Iterator
import math
from typing import Literal

import numpy as np
from physsim_ros.model.arrays import Flags, Floats
from physsim_ros.model.shapes import Capsule, Circle, Convex, Piece
from physsim_ros.model.transform import cross, dots, next_vertices, norms, Point

_atan2 = np.frompyfunc(math.atan2, 2, 1)
# The point at which two polylines cross [m], and how far along each it lies [points].
Crossing = tuple[Floats, float, float]
# Sine of the least angle between lines that meet: 17 degrees.
LEAST_SINE = 0.3


def headings(vectors: Floats) -> Floats:
    """Return the directions of plane vectors (..., 2), -π .. π [rad]."""
    return np.asarray(_atan2(vectors[..., 1], vectors[..., 0]), dtype=np.float64)


def angles(a: Floats, b: Floats) -> Floats:
    """Return the angles from directions a to directions b [rad], counter-clockwise."""
    return np.asarray(_atan2(cross(a, b), dots(a, b)), dtype=np.float64)


def unit_vector(angle: float) -> Floats:
    """Return the unit vector of a direction [rad]."""
    return np.array((math.cos(angle), math.sin(angle)))


def quarter_heading(sides: Floats, weights: Floats) -> float:
    """
    Return the mean direction of sides modulo a quarter turn, -π/4 .. π/4 [rad].

    Four times the direction is the same for all sides of a rectangle.

    :param sides: (n, 2) float64
    :param weights: (n,) float64
    """
    x, y = (sides / np.maximum(norms(sides), 1e-300)[:, None]).T
    for _ in range(2):
        # The square of a complex number of length 1: twice its angle.
        x, y = x * x - y * y, 2.0 * x * y
    return math.atan2(float((weights * y).sum()), float((weights * x).sum())) / 4


def principal_axis(away: Floats) -> tuple[float, float, float]:
    """
    Return the greater principal axis of inertia of points about the origin.

    :param away: (n, 2) float64 [m]
    :return: its direction [rad]; the sums of squares along it and across it [m²]
    """
    x, y = away[:, 0], away[:, 1]
    xx, xy, yy = float((x * x).sum()), float((x * y).sum()), float((y * y).sum())
    angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
    middle, half = (xx + yy) / 2, math.hypot((xx - yy) / 2, xy)
    return angle, middle + half, max(middle - half, 0.0)


def meeting_point(one: Floats, along: Floats, other: Floats, beside: Floats) -> Floats | None:
    """
    Return where two lines meet, (2,) float64 [m]; None where they are nearly parallel.

    :param one: a point of the first, `along` its unit vector
    :param other: a point of the second, `beside` its unit vector
    """
    sine = float(cross(along, beside))
    # The intersection of nearly parallel lines is ill-conditioned.
    return one + along * (cross(other - one, beside) / sine) if abs(sine) > LEAST_SINE else None


def intersections(
    one: Floats, other: Floats, *, pairs: Flags | Literal[True] = True
) -> list[Crossing]:
    """
    Return the places where two polylines cross [m], each with its place along both [points].

    :param pairs: (n, k) bool: the segments of both that count; True: all
    """
    (x, y), (step_x, step_y) = one[:-1].T[..., None], np.diff(one, axis=0).T[..., None]
    (u, v), (step_u, step_v) = other[:-1].T, np.diff(other, axis=0).T
    away_x, away_y = u - x, v - y
    sine = step_x * step_v - step_y * step_u
    # Parallel segments do not cross; their rounding errors are excluded.
    near = pairs & (np.abs(sine) > 1e-6 * np.hypot(step_x, step_y) * np.hypot(step_u, step_v))
    sine = np.where(near, sine, 1.0)
    # As shares of the lengths of segments.
    first = (away_x * step_v - away_y * step_u) / sine
    last = (away_x * step_y - away_y * step_x) / sine
    meet = near & (first >= 0) & (first < 1) & (last >= 0) & (last < 1)
    places = [(i, j, float(first[i, j]), float(last[i, j])) for i, j in np.argwhere(meet).tolist()]
    return [(one[i] + a * (one[i + 1] - one[i]), i + a, j + b) for i, j, a, b in places]


def convex_hull(points: Floats) -> Floats:
    """
    Return the corners of the convex hull of points, counter-clockwise.

    Andrew's monotone chain (Andrew, 1979).
    """
    ordered = sorted(set(map(point_of, points)))
    hull: list[Point] = []
    for run in (ordered, ordered[::-1]):
        start = len(hull)
        for x, y in run:
            while len(hull) > start + 1:
                (a, b), (c, d) = hull[-2:]
                if (c - a) * (y - b) - (d - b) * (x - a) > 0.0:
                    break
                hull.pop()
            hull.append((x, y))
        hull.pop()
    return np.array(hull)


def stretched(points: Floats, along: Floats, factor: float) -> Floats:
    """Return points stretched by a factor along a unit vector: straight lines stay straight."""
    return points + ((factor - 1.0) * dots(points, along))[..., None] * along


def least_squares(columns: Floats, target: Floats) -> tuple[float, float]:
    """
    Return a, b for which a · one + b · other is nearest to the target (normal equations).

    :param columns: (n, 2) float64: one, other; 0, 0 is returned where they are parallel
    :param target: (n,) float64
    """
    one, other = columns[:, 0], columns[:, 1]
    aa, ab, bb = float((one * one).sum()), float((one * other).sum()), float((other**2).sum())
    at, bt = float((one * target).sum()), float((other * target).sum())
    determinant = aa * bb - ab * ab
    if determinant <= 1e-18 * aa * bb:
        return 0.0, 0.0
    return (at * bb - bt * ab) / determinant, (bt * aa - at * ab) / determinant


def spaced(path: Floats, count: int) -> Floats:
    """Return points along a polyline at equal distances."""
    x, y = path.T
    length = np.zeros(len(path))
    np.hypot(np.diff(x), np.diff(y)).cumsum(out=length[1:])
    at = np.arange(count) * (length[-1] / (count - 1))
    points = np.empty((count, 2))
    points[:, 0], points[:, 1] = np.interp(at, length, x), np.interp(at, length, y)
    return points


def size_of(points: Floats) -> float:
    """Return the diagonal of the bounding box of points [m]."""
    return float(norms(np.ptp(points, axis=0)))


def circle_outline(center: Point, radius: float, sides: int = 48) -> Floats:
    """Return a circle as a closed outline, (sides + 1, 2) float64 [m]."""
    angles = np.linspace(0.0, 2 * math.pi, sides + 1)
    circle: Floats = np.array(center) + radius * np.column_stack((np.cos(angles), np.sin(angles)))
    return circle


def path_length(path: Floats) -> float:
    """Return the length of a polyline [m]."""
    return float(norms(np.diff(path, axis=0)).sum())


def point_of(row: Floats) -> Point:
    """Return a row of an array as a point."""
    x, y = row.tolist()
    return x, y


def inside(points: Floats, outline: Floats) -> Flags:
    """Return whether points lie in a closed polyline, by the crossings of a ray (even-odd)."""
    start, end = outline, next_vertices(outline)
    x, y = points[:, :1], points[:, 1:]
    passes = (start[:, 1] > y) != (end[:, 1] > y)
    height = np.where(end[:, 1] == start[:, 1], 1.0, end[:, 1] - start[:, 1])
    at = start[:, 0] + (y - start[:, 1]) / height * (end[:, 0] - start[:, 0])
    inside: Flags = np.count_nonzero(passes & (x < at), axis=1) % 2 == 1
    return inside


def nearest_points(piece: Piece, point: Point) -> Iterator[Point]:
    """Yield points of a piece, the one nearest to a point outside it among them."""
    match piece:
        case Circle(center, radius):
            yield towards(center, point, radius)
        case Capsule(start, end, radius):
            yield towards(_nearest_on_segment(start, end, point), point, radius)
        case Convex(vertices):
            for start, end in zip(vertices, (*vertices[1:], vertices[0]), strict=True):
                yield _nearest_on_segment(start, end, point)


def towards(start: Point, end: Point, length: float) -> Point:
    """Return the point at a distance from `start` towards `end`; along x if they are one [m]."""
    distance = math.dist(start, end)
    if not distance:
        return start[0] + length, start[1]
    share = length / distance
    return start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])


def _nearest_on_segment(start: Point, end: Point, point: Point) -> Point:
    """Return the point of a segment that is nearest to another point [m]."""
    along = end[0] - start[0], end[1] - start[1]
    dot = (point[0] - start[0]) * along[0] + (point[1] - start[1]) * along[1]
    share = min(max(dot / max(along[0] ** 2 + along[1] ** 2, 1e-24), 0.0), 1.0)
    return start[0] + share * along[0], start[1] + share * along[1]


def connected(touching: Flags) -> list[list[int]]:
    """
    Return the connected components of a graph, as sorted lists of indices.

    :param touching: (n, n) bool: whether two touch each other, symmetric
    """
    left = np.ones(len(touching), np.bool_)
    groups = []
    while left.any():
        reached = np.arange(len(left)) == int(left.argmax())
        while (further := touching[reached].any(axis=0) & ~reached).any():
            reached |= further
        left &= ~reached
        groups.append(np.flatnonzero(reached).tolist())
    return groups
