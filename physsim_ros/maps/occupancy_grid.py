# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Occupancy grids: square cells that are occupied or not (`nav_msgs/OccupancyGrid`).

The anchored bodies of a world become a grid; a grid becomes walls, a few boxes.

Law: a cell is occupied where its centre lies in an anchored body that is no sensor, or beyond
`bounds`. Cells lie along the axes of the world, at multiples of their size.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
import math

import numpy as np
from physsim_ros.maps.rectangle_partition import rectangles_of
from physsim_ros.model.arrays import Flags
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checks import check_pose
from physsim_ros.model.colors import Color
from physsim_ros.model.errors import BadSize, Malformed, WorldFull
from physsim_ros.model.requests import Spawn
from physsim_ros.model.scene import Body
from physsim_ros.model.shapes import Box, checked_length, contains, LARGEST, piece_box
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import local_to_world, Pose, rotated_each

# Slate, on white and on black.
_COLOR: Color = (0x5A / 255, 0x64 / 255, 0x70 / 255, 1.0)
# Greatest number of cells: 4,000 by 4,000, of 5 cm a hall of 200 m; some 2 s and 1 GB at most.
MOST_CELLS = 16_000_000


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Grid:
    """
    An occupancy grid.

    :param occupied: (rows, columns) bool: the first row is the lowest one
    :param resolution: side of a cell [m]
    :param origin: x, y [m], yaw [rad] of the lower left corner of the first cell, world
    :raises Malformed: a number is not finite, or `occupied` is no table
    :raises BadSize: cells or the whole are too small or too large for a shape
    :raises BadProperty: the origin is too far away
    :raises WorldFull: there are more than MOST_CELLS
    """

    occupied: Flags
    resolution: float
    origin: Pose = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        if self.occupied.ndim != 2 or self.occupied.dtype != np.bool_:
            raise Malformed('a grid has rows and columns of true and false', field='data')
        check_cells(self.resolution, *self.occupied.shape)
        check_pose(self.origin, 'origin')


def check_cells(resolution: float, rows: int, columns: int) -> None:
    """
    Refuse a grid whose cells are too many, or too small or large.

    :raises Malformed: the resolution is not finite
    :raises BadSize: cells or the whole are too small or too large for a shape
    :raises WorldFull: there are more than MOST_CELLS
    """
    checked_length(resolution, 'resolution')
    if rows * columns > MOST_CELLS:
        template, field = 'a map of {columns} by {rows} cells has more than {most}', 'width'
        raise WorldFull(template, field=field, columns=columns, rows=rows, most=MOST_CELLS)
    if max(rows, columns) * resolution > LARGEST:
        raise BadSize('the map reaches further than {most:g} m', field='width', most=LARGEST)


# Number of cells that are compared with a piece at once, 100 bytes each.
_MOST_AT_ONCE = 2**20


def is_on_map(body: Body) -> bool:
    """Return whether a map shows a body."""
    return body.anchored and not body.sensor


def anchored_grid(snapshot: Snapshot, resolution: float) -> Grid:
    """
    Return the map of a world: of `bounds` and a ring of cells around, or of anchored bodies.

    :param snapshot: of the world
    :param resolution: side of a cell [m]
    :raises Malformed: the resolution is not finite
    :raises BadSize: cells or the map are too small or too large
    :raises WorldFull: it would have more than MOST_CELLS
    """
    check_cells(resolution, 1, 1)
    placed = [
        (piece, pose, piece_box(piece, pose))
        for body, pose in zip(
            snapshot.scene.bodies, map(tuple, snapshot.poses.tolist()), strict=True
        )
        if is_on_map(body)
        for piece in body.shape.form.pieces
    ]
    bounds = snapshot.scene.settings.bounds
    boxes = np.array([box for *_, box in placed] if bounds is None else [bounds]).reshape(-1, 4)
    if not len(boxes):
        return Grid(occupied=np.zeros((0, 0), dtype=np.bool_), resolution=resolution)
    ring = 0 if bounds is None else 1
    left, bottom = (math.floor(low / resolution) - ring for low in boxes[:, :2].min(axis=0))
    right, top = (math.ceil(high / resolution) + ring for high in boxes[:, 2:].max(axis=0))
    check_cells(resolution, top - bottom, right - left)
    x, y = ((np.arange(*ends) + 0.5) * resolution for ends in ((left, right), (bottom, top)))
    if bounds is None:
        occupied = np.zeros((len(y), len(x)), dtype=np.bool_)
    else:
        occupied = ((y <= bounds[1]) | (y >= bounds[3]))[:, None] | (
            (x <= bounds[0]) | (x >= bounds[2])
        )
    for piece, pose, box in placed:
        columns = slice(*np.searchsorted(x, box[::2]).tolist())
        first, last = np.searchsorted(y, box[1::2]).tolist()
        for rows in _bands(first, last, columns.stop - columns.start):
            centers = np.stack(np.meshgrid(x[columns], y[rows]), axis=-1) - pose[:2]
            local = rotated_each(centers, -pose[2])
            occupied[rows, columns] |= contains((piece,), local[..., 0], local[..., 1])
    origin = (left * resolution, bottom * resolution, 0.0)
    return Grid(occupied=occupied, resolution=resolution, origin=origin)


def _bands(first: int, last: int, width: int) -> Iterator[slice]:
    """Yield rows in parts of no more than _MOST_AT_ONCE cells."""
    height = max(_MOST_AT_ONCE // max(width, 1), 1)
    for row in range(first, last, height):
        yield slice(row, min(row + height, last))


def walls_of(grid: Grid, namespace: str, most: int) -> tuple[Spawn, ...]:
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
