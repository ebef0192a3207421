# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
The shapes of bodies: validated values and what they are made of.

Law: whatever has been constructed can be simulated. One degenerate polygon makes every later
step of the engine raise, so nothing of that kind gets past this file.

Lengths in metres, in the body's own frame (origin at the body's position, x right, y up).
"""

from __future__ import annotations

from collections.abc import Sequence
import contextlib
from dataclasses import dataclass, field
import itertools
import math

import numpy as np
from physsim_ros.model import polygon
from physsim_ros.model.errors import BadOutline, BadSize, Malformed
from physsim_ros.model.polygon import Corners

Point = tuple[float, float]
# x, y [m], yaw [rad]; the same three of a twist or wrench where a name says so.
Pose = tuple[float, float, float]
# Red, green, blue, alpha, each 0 .. 1.
Color = tuple[float, float, float, float]

# A fifth of the engine's contact slop (5 mm); what is smaller sinks into it and is not held.
SMALLEST = 1e-3
# 100 km: beyond it a float64 position no longer resolves the slop after a long run.
LARGEST = 1e5
# Splitting an outline with that many corners stalls the world for three frames (50 ms).
MOST_POINTS = 1000
# What lies as near as that to the point before is the same point [m]: a thousandth of SMALLEST.
MERGED = 1e-6
# What has less area than this by its length [m], or by its length squared, has none.
FLAT = 1e-9
# That share of a solid may lie in parts too thin for the engine, which are left out of it.
SLIVERS = 1e-3


@dataclass(frozen=True, slots=True)
class Circle:
    """A convex piece: a full circle [m]."""

    center: Point
    radius: float


@dataclass(frozen=True, slots=True)
class Convex:
    """A convex piece: vertices counter-clockwise [m], at least three."""

    vertices: tuple[Point, ...]


@dataclass(frozen=True, slots=True)
class Capsule:
    """A convex piece: a segment with round ends [m]."""

    start: Point
    end: Point
    radius: float


Piece = Circle | Convex | Capsule


@dataclass(frozen=True, slots=True)
class Form:
    """
    What a shape is made of and how its mass lies.

    :param pieces: convex pieces, together the whole shape
    :param area: [m²]
    :param centroid: centre of mass at uniform density [m]
    :param gyration: moment of inertia about the centroid for each kilogram [m²]
    :param outer: greatest distance of a point of the shape from the centroid [m]
    :param inner: half the least width of the thinnest piece [m]
    """

    pieces: tuple[Piece, ...]
    area: float
    centroid: Point
    gyration: float
    outer: float
    inner: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Disc:
    """
    A full circle about the body's position.

    :param radius: [m]
    :raises BadSize: the radius is out of range
    :raises Malformed: the radius is not finite
    """

    radius: float
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, 'radius', _length(self.radius, 'radius'))
        object.__setattr__(self, 'form', _form((Circle((0.0, 0.0), self.radius),)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Box:
    """
    A rectangle about the body's position, its sides along the body's axes.

    :param width: along x [m]
    :param height: along y [m]
    :raises BadSize: a side is out of range
    :raises Malformed: a side is not finite
    """

    width: float
    height: float
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, 'width', _length(self.width, 'width'))
        object.__setattr__(self, 'height', _length(self.height, 'height'))
        object.__setattr__(self, 'form', _form((Convex(self.corners()),)))

    def corners(self, center: Point = (0.0, 0.0)) -> tuple[Point, ...]:
        """Return the four corners about a centre, counter-clockwise from lower left."""
        x, y = center
        half_width, half_height = self.width / 2, self.height / 2
        return (
            (x - half_width, y - half_height),
            (x + half_width, y - half_height),
            (x + half_width, y + half_height),
            (x - half_width, y + half_height),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Polygon:
    """
    A solid with any simple outline, convex or not.

    :param outline: the corners in order, either way round, the first not repeated [m]
    :raises BadOutline: it crosses or touches itself, encloses no area or has too many corners
    :raises BadSize: it is too large or too thin
    :raises Malformed: a coordinate is not finite
    """

    outline: tuple[Point, ...]
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        outline = _distinct(_points(self.outline, 'outline'), closed=True)
        object.__setattr__(self, 'outline', tuple(map(tuple, outline.tolist())))
        if len(outline) < 3:
            raise BadOutline('an outline needs three different corners', field='points')
        area = polygon.signed_area(outline)
        if area < 0:
            outline = outline[::-1]
        least = float(np.ptp(outline, axis=0).max()) ** 2 * FLAT
        if abs(area) <= least:
            # Loops that run opposite ways enclose as much as nothing, and cross.
            looped = polygon.swept_area(outline) > least and polygon.crosses_itself(outline)
            reason = 'crosses or touches itself' if looped else 'encloses no area'
            raise BadOutline(f'the outline {reason}', field='points')
        pieces = _split(outline)
        # What is weighed is the outline itself, slivers and all.
        whole = Convex(tuple(map(tuple, outline.tolist())))
        object.__setattr__(self, 'form', _form(pieces, whole=(whole,)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Chain:
    """
    Segments with round ends, one after the other, for walls and terrain.

    :param points: at least two, in order [m]
    :param thickness: of the line [m]
    :raises BadOutline: fewer than two different points, or too many
    :raises BadSize: the thickness is out of range
    :raises Malformed: a number is not finite
    """

    points: tuple[Point, ...]
    thickness: float
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, 'thickness', _length(self.thickness, 'thickness'))
        points = _distinct(_points(self.points, 'points'), closed=False)
        if len(points) < 2:
            raise BadOutline('a chain needs two different points', field='points')
        corners: list[Point] = list(map(tuple, points.tolist()))
        object.__setattr__(self, 'points', tuple(corners))
        pieces = tuple(
            Capsule(start, end, self.thickness / 2) for start, end in itertools.pairwise(corners)
        )
        object.__setattr__(self, 'form', _form(pieces))


@dataclass(frozen=True, slots=True, kw_only=True)
class Triangles:
    """
    A solid made of triangles, which may overlap; where they do, they weigh twice.

    :param vertices: three for each triangle [m]
    :raises BadOutline: the count is no multiple of three, or too high, or a triangle is flat
    :raises BadSize: a triangle is too large or too thin
    :raises Malformed: a coordinate is not finite
    """

    vertices: tuple[Point, ...]
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        vertices = _points(self.vertices, 'vertices')
        if len(vertices) == 0 or len(vertices) % 3:
            raise BadOutline('triangles need three points each', field='vertices')
        object.__setattr__(self, 'vertices', tuple(map(tuple, vertices.tolist())))
        triangles = vertices.reshape(-1, 3, 2)
        turn = polygon.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        triangles = np.where((turn < 0)[:, None, None], triangles[:, ::-1], triangles)
        object.__setattr__(self, 'form', _form(tuple(_convex(triangle) for triangle in triangles)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Compound:
    """
    One body made of the same disc or box at several places.

    :param element: what is repeated
    :param centers: where [m]
    :raises BadOutline: no centre, or too many
    :raises Malformed: a coordinate is not finite
    """

    element: Disc | Box
    centers: tuple[Point, ...]
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        centers: list[Point] = list(map(tuple, _points(self.centers, 'centers').tolist()))
        if not centers:
            raise BadOutline('a compound needs at least one element', field='centers')
        object.__setattr__(self, 'centers', tuple(centers))
        pieces: tuple[Piece, ...]
        if isinstance(self.element, Disc):
            pieces = tuple(Circle(center, self.element.radius) for center in centers)
        else:
            pieces = tuple(Convex(self.element.corners(center)) for center in centers)
        object.__setattr__(self, 'form', _form(pieces))


Shape = Disc | Box | Polygon | Chain | Triangles | Compound


def _length(value: float, name: str) -> float:
    """Return a length as a float, or refuse one that cannot be simulated."""
    if not math.isfinite(value):
        raise Malformed(f'{name} is {value}, not a finite number', field=name)
    if not SMALLEST <= value <= LARGEST:
        raise BadSize(
            f'{name} is {value:g} m; it must lie between {SMALLEST:g} and {LARGEST:g} m',
            field=name,
        )
    return float(value)


def _points(points: Sequence[Point], name: str) -> Corners:
    """Return points as (n, 2) float64, or refuse them."""
    try:
        array = np.array([(x, y) for x, y in points], dtype=np.float64).reshape(-1, 2)
    except (TypeError, ValueError, OverflowError) as error:
        raise Malformed(f'{name} must be pairs of numbers', field=name) from error
    if not np.isfinite(array).all():
        raise Malformed(f'{name} holds a coordinate that is not finite', field=name)
    if len(array) > MOST_POINTS:
        raise BadOutline(f'{name} holds more than {MOST_POINTS} points', field=name)
    if len(array) and np.abs(array).max() > LARGEST:
        raise BadSize(f'{name} reaches further than {LARGEST:g} m', field=name)
    return array


def _distinct(points: Corners, *, closed: bool) -> Corners:
    """Drop points that repeat the one before them."""
    keep: list[int] = []
    for at, (x, y) in enumerate(points.tolist()):
        if not keep or math.dist((x, y), points[keep[-1]]) > MERGED:
            keep.append(at)
    while closed and len(keep) > 1 and math.dist(points[keep[0]], points[keep[-1]]) <= MERGED:
        keep.pop()
    return points[keep]


def _convex(vertices: Corners) -> Convex:
    """Make a convex piece, or refuse one that is too thin for the engine."""
    piece = Convex(tuple(map(tuple, vertices.tolist())))
    edges = np.roll(vertices, -1, axis=0) - vertices
    longest = float(np.hypot(edges[:, 0], edges[:, 1]).max())
    if polygon.signed_area(vertices) <= longest * FLAT:
        raise BadOutline('an outline encloses no area', field='points')
    if 2 * _thinness(piece) < SMALLEST:
        raise BadSize(f'a part is thinner than {SMALLEST:g} m', field='points')
    return piece


def _split(outline: Corners) -> tuple[Piece, ...]:
    """Split a simple outline, counter-clockwise, into convex pieces."""
    if polygon.crosses_itself(outline):
        raise BadOutline('the outline crosses or touches itself', field='points')
    if polygon.is_convex(outline):
        return (_convex(outline),)
    # About a corner of its own, so that outlines far from the origin lose no digits.
    parts = [part + outline[0] for part in polygon.convex_parts(outline - outline[0])]
    pieces: list[Piece] = []
    covered = held = 0.0
    for part in parts:
        area = polygon.signed_area(part)
        covered += area
        # The split may leave slivers along nearly straight runs; they hold nothing up.
        with contextlib.suppress(BadOutline, BadSize):
            pieces.append(_convex(part))
            held += area
    whole = polygon.signed_area(outline)
    if abs(covered - whole) > SLIVERS * whole:
        raise BadOutline('the outline cannot be split into convex parts', field='points')
    if whole - held > SLIVERS * whole:
        raise BadSize(f'a part is thinner than {SMALLEST:g} m', field='points')
    return tuple(pieces)


def _form(pieces: tuple[Piece, ...], *, whole: tuple[Piece, ...] | None = None) -> Form:
    """
    Sum up area, centroid and moment, and measure the extent.

    :param pieces: convex
    :param whole: what is weighed and measured, where it is not the pieces
    """
    whole = whole or pieces
    measures = [_measure(piece) for piece in whole]
    area = math.fsum(measure[0] for measure in measures)
    x = math.fsum(measure[0] * measure[1][0] for measure in measures) / area
    y = math.fsum(measure[0] * measure[1][1] for measure in measures) / area
    gyration = (
        math.fsum(
            part_area * (part_gyration + (cx - x) ** 2 + (cy - y) ** 2)
            for part_area, (cx, cy), part_gyration in measures
        )
        / area
    )
    outer = max(_reach(piece, (x, y)) for piece in whole)
    # A symmetric shape is balanced about its origin to the bit, whatever the sums round to.
    if math.hypot(x, y) < 1e-12 * outer:
        x = y = 0.0
    return Form(
        pieces=pieces,
        area=area,
        centroid=(x, y),
        gyration=gyration,
        outer=outer,
        inner=min(_thinness(piece) for piece in pieces),
    )


def _measure(piece: Piece) -> tuple[float, Point, float]:
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
            # https://en.wikipedia.org/wiki/Second_moment_of_area#Any_polygon, about a corner
            # of its own so that pieces far from the origin lose no digits.
            origin = np.array(corners[0])
            vertices = np.array(corners) - origin
            following = np.roll(vertices, -1, axis=0)
            cross = polygon.cross(vertices, following)
            area = float(cross.sum()) / 2
            center = ((vertices + following) * cross[:, None]).sum(axis=0) / (6 * area)
            squares = (vertices**2 + vertices * following + following**2).sum(axis=1)
            about_corner = float((squares * cross).sum()) / (12 * area)
            x, y = (center + origin).tolist()
            return area, (x, y), about_corner - float(center @ center)


def _reach(piece: Piece, origin: Point) -> float:
    match piece:
        case Circle(center, radius):
            return math.dist(center, origin) + radius
        case Capsule(start, end, radius):
            return max(math.dist(start, origin), math.dist(end, origin)) + radius
        case Convex(vertices):
            return max(math.dist(vertex, origin) for vertex in vertices)


def _thinness(piece: Piece) -> float:
    match piece:
        case Circle(_, radius) | Capsule(_, _, radius):
            return radius
        case Convex(vertices):
            corners = np.array(vertices)
            edges = np.roll(corners, -1, axis=0) - corners
            normals = np.column_stack((edges[:, 1], -edges[:, 0]))
            normals /= np.hypot(edges[:, 0], edges[:, 1])[:, None]
            widths = np.ptp(corners @ normals.T, axis=0)
            return float(widths.min()) / 2
