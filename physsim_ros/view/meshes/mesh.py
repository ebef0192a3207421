# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Flat meshes: filled polygons, discs and thick lines, in layers of one colour each.

Law: all vertices of a mesh lie at z = 0 and have no normals, so Rerun draws it unlit, in the
colours as given; of two triangles that overlap, the later one is seen (Rerun 0.41 compares depths
by `GreaterEqual`).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
import math

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats, Singles
from physsim_ros.model.colors import Color
from physsim_ros.model.transform import Point

# Sides of a disc: the chord of a 64-gon lies 0.12 % of the radius inside the circle.
SIDES = 64
# Sides of the round end of a line.
_END_SIDES = 12
# Greatest length of a mitre, in widths of the band: sharper corners are cut off.
_MITRE = 4.0

# Strips in the frame of a body, each through its corners [m].
Strips = tuple[tuple[Point, ...], ...]


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """
    A flat mesh.

    :param vertices: (v, 2) float32 [m]
    :param triangles: (t, 3) uint32: indices of vertices
    :param colors: (v, 4) uint8: red, green, blue, alpha
    """

    vertices: Singles
    triangles: NDArray[np.uint32]
    colors: NDArray[np.uint8]

    @property
    def extent(self) -> tuple[Point, Point]:
        """Return lower left and upper right of its bounding box [m]."""
        (left, bottom), (right, top) = (
            self.vertices.min(axis=0).tolist(),
            self.vertices.max(axis=0).tolist(),
        )
        return (left, bottom), (right, top)


class MeshBuilder:
    """Collects the triangles of a mesh, the lowest layer first."""

    def __init__(self) -> None:
        self._vertices: list[Floats] = []
        self._triangles: list[NDArray[np.int64]] = []
        self._colors: list[Floats] = []
        self._count = 0

    def mesh(self) -> Mesh:
        """Return the mesh of what has been added, at least one triangle."""
        return Mesh(
            vertices=np.concatenate(self._vertices).astype(np.float32),
            triangles=np.concatenate(self._triangles).astype(np.uint32),
            colors=np.rint(np.concatenate(self._colors) * 255).astype(np.uint8),
        )

    def add_convex(self, vertices: Sequence[Point] | Floats, color: Color) -> None:
        """Add a convex polygon of at least three vertices, in order [m]."""
        second = np.arange(1, len(vertices) - 1)
        self._add(vertices, np.column_stack((np.zeros_like(second), second, second + 1)), color)

    def add_disc(self, center: Point, radius: float, color: Color, *, sides: int = SIDES) -> None:
        """Add a regular polygon for a circle [m]."""
        self.add_convex(circle(center, radius, sides), color)

    def add_line(self, points: Sequence[Point], half_width: float, color: Color) -> None:
        """Add a polyline of at least two points with round joints and ends [m]."""
        for start, end in pairwise(points):
            length = math.dist(start, end)
            if length > 0.0:
                across = half_width / length
                side = np.array((start[1] - end[1], end[0] - start[0])) * across
                corners = np.array((start, end, end, start))
                corners[:2] -= side
                corners[2:] += side
                self.add_convex(corners, color)
        for point in dict.fromkeys(points):
            self.add_disc(point, half_width, color, sides=_END_SIDES)

    def add_band(self, outline: Sequence[Point], width: float, color: Color) -> None:
        """
        Add a band along the inner side of an outline.

        :param outline: of a polygon, counter-clockwise, at least three vertices [m]
        :param width: of the band [m]
        """
        outer, inner = np.array(outline), inset(outline, width)
        count = len(outer)
        near, far = np.arange(count), np.roll(np.arange(count), -1)
        triangles = np.concatenate(
            (
                np.column_stack((near, far, far + count)),
                np.column_stack((near, far + count, near + count)),
            )
        )
        self._add(np.concatenate((outer, inner)), triangles, color)

    def _add(
        self, vertices: Sequence[Point] | Floats, triangles: NDArray[np.int64], color: Color
    ) -> None:
        self._vertices.append(np.asarray(vertices, dtype=np.float64))
        self._triangles.append(triangles + self._count)
        self._colors.append(np.tile(color, (len(vertices), 1)))
        self._count += len(vertices)


def circle(center: Point, radius: float, sides: int = SIDES) -> Floats:
    """Return the vertices of a regular polygon, (sides, 2) float64 [m], counter-clockwise."""
    angles = np.linspace(0.0, math.tau, sides, endpoint=False)
    return center + radius * np.column_stack((np.cos(angles), np.sin(angles)))


def inset(outline: Sequence[Point], width: float) -> Floats:
    """
    Return the vertices of a polygon moved inward, so that its edges move by a width.

    :param outline: counter-clockwise, at least three vertices [m]
    :param width: [m]
    :return: (n, 2) float64 [m], vertex by vertex
    """
    vertices = np.array(outline, dtype=np.float64)
    edges = np.roll(vertices, -1, axis=0) - vertices
    lengths = np.hypot(edges[:, 0], edges[:, 1])[:, None]
    after = np.column_stack((-edges[:, 1], edges[:, 0])) / np.maximum(lengths, 1e-12)
    before = np.roll(after, 1, axis=0)
    mitre = before + after
    # Of unit normals m, n the mitre is (m + n) / (1 + m · n).
    scale = 1.0 + (before * after).sum(axis=1, keepdims=True)
    mitre /= np.maximum(scale, 2.0 / _MITRE**2)
    moved: Floats = vertices + width * mitre
    return moved
