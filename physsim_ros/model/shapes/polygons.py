# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Polygons: area, self-intersection, and the convex pieces of simple ones.

A polygon is its vertices in order, (n, 2) float64 [m]; the last one is joined to the first.

Pieces by ear clipping, then removal of diagonals: ear clipping cuts off the best shaped triangle
first. Diagonals are removed where both polygons beside one are convex as a whole: S. Hertel and
K. Mehlhorn, Fast triangulation of simple polygons, 1983; at most four times the least number of
parts. Parts that are too thin to be simulated are omitted.

Pymunk 7.3.1's own `autogeometry.convex_decomposition` recurses without end on simple outlines (a
rotated plus sign, a doubled vertex) and crashes the interpreter. This part can go when that is
mended.
"""

from __future__ import annotations

import contextlib
import math

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import BadOutline, BadSize
from physsim_ros.model.shapes.form import Convex, half_width
from physsim_ros.model.shapes.validation import as_tuples, SMALLEST
from physsim_ros.model.transform import cross, next_vertices


def signed_area(polygon: Floats) -> float:
    """Return the area of a polygon [m²], positive where it runs counter-clockwise."""
    # Relative to one of its vertices, so that coordinates far from the origin lose no digits.
    vertices = polygon - polygon[0]
    return float(cross(vertices, next_vertices(vertices)).sum()) / 2


def unsigned_fan_area(polygon: Floats) -> float:
    """Return the sum of the unsigned areas of the triangles of a fan at the first vertex [m²]."""
    vertices = polygon - polygon[0]
    return float(np.abs(cross(vertices, next_vertices(vertices))).sum()) / 2


def is_convex(polygon: Floats) -> bool:
    """Tell whether a simple polygon that runs counter-clockwise has no reflex vertex."""
    edges = next_vertices(polygon) - polygon
    return bool((cross(edges, next_vertices(edges)) >= 0).all())


def crosses_itself(polygon: Floats) -> bool:
    """Tell whether a polygon is not simple: two edges meet elsewhere than in a common vertex."""
    start, end = polygon, next_vertices(polygon)
    edge = end - start
    following = next_vertices(edge)
    folded = (cross(edge, following) == 0) & ((edge * following).sum(axis=1) < 0)
    if folded.any():
        return True
    # The bounding boxes of most pairs of edges are disjoint.
    low, high = np.minimum(start, end), np.maximum(start, end)
    near = np.triu(np.ones((len(polygon), len(polygon)), dtype=np.bool_), 2)
    near[0, -1] = False
    for axis in (0, 1):
        near &= low[:, None, axis] <= high[None, :, axis]
        near &= low[None, :, axis] <= high[:, None, axis]
    first, second = np.nonzero(near)
    a, b, c, d = start[first], end[first], start[second], end[second]
    side_c, side_d = cross(b - a, c - a), cross(b - a, d - a)
    side_a, side_b = cross(d - c, a - c), cross(d - c, b - c)
    return bool(((side_c * side_d <= 0) & (side_a * side_b <= 0)).any())


# Distance from a straight line below which a vertex lies on it [m]: far below the least length of
# a shape, far above the rounding of coordinates of 100 km.
STRAIGHT = 1e-6
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
        raise BadOutline('the outline encloses no area', field='points')
    if 2 * half_width(piece) < SMALLEST:
        raise BadSize('a part is thinner than {least:g} m', field='points', least=SMALLEST)
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
        raise BadSize('a part is thinner than {least:g} m', field='points', least=SMALLEST)
    return tuple(pieces)


def convex_parts(outline: Floats) -> list[Floats]:
    """
    Split a simple polygon into convex parts.

    :param outline: (n, 2) float64: vertices, counter-clockwise [m]
    :return: (k, 2) float64 each: the parts, counter-clockwise [m]
    """
    parts = _without_diagonals(outline.tolist(), _clipped_ears(outline))
    return [outline[part] for part in parts]


def _clipped_ears(outline: Floats) -> list[list[int]]:
    """Return the triangles of a polygon as numbers of vertices, the best shaped ear first."""
    count = len(outline)
    points = outline.tolist()
    x, y = outline.T
    before, after = [count - 1, *range(count - 1)], [*range(1, count), 0]
    remaining = np.ones(count, dtype=np.bool_)
    qualities = np.array([_quality(points, b - 1, b, (b + 1) % count) for b in range(count)])
    # Vertex -> those whose triangles are no ears because they contain it.
    blocked: dict[int, list[int]] = {}
    triangles = []
    while count > 2:
        b = int(qualities.argmax())
        quality = float(qualities[b])
        if quality <= 0.0:
            # By rounding there is no ear; the caller compares areas.
            break
        a, c = before[b], after[b]
        if quality < math.inf:
            (ax, ay), (bx, by), (cx, cy) = points[a], points[b], points[c]
            # A diagonal through another vertex would let the remaining polygon touch itself.
            base = math.hypot(cx - ax, cy - ay)
            inside = (
                remaining
                & ((bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0)
                & ((cx - bx) * (y - by) - (cy - by) * (x - bx) >= 0)
                & ((ax - cx) * (y - cy) - (ay - cy) * (x - cx) >= -STRAIGHT * base)
            )
            inside[[a, b, c]] = False
            blocker = int(inside.argmax())
            if inside[blocker]:
                blocked.setdefault(blocker, []).append(b)
                qualities[b] = -math.inf
                continue
        if quality < math.inf:
            triangles.append([a, b, c])
        after[a], before[c] = c, a
        remaining[b] = False
        count -= 1
        qualities[b] = -math.inf
        for vertex in (a, c, *blocked.pop(b, ())):
            if remaining[vertex]:
                qualities[vertex] = _quality(points, before[vertex], vertex, after[vertex])
    return triangles


def _quality(points: list[list[float]], a: int, b: int, c: int) -> float:
    """
    Return the quality of the triangle at a vertex: twice its area by its longest side squared.

    :param b: number of the vertex, between a and c
    :return: infinite for a straight vertex, -1 for a reflex one
    """
    (ax, ay), (bx, by), (cx, cy) = points[a], points[b], points[c]
    turn = (bx - ax) * (cy - by) - (by - ay) * (cx - bx)
    base = math.hypot(cx - ax, cy - ay)
    longest = max(base, math.hypot(bx - ax, by - ay), math.hypot(cx - bx, cy - by))
    if longest == base and abs(turn) <= STRAIGHT * base:
        return math.inf
    return turn / longest**2 if turn > 0 else -1.0


def _without_diagonals(points: list[list[float]], parts: list[list[int]]) -> list[list[int]]:
    """Join convex parts across common edges, the longest first, where the union is convex."""
    owner = {edge: number for number, part in enumerate(parts) for edge in _edges(part)}
    shared = [edge for edge in owner if edge[0] < edge[1] and edge[::-1] in owner]
    shared.sort(key=lambda edge: -math.dist(points[edge[0]], points[edge[1]]))
    for u, v in shared:
        one, other = owner[u, v], owner[v, u]
        # From the end of the common edge to its start.
        first, second = _starting_at(parts[one], v), _starting_at(parts[other], u)
        if _is_reflex(points, second[-2], v, first[1]) or _is_reflex(
            points, first[-2], u, second[1]
        ):
            continue
        union = first + second[1:-1]
        parts[one], parts[other] = union, []
        for edge in _edges(union):
            owner[edge] = one
    return [part for part in parts if part]


def _edges(part: list[int]) -> list[tuple[int, int]]:
    return list(zip(part, part[1:] + part[:1], strict=True))


def _starting_at(part: list[int], first: int) -> list[int]:
    """Return the same vertices in the same order, from another one on."""
    at = part.index(first)
    return part[at:] + part[:at]


def _is_reflex(points: list[list[float]], a: int, b: int, c: int) -> bool:
    """Tell whether the path a, b, c turns to the right at b by more than STRAIGHT."""
    (ax, ay), (bx, by), (cx, cy) = points[a], points[b], points[c]
    turn = (bx - ax) * (cy - by) - (by - ay) * (cx - bx)
    return turn < -STRAIGHT * math.hypot(cx - ax, cy - ay)
