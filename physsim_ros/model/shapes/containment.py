# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Whether points lie in a shape, or near it."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from physsim_ros.model.arrays import Flags, Floats
from physsim_ros.model.shapes.form import Capsule, Circle, Convex, Piece
from physsim_ros.model.transform import cross, dots, next_vertices, Point


def contains(pieces: Iterable[Piece], points: Floats, slack: float = 0.0) -> Flags:
    """
    Return (k,) bool: whether points lie in one of some pieces, its edge included.

    :param points: (k, 2) float64: in the frame of the pieces [m]
    :param slack: the greatest distance of a point from a piece that still contains it [m]
    """
    inside = np.zeros(len(points), dtype=np.bool_)
    for piece in pieces:
        inside |= _piece_contains(piece, points, slack)
    return inside


def _piece_contains(piece: Piece, points: Floats, slack: float) -> Flags:
    match piece:
        case Circle(center, radius):
            return _are_near(points, center, center, radius + slack)
        case Capsule(start, end, radius):
            return _are_near(points, start, end, radius + slack)
        case Convex(vertices):
            corners = np.array(vertices)
            ends = next_vertices(corners)
            inside = np.ones(len(points), dtype=np.bool_)
            for start, end in zip(corners, ends, strict=True):
                inside &= cross(end - start, points - start) >= 0.0
            if slack > 0.0:
                for start, end in zip(corners, ends, strict=True):
                    inside |= _are_near(points, start, end, slack)
            return inside


def _are_near(points: Floats, start: Point | Floats, end: Point | Floats, reach: float) -> Flags:
    """Return (k,) bool: whether points lie within a distance of a segment, or of a point [m]."""
    axis, away = np.subtract(end, start), points - start
    square = dots(axis, axis)
    if square > 0.0:
        away -= np.clip(dots(away, axis) / square, 0.0, 1.0)[:, None] * axis
    near: Flags = dots(away, away) <= reach * reach
    return near
