# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The mesh of a body: filled, with a darker outline and symbols of its properties.

A free disc has a radius as its turning mark, an anchored body an anchor, a kinematic body a wide
outline, and a sensor is translucent. A region of a medium has arrows along its flow,
and a one-way body one in the direction in which others pass it.
"""

from __future__ import annotations

from collections import Counter
from itertools import pairwise
import math

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.colors import Color, is_bright
from physsim_ros.model.scene import Body
from physsim_ros.model.shapes import (
    Capsule,
    Circle,
    contains_each,
    Convex,
    Disc,
    Form,
    Piece,
    Polygon,
    Triangles,
)
from physsim_ros.model.transform import Point
from physsim_ros.view.mesh import inset, Mesh, MeshBuilder

# Width of outlines [units], and as a share of the inner half width of a body at most.
_OUTLINE, _OUTLINE_SHARE = 0.03, 0.25
# Width of outlines of kinematic bodies [units].
_WIDE = 0.08
# Factor on the components of a colour for the outline.
_DARKER = 0.6
# Half the width of marks [units], and as a share of the radius at most.
_MARK, _MARK_SHARE = 0.03, 0.05
# Half the height of an anchor [units], and as a share of the inner half width at most.
_ANCHOR, _ANCHOR_SHARE = 0.3, 0.75
# Distance of arrows of a flow [units], and at least as a share of the extent of their region; half
# the length of an arrow, as a share of their distance.
_FLOW_GAP, _FLOW_SHARE, _FLOW_ARROW = 1.8, 1 / 12, 1 / 5
# Opacity of a sensor.
_TRANSLUCENT = 0.4
_DARK, _LIGHT = (0.08, 0.08, 0.1, 1.0), (1.0, 1.0, 1.0, 1.0)


def opacity(body: Body) -> float:
    """Return the opacity of the whole mesh of a body, 0 .. 1."""
    return body.color[3] * (_TRANSLUCENT if body.sensor else 1.0)


def body_mesh(body: Body, unit: float) -> Mesh:
    """
    Return the mesh of a body, in the body's frame.

    :param unit: length that is drawn as some 50 pixels [m]
    """
    form = body.shape.form
    red, green, blue, _ = body.color
    color, dark = (red, green, blue, 1.0), (_DARKER * red, _DARKER * green, _DARKER * blue, 1.0)
    ink = _DARK if is_bright(body.color) else _LIGHT
    if body.kinematic:
        width, edge = min(_WIDE * unit, 2 * _OUTLINE_SHARE * form.inner), ink
    else:
        width, edge = min(_OUTLINE * unit, _OUTLINE_SHARE * form.inner), dark
    builder = MeshBuilder()
    if isinstance(body.shape, Polygon | Triangles):
        for piece in form.pieces:
            _add_piece(builder, piece, 0.0, color)
        _add_edges(builder, body.shape, width, edge)
    else:
        # The area that two pieces share has no outline.
        for piece in form.pieces:
            _add_piece(builder, piece, 0.0, edge)
        for piece in form.pieces:
            _add_piece(builder, piece, width, color)
    _add_symbol(builder, body, unit, ink, edge)
    return builder.mesh()


def _add_symbol(builder: MeshBuilder, body: Body, unit: float, ink: Color, edge: Color) -> None:
    """Add the symbol of what a body is: arrows, an anchor, a turning mark."""
    form = body.shape.form
    if body.medium is not None:
        if any(body.medium.flow):
            _add_flow(builder, form, body.medium.flow, unit, edge)
    elif any(body.one_way):
        half = _FLOW_ARROW * _FLOW_GAP * unit / math.hypot(*body.one_way)
        ahead = half * np.array(body.one_way)
        _add_arrow(builder, *_arrow(ahead) + form.centroid, half=_MARK * unit, color=ink)
    elif body.anchored:
        middle = min(map(_middle, form.pieces), key=lambda at: math.dist(at, form.centroid))
        _add_anchor(builder, middle, min(_ANCHOR_SHARE * form.inner, _ANCHOR * unit), ink)
    elif isinstance(body.shape, Disc):
        radius = body.shape.radius
        half = min(_MARK * unit, _MARK_SHARE * radius)
        corners = ((0.0, -half), (0.9 * radius, -half), (0.9 * radius, half), (0.0, half))
        builder.add_convex(corners, ink)


def _add_piece(builder: MeshBuilder, piece: Piece, margin: float, color: Color) -> None:
    """Add a piece that is smaller than itself by a margin on all sides [m]."""
    match piece:
        case Circle(center, radius):
            builder.add_disc(center, radius - margin, color)
        case Capsule(start, end, radius):
            builder.add_line((start, end), radius - margin, color)
        case Convex(vertices):
            builder.add_convex(inset(vertices, margin) if margin else vertices, color)


def _add_edges(
    builder: MeshBuilder, shape: Polygon | Triangles, width: float, color: Color
) -> None:
    """Add the outline of a polygon, or the edges of a single triangle each."""
    if isinstance(shape, Polygon):
        outline = shape.outline
        (x1, y1) = outline[-1]
        doubled = 0.0
        for x2, y2 in outline:
            doubled += x1 * y2 - x2 * y1
            x1, y1 = x2, y2
        builder.add_band(outline if doubled > 0 else outline[::-1], width, color)
        return
    loops = [piece.vertices for piece in shape.form.pieces if isinstance(piece, Convex)]
    edges = [edge for loop in loops for edge in pairwise((*loop, loop[0]))]
    uses = Counter(frozenset(edge) for edge in edges)
    for start, end in edges:
        if uses[frozenset((start, end))] == 1:
            inward = np.array((start[1] - end[1], end[0] - start[0])) * width
            inward /= math.dist(start, end)
            builder.add_convex(np.array((start, end, end + inward, start + inward)), color)


def _middle(piece: Piece) -> Point:
    match piece:
        case Circle(center, _):
            return center
        case Capsule((x1, y1), (x2, y2), _):
            return (x1 + x2) / 2, (y1 + y2) / 2
        case Convex(corners):
            x, y = zip(*corners, strict=True)
            return math.fsum(x) / len(x), math.fsum(y) / len(y)


def _add_anchor(builder: MeshBuilder, at: Point, size: float, color: Color) -> None:
    """Add an anchor of half a height: ring, shank, stock, arms and flukes."""

    def line(*points: Point, half: float = 0.09) -> None:
        placed = [(at[0] + size * x, at[1] + size * y) for x, y in points]
        builder.add_line(placed, half * size, color)

    ring = [(0.22 * math.sin(a), 0.75 + 0.22 * math.cos(a)) for a in np.linspace(0, math.tau, 17)]
    arms = [(0.75 * math.sin(a), -0.15 - 0.75 * math.cos(a)) for a in np.linspace(-1.3, 1.3, 15)]
    line(*ring)
    line((0.0, 0.53), (0.0, -0.9))
    line((-0.42, 0.3), (0.42, 0.3))
    line(*arms)
    for side in (-1.0, 1.0):
        x, y = arms[-1] if side > 0 else arms[0]
        tip = (x + 0.04 * side, y + 0.28)
        line((x - 0.22 * side, y - 0.02), tip, (x + 0.12 * side, y - 0.12))


def _add_flow(builder: MeshBuilder, form: Form, flow: Point, unit: float, color: Color) -> None:
    """Add the arrows of a flow that lie within its region, on a square grid about its centroid."""
    gap = max(_FLOW_GAP * unit, _FLOW_SHARE * form.outer)
    half, count = _FLOW_ARROW * gap, math.ceil(form.outer / gap)
    ahead = half * np.array(flow) / math.hypot(*flow)
    steps = gap * np.arange(-count, count + 1)
    centers = np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2) + form.centroid
    corners = centers[:, None] + _arrow(ahead)
    inside = contains_each(form, *corners.reshape(-1, 2).T).reshape(-1, 4).all(axis=1)
    for arrow in corners[inside]:
        _add_arrow(builder, *arrow, half=_MARK * unit, color=color)


def _arrow(ahead: Floats) -> Floats:
    """
    Return tail, tip and the ends of the head of an arrow about the origin, (4, 2) float64.

    :param ahead: its tip
    """
    aside = np.array((-ahead[1], ahead[0]))
    return np.stack((-ahead, ahead, ahead / 3 + aside / 2, ahead / 3 - aside / 2))


def _add_arrow(builder: MeshBuilder, *corners: Floats, half: float, color: Color) -> None:
    tail, tip, left, right = (tuple(corner.tolist()) for corner in corners)
    builder.add_line((tail, tip), half, color)
    builder.add_line((left, tip, right), half, color)
