# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Outlines: the edges and discs that rays meet, in the frames of their bodies.

A convex piece is its edges, a segment with round ends is two discs and a rectangle. The walls of
`bounds` are four edges that face inward; all beyond them is wall.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
import itertools
import math
from typing import NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.scene import Scene
from physsim_ros.model.shapes import Capsule, Circle, Convex, Form
from physsim_ros.model.transform import Point


class _FormOutline(NamedTuple):
    """
    The outline of a form.

    :ivar edges: x, y of the beginning [m], x, y of the outward unit normal
    :ivar sides: number of edges of each polygon
    :ivar discs: x, y, radius [m]
    """

    edges: list[tuple[float, float, float, float]]
    sides: list[int]
    discs: list[tuple[float, float, float]]


_BY_FORM: WeakKeyDictionary[Form, _FormOutline] = WeakKeyDictionary()


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class Outlines:
    """
    The outlines of some bodies of a scene.

    :param edges: (e, 4) float64: x, y of the beginning [m], x, y of the outward unit normal; those
        of a polygon one after the other, counter-clockwise
    :param following: (e,) int64: number of the edge that begins where this one ends
    :param edge_rows: (e,) int64: rows of their bodies in the scene; that after the last is walls
    :param first_edges: (p,) int64: number of the first edge of each polygon
    :param discs: (d, 3) float64: x, y, radius [m]
    :param disc_rows: (d,) int64: rows of their bodies
    :param extents: (n + 1,) float64: greatest distance of a point of a body from its centroid [m];
        infinite for walls, minus infinity for bodies without outline
    """

    edges: Floats
    following: Ints
    edge_rows: Ints
    first_edges: Ints
    discs: Floats
    disc_rows: Ints
    extents: Floats


def outlines_of(scene: Scene, rows: Iterable[int], *, walls: bool) -> Outlines:
    """
    Return the outlines of bodies.

    :param rows: of the bodies
    :param walls: whether with the walls of `bounds`
    """
    edges: list[tuple[float, float, float, float]] = []
    sides: list[int] = []
    discs: list[tuple[float, float, float]] = []
    edge_counts, disc_counts = np.zeros((2, len(scene.bodies) + 1), dtype=np.int64)
    extents = np.full(len(scene.bodies) + 1, -np.inf)
    for row in rows:
        form = scene.bodies[row].shape.form
        outline = _outline_of(form)
        edges += outline.edges
        sides += outline.sides
        discs += outline.discs
        edge_counts[row], disc_counts[row] = len(outline.edges), len(outline.discs)
        extents[row] = form.outer
    following = _following(sides)
    if walls and scene.settings.bounds is not None:
        left, bottom, right, top = scene.settings.bounds
        first = len(edges)
        edges += [
            (left, bottom, 1.0, 0.0),
            (left, top, 0.0, -1.0),
            (right, top, -1.0, 0.0),
            (right, bottom, 0.0, 1.0),
        ]
        following = np.append(following, (first + 1, first + 2, first + 3, first))
        # The region behind each wall is a piece of its own.
        sides += [1, 1, 1, 1]
        edge_counts[-1], extents[-1] = 4, np.inf
    numbers = np.arange(len(scene.bodies) + 1)
    return Outlines(
        edges=np.array(edges, dtype=np.float64).reshape(-1, 4),
        following=following,
        edge_rows=np.repeat(numbers, edge_counts),
        first_edges=np.cumsum(sides, dtype=np.int64) - np.array(sides, dtype=np.int64),
        discs=np.array(discs, dtype=np.float64).reshape(-1, 3),
        disc_rows=np.repeat(numbers, disc_counts),
        extents=extents,
    )


def _following(sides: list[int]) -> Ints:
    """Return the number of the next edge of each, in polygons with so many edges."""
    counts = np.array(sides, dtype=np.int64)
    ends = np.cumsum(counts)
    following = np.arange(1, (ends[-1] if len(ends) else 0) + 1)
    following[ends - 1] = ends - counts
    return following


def _outline_of(form: Form) -> _FormOutline:
    outline = _BY_FORM.get(form)
    if outline is None:
        outline = _FormOutline([], [], [])
        for piece in form.pieces:
            match piece:
                case Circle((x, y), radius):
                    outline.discs.append((x, y, radius))
                case Convex(vertices):
                    _add_polygon(outline, vertices)
                case Capsule(start, end, radius):
                    _add_capsule(outline, start, end, radius)
        _BY_FORM[form] = outline
    return outline


def _add_capsule(outline: _FormOutline, start: Point, end: Point, radius: float) -> None:
    scale = radius / math.dist(start, end)
    x, y = (end[1] - start[1]) * scale, (start[0] - end[0]) * scale
    corners = tuple(
        (px + sign * x, py + sign * y)
        for (px, py), sign in ((start, 1), (end, 1), (end, -1), (start, -1))
    )
    _add_polygon(outline, corners)
    # A chain has one disc where two of its segments meet.
    if outline.discs[-1:] != [(*start, radius)]:
        outline.discs.append((*start, radius))
    outline.discs.append((*end, radius))


def _add_polygon(outline: _FormOutline, vertices: tuple[Point, ...]) -> None:
    outline.sides.append(len(vertices))
    for (ax, ay), (bx, by) in itertools.pairwise((*vertices, vertices[0])):
        length = math.hypot(bx - ax, by - ay)
        outline.edges.append((ax, ay, (by - ay) / length, (ax - bx) / length))
