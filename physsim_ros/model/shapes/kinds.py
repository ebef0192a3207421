# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The kinds of shapes: one class each, of validated values.

Each has its key in world files, and its form: convex pieces and mass properties.
"""

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
import itertools
from typing import Annotated, Any, ClassVar, get_args, Self, TypeVar

import numpy as np
from physsim_ros.model.checks import OfClass, point_list
from physsim_ros.model.declarations import Checked, known_mapping
from physsim_ros.model.errors import BadOutline, BadProperty
from physsim_ros.model.shapes.form import (
    Capsule,
    Circle,
    Convex,
    Form,
    form_of,
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
from physsim_ros.model.texts import Words
from physsim_ros.model.transform import cross, Point

_Kind = TypeVar('_Kind', bound=Checked)


def _points(value: Any, name: str) -> tuple[Point, ...]:
    # A point of a file that is no pair of numbers is refused by its number in the list.
    points = point_list(value, name) if isinstance(value, list) else value
    return as_tuples(checked_points(points, name))


def _outline(value: Any, name: str) -> tuple[Point, ...]:
    return distinct_points(_points(value, name), closed=True)


def _line(value: Any, name: str) -> tuple[Point, ...]:
    return distinct_points(_points(value, name), closed=False)


@dataclass(frozen=True, slots=True, kw_only=True)
class _ShapeKind(Checked, ABC):
    """
    The base of shapes.

    :ivar form: its convex pieces, mass properties and extent
    """

    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        object.__setattr__(self, 'form', self._form())

    @abstractmethod
    def _form(self) -> Form:
        """Return the form, of the fields, which are checked."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Disc(_ShapeKind):
    """
    A disc, about the body's position (Box2D and Pymunk: a circle).

    :raises BadSize: the radius is out of range
    :raises Malformed: the radius is not finite
    """

    KEY: ClassVar = 'circle'

    radius: Annotated[float, checked_length, '[m]']

    def _form(self) -> Form:
        return form_of((Circle((0.0, 0.0), self.radius),))


@dataclass(frozen=True, slots=True, kw_only=True)
class Box(_ShapeKind):
    """
    A rectangle about the body's position, its sides along the body's axes.

    :raises BadSize: a side is out of range
    :raises Malformed: a side is not finite
    """

    KEY: ClassVar = 'box'

    width: Annotated[float, checked_length, 'along x [m]']
    height: Annotated[float, checked_length, 'along y [m]']

    def _form(self) -> Form:
        return form_of((Convex(self.corners()),))

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


@dataclass(frozen=True, slots=True, kw_only=True)
class Polygon(_ShapeKind):
    """
    A solid with any simple outline.

    :raises BadOutline: it crosses or touches itself, encloses no area or has too many vertices
    :raises BadSize: it is too large or too thin
    :raises Malformed: a coordinate is not finite
    """

    KEY: ClassVar = 'polygon'

    outline: Annotated[
        tuple[Point, ...], _outline, 'vertices in order, either way round, none repeated [m]'
    ]

    def _form(self) -> Form:
        return _form_of_outline(self.outline)

    @classmethod
    def from_value(cls, value: object, name: str) -> Self:
        """Return the polygon of a list of points."""
        return cls(outline=point_list(value, name))

    def entry(self) -> Any:
        """Return the list of its points."""
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
        if looped:
            raise BadOutline('the outline crosses or touches itself', field='points')
        raise BadOutline('the outline encloses no area', field='points')
    pieces = convex_pieces(outline)
    # Mass and extent are those of the outline, slivers included.
    whole = Convex(as_tuples(outline))
    return form_of(pieces, (whole,))


