# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Walls of an occupancy grid: anchored boxes, as few as there can be."""

from __future__ import annotations

from physsim_ros.maps.occupancy_grid import OccupancyGrid
from physsim_ros.maps.rectangle_partition import rectangles_of
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.colors import Color
from physsim_ros.model.requests import Spawn
from physsim_ros.model.shapes import Box
from physsim_ros.model.transform import local_to_world

# Slate, on white and on black.
_COLOR: Color = (0x5A / 255, 0x64 / 255, 0x70 / 255, 1.0)


def walls_of(grid: OccupancyGrid, namespace: str, most: int) -> tuple[Spawn, ...]:
    """
    Return the requests for anchored boxes that are the occupied cells.

    :param grid: with the cells
    :param namespace: of the boxes, which are `<namespace>/0` and so on
    :param most: greatest number of boxes
    :raises WorldFull: there are more
    """
    walls = []
    rectangles = rectangles_of(grid.occupied, most) * grid.resolution
    for number, (bottom, left, top, right) in enumerate(rectangles.tolist()):
        middle = (left + right) / 2, (bottom + top) / 2
        walls.append(
            Spawn(
                name=f'{namespace}/{number}',
                shape=Box(width=right - left, height=top - bottom),
                pose=(*local_to_world(middle, grid.origin), grid.origin[2]),
                color=_COLOR,
                properties=Properties(anchored=True),
            )
        )
    return tuple(walls)
