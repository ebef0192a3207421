# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Form of a shape: its convex pieces, mass properties, extent and lever, in the body's frame.

The engine makes one of its own shapes of each piece: Pymunk's Circle, Poly and Segment. Area,
centroid and moment of inertia are at a density of 1 kg/m² (Box2D: mass data). The lever is the
mean distance of its points from its centroid: friction with the floor under a body that turns has
it, where the body presses evenly; two thirds of the radius of a disc.

Law: equal shapes share one form, which lives as long as a shape of it does, in the world or in the
past, whose budget counts it. A few forms outlive their shapes: a body that is deleted is often
spawned again.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from functools import wraps
import math
from typing import Any, cast, TypeVar
from weakref import WeakValueDictionary

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.transform import cross, next_vertices, Point, Pose, rotated
from physsim_ros.model.weak_cache import cached_weakly

# A centroid closer to the origin than this share of the extent lies at the origin: a symmetric
# shape is balanced to the bit, however its sums round.
_CENTERED = 1e-12
# Forms that outlive their shapes [1]: at most 6 MB, if each has 1,000 pieces.
MOST_KEPT = 16

_Make = TypeVar('_Make', bound=Callable[..., Any])


@dataclass(frozen=True, slots=True)
class Circle:
    """A full circle [m]."""

    center: Point
    radius: float


@dataclass(frozen=True, slots=True)
class Convex:
    """A convex polygon: vertices counter-clockwise [m], at least three."""

    vertices: tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class Capsule:
    """A segment with round ends [m]."""

    start: Point
    end: Point
    radius: float


Piece = Circle | Convex | Capsule


# Shapes are compared by what they are made of; of a form, others keep what they derive from it.
@dataclass(frozen=True, slots=True, eq=False, weakref_slot=True)
class Form:
    """
    The pieces of a shape, its mass properties and its extent, in the body's frame.

    :param pieces: convex, together the whole shape
    :param area: [m²]
    :param centroid: centre of mass at uniform density [m]
    :param gyration: squared radius of gyration: moment of inertia about the centroid by mass [m²]
    :param outer: greatest distance of a point of the shape from the centroid [m]
    :param inner: half the least width of the thinnest piece [m]
    """

    pieces: tuple[Piece, ...]
    area: float
    centroid: Point
    gyration: float
    outer: float
    inner: float


def share_forms(make: _Make) -> _Make:
    """Cache the forms that a function makes, by its positional arguments, which are hashable."""
    forms: WeakValueDictionary[Hashable, Any] = WeakValueDictionary()
    kept: deque[Any] = deque(maxlen=MOST_KEPT)

    @wraps(make)
    def form_of(*arguments: Hashable) -> Any:
        form = forms.get(arguments)
        if form is None:
            form = forms[arguments] = make(*arguments)
            kept.append(form)
        return form

    return cast('_Make', form_of)


@share_forms
def form_of(pieces: tuple[Piece, ...], whole: tuple[Piece, ...] = ()) -> Form:
    """
    Return pieces with their mass properties and extent.

    :param pieces: convex
    :param whole: pieces that mass and extent are of, which may be concave; () is `pieces`
    """
    whole = whole or pieces
    measures = [_mass_properties(piece) for piece in whole]
    area = math.fsum(measure[0] for measure in measures)
    x = math.fsum(measure[0] * measure[1][0] for measure in measures) / area
    y = math.fsum(measure[0] * measure[1][1] for measure in measures) / area
    # By the parallel axis theorem.
    gyration = (
        math.fsum(
            part_area * (part_gyration + (cx - x) ** 2 + (cy - y) ** 2)
            for part_area, (cx, cy), part_gyration in measures
        )
        / area
    )
    outer = max(_greatest_distance(piece, (x, y)) for piece in whole)
    if math.hypot(x, y) < _CENTERED * outer:
        x = y = 0.0
    return Form(
        pieces=pieces,
        area=area,
        centroid=(x, y),
        gyration=gyration,
        outer=outer,
        inner=min(half_width(piece) for piece in pieces),
    )


@cached_weakly
def extent_of(form: Form) -> tuple[Point, Point]:
    """Return the lower left and the upper right corner of the box around a form [m]."""
    left, bottom, right, top = zip(*(piece_box(piece) for piece in form.pieces), strict=True)
    return (min(left), min(bottom)), (max(right), max(top))


def piece_box(piece: Piece, pose: Pose = (0.0, 0.0, 0.0)) -> tuple[float, float, float, float]:
    """
    Return left, bottom, right and top of the box around a piece [m].

    :param pose: of the frame of the piece
    """
    points: tuple[Point, ...]
    match piece:
        case Circle(center, radius):
            points, margin = (center,), radius
        case Capsule(start, end, radius):
            points, margin = (start, end), radius
        case Convex(vertices):
            points, margin = vertices, 0.0
    corners = [rotated(point, pose[2]) for point in points]
    x = [pose[0] + point[0] for point in corners]
    y = [pose[1] + point[1] for point in corners]
    return min(x) - margin, min(y) - margin, max(x) + margin, max(y) + margin