@dataclass(frozen=True, slots=True, kw_only=True)
class Triangles(_ShapeKind):
    """
    A solid made of triangles; where they overlap, the mass of both counts.

    :raises BadOutline: the count is no multiple of three, or too high, or a triangle is degenerate
    :raises BadSize: a triangle is too large or too thin
    :raises Malformed: a coordinate is not finite
    """

    KEY: ClassVar = 'triangles'

    vertices: Annotated[
        tuple[Point, ...], _points, 'three for each triangle, either way round [m]'
    ]

    def _form(self) -> Form:
        if not self.vertices or len(self.vertices) % 3:
            raise BadOutline('triangles need three points each', field='vertices')
        triangles = np.array(self.vertices).reshape(-1, 3, 2)
        turn = cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        triangles = np.where((turn < 0)[:, None, None], triangles[:, ::-1], triangles)
        return form_of(tuple(convex_piece(triangle) for triangle in triangles))

    @classmethod
    def from_value(cls, value: object, name: str) -> Self:
        """Return the triangles of a list of points."""
        return cls(vertices=point_list(value, name))

    def entry(self) -> Any:
        """Return the list of its points."""
        return [list(vertex) for vertex in self.vertices]


@dataclass(frozen=True, slots=True, kw_only=True)
class Chain(_ShapeKind):
    """
    A chain of segments with round ends, for walls and terrain (Box2D: a chain shape).

    :raises BadOutline: fewer than two different points, or too many
    :raises BadSize: the thickness is out of range
    :raises Malformed: a number is not finite
    """

    KEY: ClassVar = 'chain'

    points: Annotated[tuple[Point, ...], _line, 'at least two, in order [m]']
    thickness: Annotated[float, checked_length, 'of the segments [m]']

    def _form(self) -> Form:
        if len(self.points) < 2:
            raise BadOutline('a chain needs two different points', field='points')
        ends = itertools.pairwise(self.points)
        return form_of(tuple(Capsule(start, end, self.thickness / 2) for start, end in ends))


# Shapes that a compound can have as its elements, by their keys.
_ELEMENTS: dict[str, type[Disc | Box]] = {each.KEY: each for each in (Disc, Box)}


@dataclass(frozen=True, slots=True, kw_only=True)
class Compound(_ShapeKind):
    """
    A compound: the same disc or box at several positions, not rotated, as one rigid body.

    :raises BadOutline: no centre, or too many
    :raises Malformed: a coordinate is not finite, or the element is something else
    """

    KEY: ClassVar = 'compound'

    element: Annotated[Disc | Box, OfClass(Disc | Box), 'the disc or box']
    centers: Annotated[tuple[Point, ...], _points, 'its positions [m]']

    def _form(self) -> Form:
        if not self.centers:
            raise BadOutline('a compound needs at least one element', field='centers')
        element, centers = self.element, self.centers
        if isinstance(element, Disc):
            return form_of(tuple(Circle(center, element.radius) for center in centers))
        return form_of(tuple(Convex(element.corners(center)) for center in centers))

    @classmethod
    def from_value(cls, value: object, name: str) -> Self:
        """Return the compound of a mapping, in which its element has the key of that."""
        known = known_mapping(value, name, [*_ELEMENTS, 'centers'])
        element = shape_in(known, 'a compound', _ELEMENTS)
        return cls(element=element, centers=point_list(known.get('centers'), 'centers'))

    def entry(self) -> Any:
        """Return the mapping of its element, by the key of that, and of its centres."""
        centers = [list(center) for center in self.centers]
        return {self.element.KEY: self.element.entry(), 'centers': centers}


Shape = Disc | Box | Polygon | Chain | Triangles | Compound
# By the key of world files.
SHAPES: dict[str, type[Shape]] = {each.KEY: each for each in get_args(Shape)}


def shape_in(mapping: Mapping[Any, Any], noun: str, kinds: Mapping[str, type[_Kind]]) -> _Kind:
    """
    Return the shape that a mapping has under the key of its kind.

    :param noun: for what has it, with its article
    :param kinds: that it may have, by their keys
    :raises Refusal: there is none, or more than one, or a value is out of range
    """
    named = [key for key in kinds if key in mapping]
    if len(named) != 1:
        raise BadProperty(
            '{thing} has one of {keys}', field='shape', thing=noun, keys=', '.join(kinds)
        )
    return kinds[named[0]].from_value(mapping[named[0]], named[0])


# Everyday words for each of these keys.
SHAPE_WORDS = dict.fromkeys(SHAPES, Words()) | {
    Disc.KEY: Words('disc', 'disk', 'sphere', 'radius', 'diameter'),
    Box.KEY: Words('rectangle', 'cube', 'size', 'width', 'height'),
}
