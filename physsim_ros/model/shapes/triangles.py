# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A triangle mesh."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar, Self

import numpy as np
from physsim_ros.model.checks import point_list
from physsim_ros.model.errors import BadOutline
from physsim_ros.model.shapes.convex_decomposition import convex_piece
from physsim_ros.model.shapes.form import Form, form_of
from physsim_ros.model.shapes.validation import as_tuples, checked_points
from physsim_ros.model.transform import cross, Point


@dataclass(frozen=True, slots=True, kw_only=True)
class Triangles:
    """
    A solid made of triangles; where they overlap, the mass of both counts.

    :param vertices: three for each triangle, either way round [m]
    :raises BadOutline: the count is no multiple of three, or too high, or a triangle is degenerate
    :raises BadSize: a triangle is too large or too thin
    :raises Malformed: a coordinate is not finite
    """

    KEY: ClassVar = 'triangles'

    vertices: tuple[Point, ...]
    form: Form = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        vertices = checked_points(self.vertices, 'vertices')
        if len(vertices) == 0 or len(vertices) % 3:
            raise BadOutline('triangles need three points each', field='vertices')
        object.__setattr__(self, 'vertices', as_tuples(vertices))
        triangles = vertices.reshape(-1, 3, 2)
        turn = cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        triangles = np.where((turn < 0)[:, None, None], triangles[:, ::-1], triangles)
        pieces = tuple(convex_piece(triangle) for triangle in triangles)
        object.__setattr__(self, 'form', form_of(pieces))

    @classmethod
    def from_entry(cls, entry: object) -> Self:
        """Return the triangles of a world file's entry."""
        return cls(vertices=point_list(entry, cls.KEY))

    def entry(self) -> object:
        """Return the entry of a world file."""
        return [list(vertex) for vertex in self.vertices]
