# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Whether points lie in a shape, or near it.

The coordinates are numbers or arrays: numpy takes ten times as long as Python for a single point
and piece. Of many pieces it takes a thousandth, by columns that are made once for a form.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple, overload

import numpy as np
from physsim_ros.model.arrays import Flags, Floats, Ints
from physsim_ros.model.shapes.form import Capsule, Circle, Convex, Form, Piece
from physsim_ros.model.transform import segment_distances
from physsim_ros.model.weak_cache import cached_weakly


@overload
def contains(pieces: Iterable[Piece], x: float, y: float, slack: float = 0.0) -> bool: ...


@overload
def contains(pieces: Iterable[Piece], x: Floats, y: Floats, slack: float = 0.0) -> Flags: ...


def contains(
    pieces: Iterable[Piece], x: float | Floats, y: float | Floats, slack: float = 0.0
) -> bool | Flags:
    """
    Return whether a point lies in one of some pieces, its edge included; of arrays, each point.

    :param x: of the points, in the frame of the pieces [m]
    :param y: of the points, an array of the same shape [m]
    :param slack: the greatest distance of a point from a piece that still contains it [m]
    """
    inside: bool | Flags = False
    for piece in pieces:
        inside = inside | _piece_contains(piece, x, y, slack)
    return inside


def _piece_contains(piece: Piece, x: Any, y: Any, slack: float) -> Any:
    match piece:
        case Circle(center, radius):
            return _are_near(x, y, center, center, radius + slack)
        case Capsule(start, end, radius):
            return _are_near(x, y, start, end, radius + slack)
        case Convex(vertices):
            inside, near = True, False
            for start, end in zip(vertices, (*vertices[1:], vertices[0]), strict=True):
                inside = inside & _are_left(x, y, start, end)
                if slack > 0.0:
                    near = near | _are_near(x, y, start, end, slack)
            return inside | near


class _Columns(NamedTuple):
    """
    The pieces of a form by columns.

    :ivar capsules: (c, 5) float64: start, end, radius of capsules, and of circles [m]
    :ivar edges: (e, 4) float64: start and end of the edges of convex pieces [m]
    :ivar sides: (v,) int64: number of edges of each convex piece
    :ivar outline: (c + e, 5) float64: the capsules, and the edges with a radius of 0 [m]
    """

    capsules: Floats
    edges: Floats
    sides: Ints
    outline: Floats


def contain_each(forms: Sequence[Form], x: Floats, y: Floats, slack: float = 0.0) -> Flags:
    """
    Return whether each of some forms contains a point of its own, (n,) bool; see `contains`.

    :param x: (n,) float64: of the points, each in the frame of its form [m]
    :param y: (n,) float64: of the points [m]
    """
    inside = np.zeros(len(forms), np.bool_)
    if not forms:
        return inside
    columns = [_columns_of(form) for form in forms]
    rows = np.arange(len(forms))
    capsules = np.concatenate([each.capsules for each in columns])
    if len(capsules):
        of = np.repeat(rows, [len(each.capsules) for each in columns])
        inside[of[_in_capsules(capsules, x[of], y[of], slack)]] = True
    edges = np.concatenate([each.edges for each in columns])
    if len(edges):
        of = np.repeat(rows, [len(each.edges) for each in columns])
        sides = np.concatenate([each.sides for each in columns])
        firsts = np.cumsum(sides) - sides
        inside[of[firsts[_in_convex(edges, firsts, x[of], y[of])]]] = True
        if slack > 0.0:
            start, end = edges[:, :2].T, edges[:, 2:].T
            inside[of[_are_near(x[of], y[of], start, end, slack)]] = True
    return inside


