# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Whether points lie in a shape, or near it.

The coordinates are numbers or arrays: numpy takes ten times as long as Python for a single point.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import overload

from physsim_ros.model.arrays import Flags, Floats
from physsim_ros.model.shapes.form import Capsule, Circle, Convex, Piece
from physsim_ros.model.transform import Point


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


def _piece_contains(
    piece: Piece, x: float | Floats, y: float | Floats, slack: float
) -> bool | Flags:
    match piece:
        case Circle(center, radius):
            return _are_near(x, y, center, center, radius + slack)
        case Capsule(start, end, radius):
            return _are_near(x, y, start, end, radius + slack)
        case Convex(vertices):
            inside: bool | Flags = True
            near: bool | Flags = False
            for start, end in zip(vertices, (*vertices[1:], vertices[0]), strict=True):
                axis_x, axis_y = end[0] - start[0], end[1] - start[1]
                left = axis_x * (y - start[1]) - axis_y * (x - start[0]) >= 0.0
                inside = inside & left
                if slack > 0.0:
                    near = near | _are_near(x, y, start, end, slack)
            return inside | near


def _are_near(
    x: float | Floats, y: float | Floats, start: Point, end: Point, reach: float
) -> bool | Flags:
    """Return whether points lie within a distance of a segment, or of a point [m]."""
    axis_x, axis_y = end[0] - start[0], end[1] - start[1]
    away_x, away_y = x - start[0], y - start[1]
    near = away_x * away_x + away_y * away_y <= reach * reach
    square = axis_x * axis_x + axis_y * axis_y
    if square > 0.0:
        past_x, past_y = x - end[0], y - end[1]
        along = axis_x * away_x + axis_y * away_y
        across = axis_x * away_y - axis_y * away_x
        beside = (along >= 0.0) & (along <= square) & (across * across <= reach * reach * square)
        near = near | beside | (past_x * past_x + past_y * past_y <= reach * reach)
    return near
