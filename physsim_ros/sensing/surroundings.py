# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Surroundings: all edges and discs of a frame that rays can meet.

A convex piece is its edges, a segment with round ends is two discs and a rectangle. The walls of
`bounds` are four edges that face inward; all beyond them is wall. Laws: a robot alone and among
others reads the same bits; what is met is what the engine collides, but for sensors, to its
precision. The core casts the rays (`engine/core/rays.c`).
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
import itertools
import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.core import dtype_of, lib, pointer
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Scene
from physsim_ros.model.shapes import Capsule, Circle, Convex, Form
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import Point
from physsim_ros.model.weak_cache import cached_weakly

_PIECE, _EDGE = dtype_of('Piece'), dtype_of('Edge')
_EVERYWHERE = ((0.0, 0.0), math.inf)


class _Outline(NamedTuple):
    """
    What rays meet of some bodies, each in the frame of its body.

    :ivar pieces: (p,) `Piece` of `engine/core/core.h`
    :ivar edges: (e,) `Edge` of the same
    """

    pieces: NDArray[np.void]
    edges: NDArray[np.void]


_NOTHING = _Outline(np.empty(0, _PIECE), np.empty(0, _EDGE))


class Surroundings:
    """
    Edges and discs of all bodies but sensors, and the walls of `bounds`.

    :param snapshot: of the world
    """

    def __init__(self, snapshot: Snapshot) -> None:
        self.snapshot = snapshot

    def nearest(self, origin: Point, directions: Floats, reach: float, row: int) -> Floats:
        """
        Return (k,) float64: distance along each ray [m]; infinite for nothing within reach.

        All are 0 where the origin lies in a body or a wall. Beyond reach a distance may be
        infinite or true.

        :param origin: of all rays [m]
        :param directions: (k, 2) float64: their unit vectors, counter-clockwise within a turn
        :param reach: greatest distance [m]
        :param row: of the robot whose pieces, those of its parts too, are not met; -1 is none
        """
        distances = np.empty(len(directions))
        lib.core_cast_rays(
            *self._pointers,
            row,
            origin,
            reach,
            pointer(directions, 'cpVect'),
            len(directions),
            pointer(distances, 'double'),
        )
        return distances

    @cached_property
    def _pointers(self) -> tuple[object, ...]:
        """Pieces, their count, edges and poses; the last pose is that of the walls."""
        outline = _outline_of_scene(self.snapshot.scene)
        pieces, edges = pointer(outline.pieces, 'Piece'), pointer(outline.edges, 'Edge')
        poses = np.concatenate((self.snapshot.poses, np.zeros((1, 3))))
        return pieces, len(outline.pieces), edges, pointer(poses, 'Pose')


@cached_weakly
def _outline_of_scene(scene: Scene) -> _Outline:
    parts = [
        (row, _outline_of_form(body.shape.form))
        for row, body in enumerate(scene.bodies)
        if not body.sensor
    ]
    if scene.settings.bounds is not None:
        parts.append((len(scene.bodies), _outline_of_walls(*scene.settings.bounds)))
    counts = [len(part.pieces) for _, part in parts]
    # Without their type, NumPy makes one without the padding of the struct.
    pieces = np.concatenate((_NOTHING.pieces, *(part.pieces for _, part in parts)), dtype=_PIECE)
    edges = np.concatenate((_NOTHING.edges, *(part.edges for _, part in parts)), dtype=_EDGE)
    pieces['body'] = np.repeat([row for row, _ in parts], counts)
    owners = [*scene.owners.tolist(), len(scene.bodies)]
    pieces['owner'] = np.repeat([owners[row] for row, _ in parts], counts)
    pieces['first_edge'] = np.cumsum(pieces['edge_count']) - pieces['edge_count']
    return _Outline(pieces, edges)


def _outline_of_walls(left: float, bottom: float, right: float, top: float) -> _Outline:
    """Return four walls: counter-clockwise around what is not the world, so that they face in."""
    corners = (left, bottom), (left, top), (right, top), (right, bottom)
    sides = itertools.pairwise((*corners, corners[0]))
    # The region behind each wall is a piece of its own.
    return _outline((side, _EVERYWHERE) for side in sides)


@cached_weakly
def _outline_of_form(form: Form) -> _Outline:
    return _outline(_simple_pieces(form))


_Disc = tuple[Point, float]


def _simple_pieces(form: Form) -> Iterator[tuple[tuple[Point, ...], _Disc]]:
    """Yield polygons, each with a disc around it, and discs alone."""
    last: _Disc | None = None
    for piece in form.pieces:
        match piece:
            case Circle(center, radius):
                yield (), (center, radius)
            case Convex(vertices):
                yield _closed(vertices)
            case Capsule(start, end, radius):
                yield _closed(_sides(start, end, radius))
                # A chain has one disc where two of its segments meet.
                if last != (start, radius):
                    yield (), (start, radius)
                last = end, radius
                yield (), last


def _sides(start: Point, end: Point, radius: float) -> tuple[Point, ...]:
    """Return the corners of the rectangle of a capsule."""
    scale = radius / math.dist(start, end)
    x, y = (end[1] - start[1]) * scale, (start[0] - end[0]) * scale
    return tuple(
        (px + sign * x, py + sign * y)
        for (px, py), sign in ((start, 1), (end, 1), (end, -1), (start, -1))
    )


def _closed(vertices: tuple[Point, ...]) -> tuple[tuple[Point, ...], _Disc]:
    """Return a polygon whose last corner is its first one, and a disc around it."""
    x, y = (math.fsum(each) / len(vertices) for each in zip(*vertices, strict=True))
    radius = max(math.dist((x, y), vertex) for vertex in vertices)
    # A little more, so that rounding leaves no corner out.
    return (*vertices, vertices[0]), ((x, y), radius * (1.0 + 1e-9))


def _outline(pieces: Iterator[tuple[tuple[Point, ...], _Disc]]) -> _Outline:
    listed = [*pieces]
    edges = [side for corners, _ in listed for side in itertools.pairwise(corners)]
    return _Outline(
        np.array(
            [(0, 0, 0, max(len(corners) - 1, 0), *disc) for corners, disc in listed], dtype=_PIECE
        ),
        np.array([(begin, end, _normal(begin, end)) for begin, end in edges], dtype=_EDGE),
    )


def _normal(begin: Point, end: Point) -> Point:
    length = math.dist(begin, end)
    return (end[1] - begin[1]) / length, (begin[0] - end[0]) / length