def distances_from_outlines(forms: Sequence[Form], x: Floats, y: Floats) -> Floats:
    """
    Return the distance of a point outside each of some forms from its outline, (n,) float64 [m].

    :param x: (n,) float64: of the points, each in the frame of its form [m]
    :param y: (n,) float64: of the points [m]
    """
    outlines = [_columns_of(form).outline for form in forms]
    segments = np.concatenate(outlines)
    of = np.repeat(np.arange(len(forms)), [len(each) for each in outlines])
    points = np.column_stack((x, y))[of]
    distances = segment_distances(points, segments[:, :2], segments[:, 2:4]) - segments[:, 4]
    least = np.full(len(forms), np.inf)
    np.minimum.at(least, of, distances)
    return least


def contains_each(form: Form, x: Floats, y: Floats) -> Flags:
    """
    Return whether a form contains each of some points, (k,) bool; see `contains`.

    :param x: (k,) float64: of the points, in the frame of the form [m]
    :param y: (k,) float64: of the points [m]
    """
    columns = _columns_of(form)
    x, y = x[:, None], y[:, None]
    inside: Flags = np.logical_or.reduce(_in_capsules(columns.capsules, x, y), axis=1)
    if len(columns.edges):
        firsts = np.cumsum(columns.sides) - columns.sides
        inside[_in_convex(columns.edges, firsts, x, y).any(axis=1)] = True
    return inside


def _in_capsules(capsules: Floats, x: Floats, y: Floats, slack: float = 0.0) -> Flags:
    """Return which capsules contain points, (..., c) bool, of (..., c) or (..., 1) float64."""
    start_x, start_y, end_x, end_y, radius = capsules.T
    near: Flags = _are_near(x, y, (start_x, start_y), (end_x, end_y), radius + slack)
    return near


def _in_convex(edges: Floats, firsts: Ints, x: Floats, y: Floats) -> Flags:
    """
    Return which convex pieces contain points, (..., v) bool, of (..., e) or (..., 1) float64.

    :param firsts: (v,) int64: the first edge of each
    """
    left = _are_left(x, y, edges[:, :2].T, edges[:, 2:].T)
    inside: Flags = np.logical_and.reduceat(left, firsts, axis=-1)
    return inside


@cached_weakly
def _columns_of(form: Form) -> _Columns:
    capsules: list[tuple[float, ...]] = []
    edges: list[tuple[float, ...]] = []
    sides: list[int] = []
    for piece in form.pieces:
        match piece:
            case Circle(center, radius):
                capsules.append((*center, *center, radius))
            case Capsule(start, end, radius):
                capsules.append((*start, *end, radius))
            case Convex(vertices):
                following = (*vertices[1:], vertices[0])
                edges += [(*pair[0], *pair[1]) for pair in zip(vertices, following, strict=True)]
                sides.append(len(vertices))
    return _Columns(
        capsules=np.array(capsules).reshape(-1, 5),
        edges=np.array(edges).reshape(-1, 4),
        sides=np.array(sides, np.int64),
        outline=np.array([*capsules, *((*edge, 0.0) for edge in edges)]).reshape(-1, 5),
    )


def _are_left(x: Any, y: Any, start: Any, end: Any) -> Any:
    """Return whether points lie to the left of directed lines, or on them."""
    axis_x, axis_y = end[0] - start[0], end[1] - start[1]
    return axis_x * (y - start[1]) - axis_y * (x - start[0]) >= 0.0


def _are_near(x: Any, y: Any, start: Any, end: Any, reach: Any) -> Any:
    """Return whether points lie within a distance of segments, or of points [m]."""
    axis_x, axis_y = end[0] - start[0], end[1] - start[1]
    away_x, away_y = x - start[0], y - start[1]
    past_x, past_y = x - end[0], y - end[1]
    square = axis_x * axis_x + axis_y * axis_y
    along = axis_x * away_x + axis_y * away_y
    across = axis_x * away_y - axis_y * away_x
    beside = (square > 0.0) & (along >= 0.0) & (along <= square)
    return (
        (away_x * away_x + away_y * away_y <= reach * reach)
        | (past_x * past_x + past_y * past_y <= reach * reach)
        | (beside & (across * across <= reach * reach * square))
    )
