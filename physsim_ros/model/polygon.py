# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
Outlines in the plane: what they enclose, whether they cross themselves, how they come apart.

The engine's own split into convex parts recurses without end on plain outlines (a turned plus
sign, a corner with a double), and takes the interpreter with it; hence this one.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

Corners = NDArray[np.float64]

# What bends by less than this counts as straight [m]: far below anything that is simulated, far
# above the rounding of coordinates of 100 km.
STRAIGHT = 1e-6


def cross(a: Corners, b: Corners) -> NDArray[np.float64]:
    """Return the z component of the cross product of plane vectors."""
    product: NDArray[np.float64] = a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
    return product


def signed_area(outline: Corners) -> float:
    """Return the area that an outline encloses [m²], positive where it runs counter-clockwise."""
    # About a corner of its own, so that outlines far from the origin lose no digits.
    vertices = outline - outline[0]
    return float(cross(vertices, np.roll(vertices, -1, axis=0)).sum()) / 2


def swept_area(outline: Corners) -> float:
    """Return what a line from the first corner to one that goes round sweeps, to and fro [m²]."""
    vertices = outline - outline[0]
    return float(np.abs(cross(vertices, np.roll(vertices, -1, axis=0))).sum()) / 2


def is_convex(outline: Corners) -> bool:
    """Tell whether a simple outline that runs counter-clockwise bends inwards nowhere."""
    edges = np.roll(outline, -1, axis=0) - outline
    return bool((cross(np.roll(edges, 1, axis=0), edges) >= 0).all())


def crosses_itself(outline: Corners) -> bool:
    """Tell whether two sides that are not neighbours meet, or neighbours fold back."""
    start, end = outline, np.roll(outline, -1, axis=0)
    edge = end - start
    following = np.roll(edge, -1, axis=0)
    folded = (cross(edge, following) == 0) & ((edge * following).sum(axis=1) < 0)
    if folded.any():
        return True
    # Most pairs of sides are told apart by the rectangles around them.
    low, high = np.minimum(start, end), np.maximum(start, end)
    near = np.triu(np.ones((len(outline), len(outline)), dtype=np.bool_), 2)
    near[0, -1] = False
    for axis in (0, 1):
        near &= low[:, None, axis] <= high[None, :, axis]
        near &= low[None, :, axis] <= high[:, None, axis]
    first, second = np.nonzero(near)
    a, b, c, d = start[first], end[first], start[second], end[second]
    side_c, side_d = cross(b - a, c - a), cross(b - a, d - a)
    side_a, side_b = cross(d - c, a - c), cross(d - c, b - c)
    return bool(((side_c * side_d <= 0) & (side_a * side_b <= 0)).any())


def convex_parts(outline: Corners) -> list[Corners]:
    """
    Split an outline into convex parts: cut into triangles, then joined where that stays convex.

    The joining is Hertel and Mehlhorn's (1983): at most four times as many parts as need be.

    :param outline: (n, 2) float64: simple, counter-clockwise [m]
    :return: the parts, counter-clockwise
    """
    parts = _joined(outline.tolist(), _triangles(outline))
    return [outline[part] for part in parts]


def _triangles(outline: Corners) -> list[list[int]]:
    """Cut off one triangle after the other, the best shaped first."""
    count = len(outline)
    points = outline.tolist()
    x, y = outline.T
    before, after = [count - 1, *range(count - 1)], [*range(1, count), 0]
    left = np.ones(count, dtype=np.bool_)
    shapes = np.array([_shape(points, b - 1, b, (b + 1) % count) for b in range(count)])
    # Corner -> those whose triangles cannot be cut off while it is there.
    waiting: dict[int, list[int]] = {}
    triangles = []
    while count > 2:
        b = int(shapes.argmax())
        shape = float(shapes[b])
        if shape <= 0.0:
            # Rounding; what is left stays uncovered, which is for the caller to see.
            break
        a, c = before[b], after[b]
        if shape < math.inf:
            (ax, ay), (bx, by), (cx, cy) = points[a], points[b], points[c]
            # A cut that grazes a corner would let the rest touch itself.
            base = math.hypot(cx - ax, cy - ay)
            inside = (
                left
                & ((bx - ax) * (y - ay) - (by - ay) * (x - ax) >= 0)
                & ((cx - bx) * (y - by) - (cy - by) * (x - bx) >= 0)
                & ((ax - cx) * (y - cy) - (ay - cy) * (x - cx) >= -STRAIGHT * base)
            )
            inside[[a, b, c]] = False
            blocker = int(inside.argmax())
            if inside[blocker]:
                waiting.setdefault(blocker, []).append(b)
                shapes[b] = -math.inf
                continue
        if shape < math.inf:
            triangles.append([a, b, c])
        after[a], before[c] = c, a
        left[b] = False
        count -= 1
        shapes[b] = -math.inf
        for corner in (a, c, *waiting.pop(b, ())):
            if left[corner]:
                shapes[corner] = _shape(points, before[corner], corner, after[corner])
    return triangles


def _shape(points: list[list[float]], a: int, b: int, c: int) -> float:
    """
    Tell how well shaped the triangle at a corner is, twice its area by its longest side squared.

    :return: infinite where there is none, the corner being straight; -1 where it lies outside
    """
    (ax, ay), (bx, by), (cx, cy) = points[a], points[b], points[c]
    turn = (bx - ax) * (cy - by) - (by - ay) * (cx - bx)
    base = math.hypot(cx - ax, cy - ay)
    longest = max(base, math.hypot(bx - ax, by - ay), math.hypot(cx - bx, cy - by))
    if longest == base and abs(turn) <= STRAIGHT * base:
        return math.inf
    return turn / longest**2 if turn > 0 else -1.0


def _joined(points: list[list[float]], parts: list[list[int]]) -> list[list[int]]:
    """Join convex parts across the sides that they share, the longest first, while convex."""
    owner = {side: number for number, part in enumerate(parts) for side in _sides(part)}
    shared = [side for side in owner if side[0] < side[1] and side[::-1] in owner]
    shared.sort(key=lambda side: -math.dist(points[side[0]], points[side[1]]))
    for u, v in shared:
        one, other = owner[u, v], owner[v, u]
        # From the shared side's end to its start, which lies at the ends of both.
        first, second = _turned(parts[one], v), _turned(parts[other], u)
        if _bends_in(points, second[-2], v, first[1]) or _bends_in(
            points, first[-2], u, second[1]
        ):
            continue
        whole = first + second[1:-1]
        parts[one], parts[other] = whole, []
        for side in _sides(whole):
            owner[side] = one
    return [part for part in parts if part]


def _sides(part: list[int]) -> list[tuple[int, int]]:
    return list(zip(part, part[1:] + part[:1], strict=True))


def _turned(part: list[int], first: int) -> list[int]:
    """Return the same corners from another one on."""
    at = part.index(first)
    return part[at:] + part[:at]


def _bends_in(points: list[list[float]], a: int, b: int, c: int) -> bool:
    """Tell whether a way from a over b to c bends to the right."""
    (ax, ay), (bx, by), (cx, cy) = points[a], points[b], points[c]
    turn = (bx - ax) * (cy - by) - (by - ay) * (cx - bx)
    return turn < -STRAIGHT * math.hypot(cx - ax, cy - ay)
