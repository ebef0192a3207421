# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Cut shapes: the pieces of a shape that is cut from one point to another.

A solid is the outlines of its parts, each cut by itself (`cut_outline`): a disc, a rectangle or a
polygon has one, triangles and compounds have several. Parts that touch (`separating_axes`) stay
one piece, unless they touch only along the cut. Parts of a compound that touch no part which is
cut stay on the largest piece. A chain is cut across its line, and loses half its thickness on
either side, so that the round ends of the pieces do not overlap.

Law: the areas and the places of all pieces are those of the shape, those of discs to 1e-4, but for
what a chain loses.
"""

from __future__ import annotations

from collections.abc import Iterator
import itertools
import math

import numpy as np
from physsim_ros.drawing.cut_outline import across, cut_outline, ON_LINE
from physsim_ros.drawing.geometry import connected
from physsim_ros.drawing.separating_axes import touching
from physsim_ros.model.arrays import Flags, Floats
from physsim_ros.model.errors import BadSize, WorldFull
from physsim_ros.model.shapes import (
    as_tuples,
    Box,
    Chain,
    Compound,
    Disc,
    Polygon,
    Shape,
    signed_area,
    SMALLEST,
    Triangles,
)
from physsim_ros.model.transform import cross, dots, next_vertices, norms, Point

# Corners of the polygon that a disc is cut as: its rim is off by 0.3 % of the radius.
_CORNERS = 32
# Share of the area of a body below which a piece is the rounding of a touch.
_ROUNDING = 1e-9
# Greatest number of pieces of a cut, each of which is read and made in a millisecond or two.
MOST_PIECES = 200
# Greatest number of corners of the parts of a solid that is cut, which are compared in pairs: 500
# boxes, or twice the triangles that a shape can have.
MOST_CORNERS = 2000
# The greatest share of a piece in triangles that are too thin to be simulated, which are omitted.
_SLIVERS = 1e-3


def cut_shape(shape: Shape, start: Point, end: Point) -> list[Shape]:
    """
    Return the pieces of a shape, the largest first; a shape that is not cut is its only piece.

    :param start: of the cut, in the frame of the shape [m]
    :param end: of it [m]
    :raises BadSize: a piece would be too thin
    :raises BadOutline: a piece would be no outline, since it is too thin
    :raises WorldFull: it is cut into too many pieces, or has too many parts
    """
    if isinstance(shape, Chain):
        found: list[Shape] = list(_cut_chain(shape, np.array(start), np.array(end)))
    else:
        found = _cut_solid(shape, np.array(start), np.array(end))
    return sorted(found, key=lambda piece: -piece.form.area)


def check_count(count: int) -> None:
    """
    Refuse a number of pieces.

    :raises WorldFull: there are too many for one cut
    """
    if count > MOST_PIECES:
        template = 'one cut makes at most {most} pieces, not {count} or more'
        raise WorldFull(template, most=MOST_PIECES, count=count)


def _cut_solid(
    shape: Disc | Box | Polygon | Triangles | Compound, start: Floats, end: Floats
) -> list[Shape]:
    parts = _outlines(shape)
    if len(parts) > 1 and (corners := sum(map(len, parts))) > MOST_CORNERS:
        raise WorldFull(
            'the parts of the body have {corners} corners, a disc {disc}; the knife cuts at most '
            '{most}',
            corners=corners,
            disc=_CORNERS,
            most=MOST_CORNERS,
        )
    least = _ROUNDING * shape.form.area
    pieces: list[Floats] = []
    # For each piece the part that it is of.
    owners: list[int] = []
    for number, part in enumerate(parts):
        cut = [each for each in cut_outline(part, start, end) if abs(signed_area(each)) > least]
        pieces += cut if len(cut) > 1 else [part]
        owners += [number] * max(len(cut), 1)
    if len(parts) == 1:
        check_count(len(pieces))
        return [_polygon(each) for each in pieces] if len(pieces) > 1 else [shape]
    bodies = _kept_together(parts, pieces, owners, start, end)
    if len(bodies) == 1:
        return [shape]
    check_count(len(bodies))
    return [
        Compound(element=shape.element, centers=tuple(shape.centers[owners[it]] for it in body))
        if isinstance(shape, Compound) and all(owners.count(owners[it]) == 1 for it in body)
        else _triangles([pieces[it] for it in body])
        for body in bodies
    ]


def _outlines(shape: Disc | Box | Polygon | Triangles | Compound) -> list[Floats]:
    """Return the outlines of the parts of a solid, (n, 2) float64 each [m]."""
    match shape:
        case Disc(radius=radius):
            share = math.tau / _CORNERS
            angles = np.arange(_CORNERS) * share
            # Of the area of the disc.
            circumradius = radius * math.sqrt(share / math.sin(share))
            return [circumradius * np.column_stack((np.cos(angles), np.sin(angles)))]
        case Box():
            return [np.array(shape.corners())]
        case Polygon(outline=corners):
            return [np.array(corners)]
        case Triangles(vertices=vertices):
            return list(np.array(vertices).reshape(-1, 3, 2))
        case Compound(element=element, centers=centers):
            (outline,) = _outlines(element)
            return [outline + center for center in centers]


def _kept_together(
    parts: list[Floats], pieces: list[Floats], owners: list[int], start: Floats, end: Floats
) -> list[list[int]]:
    """
    Return the pieces of convex parts that stay together, by their numbers.

    :param owners: of each piece the number of its part
    """
    areas = [abs(signed_area(each)) for each in pieces]
    together = connected(_joined(pieces, start, end))
    before = connected(touching(parts))
    apart: list[list[int]] = []
    untouched: list[int] = []
    for component in before:
        inside = [body for body in together if owners[body[0]] in component]
        if len(inside) > 1:
            apart += inside
        else:
            untouched += inside[0]
    if not apart:
        return [list(range(len(pieces)))]
    max(apart, key=lambda body: sum(areas[each] for each in body)).extend(untouched)
    return apart


def _joined(pieces: list[Floats], start: Floats, end: Floats) -> Flags:
    """Return which convex pieces touch elsewhere than along a cut, (n, n) bool."""
    joined = touching(pieces)
    sides = [across(each, start, end) for each in pieces]
    left = np.array([each.min() >= 0.0 for each in sides])
    right = np.array([each.max() <= 0.0 for each in sides])
    length = math.dist(start, end)
    # The corners of each on the line of the cut, as distances from its start: first and last.
    along = [dots(each - start, (end - start) / length) for each in pieces]
    spans = [each[there == 0.0] for each, there in zip(along, sides, strict=True)]
    first, last = (
        np.array([f(each) if len(each) else np.nan for each in spans]) for f in (min, max)
    )
    begin, stop = np.maximum(first[:, None], first), np.minimum(last[:, None], last)
    beside = (begin < -ON_LINE) | (stop > length + ON_LINE)
    apart = left[:, None] & right & ~beside
    joined[apart | apart.T] = False
    return joined


def _polygon(outline: Floats) -> Polygon:
    return Polygon(outline=as_tuples(outline))


def _triangles(outlines: list[Floats]) -> Polygon | Triangles:
    """
    Return convex outlines as one shape: a polygon, or triangles.

    :raises BadSize: too much is too thin
    """
    if len(outlines) == 1:
        return _polygon(outlines[0])
    whole = sum(abs(signed_area(each)) for each in outlines)
    fans = np.array([triangle for outline in outlines for triangle in _fan(outline)])
    doubled = np.abs(cross(fans[:, 1] - fans[:, 0], fans[:, 2] - fans[:, 0]))
    longest = norms(fans - np.roll(fans, 1, axis=1)).max(axis=1)
    # The least width of a triangle is its height on its longest side.
    kept = doubled > SMALLEST * longest
    if doubled[~kept].sum() / 2 > _SLIVERS * whole or not kept.any():
        raise BadSize('a part is thinner than {least:g} m', field='points', least=SMALLEST)
    return Triangles(vertices=as_tuples(fans[kept].reshape(-1, 2)))


def _fan(outline: Floats) -> Iterator[Floats]:
    """Yield the triangles of a convex outline, (3, 2) float64 each."""
    if len(outline) <= 6:
        for a, b in itertools.pairwise(outline[1:]):
            yield np.array((outline[0], a, b))
        return
    middle = outline.mean(axis=0)
    for a, b in zip(outline, next_vertices(outline), strict=True):
        yield np.array((middle, a, b))


def _cut_chain(chain: Chain, start: Floats, end: Floats) -> Iterator[Chain]:
    """Yield the pieces of a chain, whose round ends meet at each cut."""
    points = np.array(chain.points)
    radius = chain.thickness / 2
    length = np.concatenate(((0.0,), norms(np.diff(points, axis=0)).cumsum()))
    beside = cross(np.broadcast_to(end - start, points.shape), points - start)
    bounds = [0.0]
    for number in np.flatnonzero((beside[:-1] >= 0.0) != (beside[1:] >= 0.0)).tolist():
        share = beside[number] / (beside[number] - beside[number + 1])
        side = points[number + 1] - points[number]
        at = points[number] + share * side
        # From where the cut enters the chain to where it leaves it.
        sine = abs(float(cross(side, end - start))) / math.dist(start, end) / norms(side)
        if min(dots(at - start, end - start), dots(end - at, end - start)) >= (
            radius / sine * math.dist(start, end)
        ):
            place = length[number] + share * norms(side)
            bounds += [place - radius, place + radius]
    bounds.append(float(length[-1]))
    spans = list(zip(bounds[::2], bounds[1::2], strict=True))
    if len(spans) == 1:
        yield chain
        return
    check_count(len(spans))
    if min(last - first for first, last in spans) < SMALLEST:
        raise BadSize('a part is shorter than {least:g} m', field='points', least=SMALLEST)
    lines = [_between(points, length, *span) for span in spans]
    if np.array_equal(points[0], points[-1]):
        # The pieces beside the seam of a ring are one.
        lines[0] = np.vstack((lines.pop(), lines[0]))
    for line in lines:
        yield Chain(points=as_tuples(line), thickness=chain.thickness)


def _between(points: Floats, length: Floats, first: float, last: float) -> Floats:
    """Return a polyline from one distance along it to another, (n, 2) float64 [m]."""
    inner = length[(length > first) & (length < last)]
    at = np.array((first, *inner, last))
    return np.column_stack([np.interp(at, length, axis) for axis in points.T])
