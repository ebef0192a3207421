# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Hulls: the convex shapes of the engine as arrays, each made when it is first needed.

Those of shapes that never move are in world coordinates.
"""

from __future__ import annotations

from typing import cast, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.scene_columns import ROUND_COST
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.transform import next_vertices, rotated_each
import pymunk


class Hull(NamedTuple):
    """
    Convex hull of one to n points, rounded.

    :ivar corners: (v, 2) float64, counter-clockwise, in the body's frame or in the world [m]
    :ivar normals: (v, 2) float64: outwards, of length 1; (0, 0) of a single point
    :ivar radius: of the rounding [m]
    :ivar reach: greatest distance of a corner from the body's origin [m]
    """

    corners: Floats
    normals: Floats
    radius: float
    reach: float

    def placed_on(self, body: pymunk.Body) -> Hull:
        """Return the hull, given in the frame of a body, in the world."""
        yaw = np.array(body.angle)
        corners = rotated_each(self.corners, yaw) + np.array(body.position)
        return Hull(corners, rotated_each(self.normals, yaw), self.radius, self.reach)


class Hulls:
    """The hulls of shapes, in the frames of their bodies; shapes never change."""

    def __init__(self) -> None:
        self._by_shape: WeakKeyDictionary[pymunk.Shape, Hull] = WeakKeyDictionary()

    def of_shape(self, shape: pymunk.Shape) -> Hull:
        """Return the hull of a shape."""
        found = self._by_shape.get(shape)
        if found is None:
            found = self._by_shape[shape] = hull_of(shape)
        return found

    def of_body(self, body: pymunk.Body) -> list[Hull]:
        """Return the hulls of the shapes of a body."""
        return [self.of_shape(shape) for shape in body.shapes]


def hull_of(shape: pymunk.Shape) -> Hull:
    """Return the hull of a shape, in its body's frame."""
    if isinstance(shape, pymunk.Circle):
        points, radius = [shape.offset], shape.radius
    elif isinstance(shape, pymunk.Segment):
        points, radius = [shape.a, shape.b], shape.radius
    else:
        polygon = cast('pymunk.Poly', shape)
        points, radius = polygon.get_vertices(), polygon.radius
    corners = np.array(points, dtype=np.float64)
    edges = next_vertices(corners) - corners
    lengths = np.hypot(edges[:, 0], edges[:, 1])[:, None]
    normals = np.column_stack((edges[:, 1], -edges[:, 0])) / np.where(lengths, lengths, 1.0)
    return Hull(corners, normals, radius, float(np.hypot(*corners.T).max()))


class StaticShapes(NamedTuple):
    """
    Shapes that never move.

    :ivar hulls: in the world
    :ivar boxes: (s, 4) float64: left, bottom, right, top [m]
    :ivar places: (s,) int64: rows of their bodies in the table; -1 is the background
    :ivar corners: (s,) float64: of each, the cost of continuous collision
    """

    hulls: list[Hull]
    boxes: Floats
    places: Ints
    corners: Floats


def static_shapes(pm_space: pymunk.Space, table: BodyTable, hulls: Hulls) -> StaticShapes:
    """Return all shapes that never move, but sensors."""
    bodies = [(pm_space.static_body, -1)]
    for row, rigid in enumerate(table.bodies):
        if rigid.body.anchored and not rigid.body.sensor:
            bodies.append((rigid.pm_body, row))
    shapes = [(shape, body, place) for body, place in bodies for shape in body.shapes]
    placed = [hulls.of_shape(shape).placed_on(body) for shape, body, _ in shapes]
    return StaticShapes(
        hulls=placed,
        boxes=np.array([tuple(shape.bb) for shape, *_ in shapes], np.float64).reshape(-1, 4),
        places=np.array([place for *_, place in shapes], np.int64),
        corners=np.array([max(len(each.corners), ROUND_COST) for each in placed], np.float64),
    )
