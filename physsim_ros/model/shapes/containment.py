# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Whether points lie in a piece."""

from __future__ import annotations

import numpy as np
from physsim_ros.model.arrays import Flags, Floats
from physsim_ros.model.shapes.form import Capsule, Circle, Convex, Piece
from physsim_ros.model.transform import cross, dots, next_vertices


def contains(piece: Piece, points: Floats) -> Flags:
    """
    Return (k,) bool: whether points lie in a piece, its edge included.

    :param points: (k, 2) float64: in the frame of the piece [m]
    """
    inside: Flags
    match piece:
        case Circle(center, radius):
            away = points - center
            inside = dots(away, away) <= radius * radius
        case Capsule(start, end, radius):
            axis = np.subtract(end, start)
            away = points - start
            share = np.clip(dots(away, axis) / dots(axis, axis), 0.0, 1.0)
            away -= share[:, None] * axis
            inside = dots(away, away) <= radius * radius
        case Convex(vertices):
            corners = np.array(vertices)
            edges = next_vertices(corners) - corners
            inside = np.ones(len(points), dtype=np.bool_)
            for corner, edge in zip(corners, edges, strict=True):
                inside &= cross(edge, points - corner) >= 0.0
    return inside
