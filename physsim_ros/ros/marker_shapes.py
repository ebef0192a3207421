# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The marker codec of shapes: a row for each type of marker, and a case for each shape.

Law: the marker of a shape makes the same shape again.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
import math

from geometry_msgs.msg import Point as PointMessage
from physsim_ros.model.checks import check_finite
from physsim_ros.model.errors import BadSize, Refusal, UnknownShape
from physsim_ros.model.shapes import (
    Box,
    Chain,
    Compound,
    Disc,
    MOST_POINTS,
    Polygon,
    Shape,
    Triangles,
)
from physsim_ros.model.transform import Point
from visualization_msgs.msg import Marker

Size = tuple[float, float, float]
# Type, scale [m] and points [m] of a marker.
Geometry = tuple[int, Size, tuple[Point, ...]]

# Thickness of flat bodies and width of outlines [m]: visible from any side, yet thin.
THIN = 0.02
# Of a sans-serif typeface [em]: height of a capital, mean width of a character, height of a line;
# and what a box has more than its text.
_CAPITAL, _CHARACTER, _LINE, _MARGIN = 0.72, 0.55, 1.25, 1.2
# Fields of markers by the fields of shapes, for refusals.
_FIELDS = {
    'radius': 'scale.x',
    'width': 'scale.x',
    'height': 'scale.y',
    'thickness': 'scale.x',
    'outline': 'points',
    'vertices': 'points',
    'centers': 'points',
}


def shape_from(marker: Marker) -> Shape:
    """
    Return the shape of a marker.

    :raises UnknownShape: its type is that of no shape
    :raises Refusal: scale or points are those of no shape that can be simulated
    """
    if marker.type not in _DECODERS:
        raise UnknownShape(
            'a marker of type {type} does not become a body', field='type', type=marker.type
        )
    try:
        return _DECODERS[marker.type](marker)
    except Refusal as refusal:
        refusal.field = _FIELDS.get(refusal.field, refusal.field)
        raise


def geometry_of(shape: Shape) -> Geometry:
    """Return type, scale and points of the marker of a shape."""
    match shape:
        case Disc(radius=radius):
            return Marker.CYLINDER, (2 * radius, 2 * radius, THIN), ()
        case Box(width=width, height=height):
            return Marker.CUBE, (width, height, THIN), ()
        case Polygon(outline=outline):
            return Marker.LINE_STRIP, (THIN, 0.0, 0.0), (*outline, outline[0])
        case Chain(points=points, thickness=thickness):
            (x, y), last = points[0], points[-1]
            if last == (x, y):
                # The least change of the last point: a line strip with equal ends is a polygon.
                points = (*points[:-1], (math.nextafter(x, math.inf), y))
            return Marker.LINE_STRIP, (thickness, 0.0, 0.0), points
        case Triangles(vertices=vertices):
            return Marker.TRIANGLE_LIST, (1.0, 1.0, 1.0), vertices
        case Compound(element=element, centers=centers):
            kind, scale, _ = geometry_of(element)
            kind = Marker.CUBE_LIST if kind == Marker.CUBE else Marker.SPHERE_LIST
            return kind, scale, centers


def points_from(points: Sequence[PointMessage]) -> tuple[Point, ...]:
    """Return the points of a message [m], at most one more than are allowed."""
    # A closed line repeats its first point, so MOST_POINTS + 1 may be valid.
    return tuple((point.x, point.y) for point in points[: MOST_POINTS + 2])


def _box(marker: Marker) -> Box:
    return Box(width=marker.scale.x, height=marker.scale.y)


def _disc(marker: Marker) -> Disc:
    disc = Disc(radius=marker.scale.x / 2)
    check_finite((marker.scale.y,), 1, 'scale.y')
    if marker.scale.y != marker.scale.x:
        raise BadSize('a disc is round: scale.x and scale.y must be equal', field='scale.y')
    return disc


def _line(marker: Marker) -> Polygon | Chain:
    points = points_from(marker.points)
    if len(points) > 2 and points[0] == points[-1]:
        return Polygon(outline=points[:-1])
    return Chain(points=points, thickness=marker.scale.x)


def _triangles(marker: Marker) -> Triangles:
    # RViz scales the points of this type; a scale of 0 is one that was not set.
    x, y = marker.scale.x or 1.0, marker.scale.y or 1.0
    check_finite((x, y), 2, 'scale')
    if not (x > 0 and y > 0):
        raise BadSize('scale must be positive', field='scale')
    points = points_from(marker.points)
    return Triangles(vertices=tuple((px * x, py * y) for px, py in points))


def _compound(element: Callable[[Marker], Box | Disc], marker: Marker) -> Compound:
    return Compound(element=element(marker), centers=points_from(marker.points))


def _note(marker: Marker) -> Box:
    # As the message defines it, scale.z is the height of an upper-case A.
    em, lines = marker.scale.z / _CAPITAL, marker.text.split('\n')
    width = _CHARACTER * max(map(len, lines)) + _MARGIN
    try:
        return Box(width=width * em, height=(_LINE * len(lines) + _MARGIN) * em)
    except Refusal as refusal:
        refusal.field = 'scale.z'
        raise


_DECODERS: dict[int, Callable[[Marker], Shape]] = {
    Marker.CUBE: _box,
    Marker.SPHERE: _disc,
    Marker.CYLINDER: _disc,
    Marker.LINE_STRIP: _line,
    Marker.TRIANGLE_LIST: _triangles,
    Marker.CUBE_LIST: partial(_compound, _box),
    Marker.SPHERE_LIST: partial(_compound, _disc),
    Marker.TEXT_VIEW_FACING: _note,
}
