# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The kinds of shapes: one class each, of validated values.

Each has its key in world files, its entry there, and its form: convex pieces and mass properties.
"""

from __future__ import annotations

from dataclasses import dataclass, field
import itertools
from typing import ClassVar, get_args, Self

import numpy as np
from physsim_ros.model.checks import number, OfClass, point_list
from physsim_ros.model.declarations import known_mapping
from physsim_ros.model.errors import BadOutline, BadProperty
from physsim_ros.model.shapes.form import (
    Capsule,
    Circle,
    Convex,
    Form,
    form_of,
    Piece,
    share_forms,
)
from physsim_ros.model.shapes.polygons import (
    convex_piece,
    convex_pieces,
    crosses_itself,
    DEGENERATE,
    signed_area,
    unsigned_fan_area,
)
from physsim_ros.model.shapes.validation import (
    as_tuples,
    checked_length,
    checked_points,
    distinct_points,
)
from physsim_ros.model.transform import cross, Point


@dataclass(frozen=True, slots=True, kw_only=True)
class Disc:
    """
    A disc, about the body's position (Box2D and Pymunk: a circle).

    :param radius: [m]
    :raises BadSize: the radius is out of range
    :raises Malformed: the radius is not finite
    """

    KEY: ClassVar = 'circle'

    radius: float
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, 'radius', checked_length(self.radius, 'radius'))
        object.__setattr__(self, 'form', form_of((Circle((0.0, 0.0), self.radius),)))

    @classmethod
    def from_entry(cls, entry: object) -> Self:
        """Return the disc of a world file's entry."""
        known = known_mapping(entry, cls.KEY, ['radius'])
        return cls(radius=number(known.get('radius'), 'radius'))

    def entry(self) -> object:
        """Return the entry of a world file."""
        return {'radius': self.radius}


@dataclass(frozen=True, slots=True, kw_only=True)
class Box:
    """
    A rectangle about the body's position, its sides along the body's axes.

    :param width: along x [m]
    :param height: along y [m]
    :raises BadSize: a side is out of range
    :raises Malformed: a side is not finite
    """

    KEY: ClassVar = 'box'

    width: float
    height: float
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, 'width', checked_length(self.width, 'width'))
        object.__setattr__(self, 'height', checked_length(self.height, 'height'))
        object.__setattr__(self, 'form', form_of((Convex(self.corners()),)))

    def corners(self, center: Point = (0.0, 0.0)) -> tuple[Point, ...]:
        """Return the four corners about a centre [m], counter-clockwise from lower left."""
        x, y = center
        half_width, half_height = self.width / 2, self.height / 2
        return (
            (x - half_width, y - half_height),
            (x + half_width, y - half_height),
            (x + half_width, y + half_height),
            (x - half_width, y + half_height),
        )

    @classmethod
    def from_entry(cls, entry: object) -> Self:
        """Return the box of a world file's entry."""
        known = known_mapping(entry, cls.KEY, ['width', 'height'])
        width, height = (number(known.get(side), side) for side in ('width', 'height'))
        return cls(width=width, height=height)

    def entry(self) -> object:
        """Return the entry of a world file."""
        return {'width': self.width, 'height': self.height}


@dataclass(frozen=True, slots=True, kw_only=True)
class Polygon:
    """
    A solid with any simple outline.

    :param outline: the vertices in order, either way round, the first not repeated [m]
    :raises BadOutline: it crosses or touches itself, encloses no area or has too many vertices
    :raises BadSize: it is too large or too thin
    :raises Malformed: a coordinate is not finite
    """

    KEY: ClassVar = 'polygon'

    outline: tuple[Point, ...]
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        outline = distinct_points(checked_points(self.outline, 'outline'), closed=True)
        object.__setattr__(self, 'outline', as_tuples(outline))
        object.__setattr__(self, 'form', _form_of_outline(self.outline))

    @classmethod
    def from_entry(cls, entry: object) -> Self:
        """Return the polygon of a world file's entry."""
        return cls(outline=point_list(entry, cls.KEY))

    def entry(self) -> object:
        """Return the entry of a world file."""
        return [list(point) for point in self.outline]


@share_forms
def _form_of_outline(points: tuple[Point, ...]) -> Form:
    """
    Return the form of a polygon.

    :raises BadOutline: it crosses or touches itself, or encloses no area
    :raises BadSize: it is too thin
    """
    outline = np.array(points)
    if len(outline) < 3:
        raise BadOutline('an outline needs three different corners', field='points')
    area = signed_area(outline)
    if area < 0:
        outline = outline[::-1]
    least = float(np.ptp(outline, axis=0).max()) ** 2 * DEGENERATE
    if abs(area) <= least:
        # The areas of two loops of opposite orientation cancel.
        looped = unsigned_fan_area(outline) > least and crosses_itself(outline)
        reason = 'crosses or touches itself' if looped else 'encloses no area'
        raise BadOutline(f'the outline {reason}', field='points')
    pieces = convex_pieces(outline)
    # Mass and extent are those of the outline, slivers included.
    whole = Convex(as_tuples(outline))
    return form_of(pieces, (whole,))


