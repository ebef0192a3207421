# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Boundary: the walls of `bounds`, which close a world off on all four sides."""

from __future__ import annotations

from physsim_ros.engine.pymunk_bodies import set_surface
from physsim_ros.engine.warm_start import ShapeIds
from physsim_ros.model.settings import WorldSettings
import pymunk

# Thickness [m]: the engine pushes a body out through the nearer face of a wall, so that a body
# that is up to half as deep comes back in.
THICKNESS = 10.0


class Boundary:
    """
    Walls around a space.

    :param pm_space: that they are in, on its static body
    :param shapes: numbers of its shapes

    :ivar first_shape: number of the first wall; 0 if there are none
    """

    def __init__(self, pm_space: pymunk.Space, shapes: ShapeIds) -> None:
        self.first_shape = 0
        self._pm_space = pm_space
        self._shapes = shapes
        self._walls: list[pymunk.Shape] = []

    def rebuild(self, settings: WorldSettings) -> None:
        """Replace the walls by those of other settings."""
        self._shapes.remove(self._walls)
        for wall in self._walls:
            # Pymunk 7.3: Body.shapes lists shapes that are not in the space any more, too.
            wall.body = None
        self._walls = []
        self.first_shape = 0
        if settings.bounds is None:
            return
        left, bottom, right, top = settings.bounds
        for box in (
            pymunk.BB(left - THICKNESS, bottom - THICKNESS, left, top + THICKNESS),
            pymunk.BB(right, bottom - THICKNESS, right + THICKNESS, top + THICKNESS),
            pymunk.BB(left - THICKNESS, bottom - THICKNESS, right + THICKNESS, bottom),
            pymunk.BB(left - THICKNESS, top, right + THICKNESS, top + THICKNESS),
        ):
            wall = pymunk.Poly.create_box_bb(self._pm_space.static_body, box)
            set_surface(wall, settings.friction, settings.elasticity)
            self._walls.append(wall)
        self.first_shape = self._shapes.add(self._walls)
