# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Shapes that never move, as continuous collision sees them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.ccd.hulls import Hull, Hulls
from physsim_ros.engine.ccd.time_of_impact import ROUND_COST
from physsim_ros.model.arrays import Floats, Ints
import pymunk


class StaticShapes(NamedTuple):
    """
    Shapes that never move.

    :ivar hulls: in the world
    :ivar boxes: (s, 4) float64: left, bottom, right, top [m]
    :ivar places: (s,) int64: of their bodies in the listing; -1 is the background
    :ivar corners: (s,) float64: of each, the cost of continuous collision
    """

    hulls: list[Hull]
    boxes: Floats
    places: Ints
    corners: Floats


def static_shapes(space: pymunk.Space, table: BodyTable, hulls: Hulls) -> StaticShapes:
    """Return all shapes that never move, but sensors."""
    bodies = [(space.static_body, -1)]
    for row, rigid in enumerate(table.bodies):
        if rigid.body.anchored and not rigid.body.sensor:
            bodies.append((rigid.engine, row))
    shapes = [(shape, body, place) for body, place in bodies for shape in body.shapes]
    placed = [hulls.of_shape(shape).placed_on(body) for shape, body, _ in shapes]
    return StaticShapes(
        hulls=placed,
        boxes=np.array([tuple(shape.bb) for shape, *_ in shapes], np.float64).reshape(-1, 4),
        places=np.array([place for *_, place in shapes], np.int64),
        corners=np.array([max(len(each.corners), ROUND_COST) for each in placed], np.float64),
    )