@dataclass(frozen=True, slots=True, kw_only=True)
class Triangles:
    """
    A solid made of triangles; where they overlap, the mass of both counts.

    :param vertices: three for each triangle, either way round [m]
    :raises BadOutline: the count is no multiple of three, or too high, or a triangle is degenerate
    :raises BadSize: a triangle is too large or too thin
    :raises Malformed: a coordinate is not finite
    """

    KEY: ClassVar = 'triangles'

    vertices: tuple[Point, ...]
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        vertices = checked_points(self.vertices, 'vertices')
        if len(vertices) == 0 or len(vertices) % 3:
            raise BadOutline('triangles need three points each', field='vertices')
        object.__setattr__(self, 'vertices', as_tuples(vertices))
        triangles = vertices.reshape(-1, 3, 2)
        turn = cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        triangles = np.where((turn < 0)[:, None, None], triangles[:, ::-1], triangles)
        pieces = tuple(convex_piece(triangle) for triangle in triangles)
        object.__setattr__(self, 'form', form_of(pieces))

    @classmethod
    def from_entry(cls, entry: object) -> Self:
        """Return the triangles of a world file's entry."""
        return cls(vertices=point_list(entry, cls.KEY))

    def entry(self) -> object:
        """Return the entry of a world file."""
        return [list(vertex) for vertex in self.vertices]


@dataclass(frozen=True, slots=True, kw_only=True)
class Chain:
    """
    A chain of segments with round ends, for walls and terrain (Box2D: a chain shape).

    :param points: at least two, in order [m]
    :param thickness: of the segments [m]
    :raises BadOutline: fewer than two different points, or too many
    :raises BadSize: the thickness is out of range
    :raises Malformed: a number is not finite
    """

    KEY: ClassVar = 'chain'

    points: tuple[Point, ...]
    thickness: float
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, 'thickness', checked_length(self.thickness, 'thickness'))
        distinct = distinct_points(checked_points(self.points, 'points'), closed=False)
        if len(distinct) < 2:
            raise BadOutline('a chain needs two different points', field='points')
        object.__setattr__(self, 'points', as_tuples(distinct))
        pieces = tuple(
            Capsule(start, end, self.thickness / 2)
            for start, end in itertools.pairwise(self.points)
        )
        object.__setattr__(self, 'form', form_of(pieces))

    @classmethod
    def from_entry(cls, entry: object) -> Self:
        """Return the chain of a world file's entry."""
        known = known_mapping(entry, cls.KEY, ['points', 'thickness'])
        thickness = number(known.get('thickness'), 'thickness')
        return cls(points=point_list(known.get('points'), 'points'), thickness=thickness)

    def entry(self) -> object:
        """Return the entry of a world file."""
        return {'points': [list(point) for point in self.points], 'thickness': self.thickness}


@dataclass(frozen=True, slots=True, kw_only=True)
class Compound:
    """
    A compound: the same disc or box at several positions, not rotated, as one rigid body.

    :param element: the disc or box
    :param centers: its positions [m]
    :raises BadOutline: no centre, or too many
    :raises Malformed: a coordinate is not finite, or the element is something else
    """

    KEY: ClassVar = 'compound'

    element: Disc | Box
    centers: tuple[Point, ...]
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        OfClass(Disc | Box)(self.element, 'element')
        centers = as_tuples(checked_points(self.centers, 'centers'))
        if not centers:
            raise BadOutline('a compound needs at least one element', field='centers')
        object.__setattr__(self, 'centers', centers)
        pieces: tuple[Piece, ...]
        if isinstance(self.element, Disc):
            pieces = tuple(Circle(center, self.element.radius) for center in centers)
        else:
            pieces = tuple(Convex(self.element.corners(center)) for center in centers)
        object.__setattr__(self, 'form', form_of(pieces))

    @classmethod
    def from_entry(cls, entry: object) -> Self:
        """Return the compound of a world file's entry."""
        known = known_mapping(entry, cls.KEY, [Disc.KEY, Box.KEY, 'centers'])
        named = [each for each in (Disc, Box) if each.KEY in known]
        if len(named) != 1:
            raise BadProperty(f'a compound has one of {Disc.KEY}, {Box.KEY}', field='shape')
        element = named[0].from_entry(known[named[0].KEY])
        return cls(element=element, centers=point_list(known.get('centers'), 'centers'))

    def entry(self) -> object:
        """Return the entry of a world file."""
        centers = [list(center) for center in self.centers]
        return {self.element.KEY: self.element.entry(), 'centers': centers}


Shape = Disc | Box | Polygon | Chain | Triangles | Compound
# By the key of world files.
SHAPES: dict[str, type[Shape]] = {each.KEY: each for each in get_args(Shape)}