def half_width(piece: Piece) -> float:
    """Return half the least width of a piece [m]."""
    match piece:
        case Circle(_, radius) | Capsule(_, _, radius):
            return radius
        case Convex(vertices):
            corners = np.array(vertices)
            edges = next_vertices(corners) - corners
            normals = np.column_stack((edges[:, 1], -edges[:, 0]))
            normals /= np.hypot(edges[:, 0], edges[:, 1])[:, None]
            across = corners[:, :1] * normals[:, 0] + corners[:, 1:] * normals[:, 1]
            return float(np.ptp(across, axis=0).min()) / 2


def _mass_properties(piece: Piece) -> tuple[float, Point, float]:
    """Return area [m²], centroid [m] and squared radius of gyration about it [m²]."""
    match piece:
        case Circle(center, radius):
            return math.pi * radius**2, center, radius**2 / 2
        case Capsule(start, end, radius):
            length = math.dist(start, end)
            middle = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2)
            bar, caps = 2 * radius * length, math.pi * radius**2
            # Two half discs: their own moment about the segment's ends, shifted to the middle
            # by the parallel axis theorem; the cross term is the half disc's centroid 4r/3π.
            moment = bar * (length**2 + 4 * radius**2) / 12 + caps * (
                radius**2 / 2 + length**2 / 4 + 4 * radius * length / (3 * math.pi)
            )
            return bar + caps, middle, moment / (bar + caps)
        case Convex(corners):
            # https://en.wikipedia.org/wiki/Second_moment_of_area#Any_polygon, relative to one of
            # its vertices, so that coordinates far from the origin lose no digits.
            origin = np.array(corners[0])
            vertices = np.array(corners) - origin
            following = next_vertices(vertices)
            doubled = cross(vertices, following)
            area = float(doubled.sum()) / 2
            center = ((vertices + following) * doubled[:, None]).sum(axis=0) / (6 * area)
            squares = (vertices**2 + vertices * following + following**2).sum(axis=1)
            about_vertex = float((squares * doubled).sum()) / (12 * area)
            x, y = (center + origin).tolist()
            return area, (x, y), about_vertex - float((center * center).sum())


def _greatest_distance(piece: Piece, point: Point) -> float:
    match piece:
        case Circle(center, radius):
            return math.dist(center, point) + radius
        case Capsule(start, end, radius):
            return max(math.dist(start, point), math.dist(end, point)) + radius
        case Convex(vertices):
            return max(math.dist(vertex, point) for vertex in vertices)


# Corners of the polygon that counts for a round piece which is not about the centroid; its mean
# distance is within 1e-4 of the radius.
_CORNERS = 48


@cached_weakly
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


def _round(
    middle: Point, radius: float, begin: float, count: int, corners: int = _CORNERS
) -> list[Point]:
    """
    Return corners of a full or half circle of the same area, counter-clockwise.

    :param corners: of a full circle
    """
    step = math.tau / corners
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


# Corners of the polygon that counts for a round piece in a hull; its width is that of the disc
# within 0.3 %.
_HULL_CORNERS = 32


@cached_weakly
def hull_of(form: Form) -> Floats:
    """
    Return the convex hull of a form, round pieces as polygons of the same area.

    Andrew's monotone chain.

    :return: (h, 2) float64: corners counter-clockwise, about the centroid [m]
    """
    points: set[Point] = set()
    for piece in form.pieces:
        match piece:
            case Circle(middle, radius):
                points.update(_round(middle, radius, 0.0, _HULL_CORNERS, _HULL_CORNERS))
            case Capsule(start, end, radius):
                for middle in (start, end):
                    points.update(_round(middle, radius, 0.0, _HULL_CORNERS, _HULL_CORNERS))
            case Convex(vertices):
                points.update(vertices)
    ordered = sorted(points)
    hull = [*_right_chain(ordered), *_right_chain(ordered[::-1])]
    return np.array(hull) - form.centroid


def _right_chain(points: list[Point]) -> list[Point]:
    """Return the corners of the hull to the right of the way along sorted points, but the last."""
    chain: list[Point] = []
    for x, y in points:
        while len(chain) > 1 and (
            (chain[-1][0] - chain[-2][0]) * (y - chain[-2][1])
            <= (chain[-1][1] - chain[-2][1]) * (x - chain[-2][0])
        ):
            chain.pop()
        chain.append((x, y))
    return chain[:-1]
