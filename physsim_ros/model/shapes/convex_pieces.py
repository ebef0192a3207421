# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Convex pieces of polygons, as far as they are thick enough to be simulated."""

from __future__ import annotations

import contextlib

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import BadOutline, BadSize
from physsim_ros.model.shapes.convex_decomposition import convex_parts
from physsim_ros.model.shapes.mass_properties import half_width
from physsim_ros.model.shapes.pieces import Convex
from physsim_ros.model.shapes.polygon_geometry import crosses_itself, is_convex, signed_area
from physsim_ros.model.shapes.validation import as_tuples, SMALLEST
from physsim_ros.model.transform import next_vertices

# Area by length [m], or by length squared, at or below which a polygon is degenerate.
DEGENERATE = 1e-9
# Greatest share of a polygon's area in parts thinner than SMALLEST, which are omitted.
SLIVERS = 1e-3


def convex_piece(vertices: Floats) -> Convex:
    """
    Return the piece of a convex polygon.

    :param vertices: (n, 2) float64: counter-clockwise [m]
    :raises BadOutline: it is degenerate
    :raises BadSize: it is thinner than SMALLEST
    """
    piece = Convex(as_tuples(vertices))
    edges = next_vertices(vertices) - vertices
    longest = float(np.hypot(edges[:, 0], edges[:, 1]).max())
    if signed_area(vertices) <= longest * DEGENERATE:
        raise BadOutline('an outline encloses no area', field='points')
    if 2 * half_width(piece) < SMALLEST:
        raise BadSize(f'a part is thinner than {SMALLEST:g} m', field='points')
    return piece


def convex_pieces(outline: Floats) -> tuple[Convex, ...]:
    """
    Return the pieces of a polygon.

    :param outline: (n, 2) float64: counter-clockwise [m]
    :raises BadOutline: it is not simple, or is degenerate
    :raises BadSize: more than SLIVERS of it is thinner than SMALLEST
    """
    if crosses_itself(outline):
        raise BadOutline('the outline crosses or touches itself', field='points')
    if is_convex(outline):
        return (convex_piece(outline),)
    # Relative to one of its vertices, so that coordinates far from the origin lose no digits.
    parts = [part + outline[0] for part in convex_parts(outline - outline[0])]
    pieces: list[Convex] = []
    covered = kept = 0.0
    for part in parts:
        area = signed_area(part)
        covered += area
        # The decomposition may contain slivers along nearly straight runs of vertices.
        with contextlib.suppress(BadOutline, BadSize):
            pieces.append(convex_piece(part))
            kept += area
    whole = signed_area(outline)
    if abs(covered - whole) > SLIVERS * whole:
        raise BadOutline('the outline cannot be split into convex parts', field='points')
    if whole - kept > SLIVERS * whole:
        raise BadSize(f'a part is thinner than {SMALLEST:g} m', field='points')
    return tuple(pieces)
