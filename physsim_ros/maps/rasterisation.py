# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The map of a world: its anchored bodies as an occupancy grid.

Law: a cell is occupied where its centre lies in an anchored body that is no sensor, or beyond
`bounds`. Cells lie along the axes of the world, at multiples of their size.
"""

from __future__ import annotations

from collections.abc import Iterator
import math

import numpy as np
from physsim_ros.maps.occupancy_grid import check_cells, OccupancyGrid
from physsim_ros.model.shapes import contains, piece_box
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import rotated_each

# Number of cells that are compared with a piece at once, 100 bytes each.
_MOST_AT_ONCE = 2**20


def anchored_grid(snapshot: Snapshot, resolution: float) -> OccupancyGrid:
    """
    Return the map of a world: as far as `bounds` and a ring of cells, or as its anchored bodies.

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
        if body.anchored and not body.sensor
        for piece in body.shape.form.pieces
    ]
    bounds = snapshot.scene.settings.bounds
    boxes = np.array([box for *_, box in placed] if bounds is None else [bounds]).reshape(-1, 4)
    if not len(boxes):
        return OccupancyGrid(occupied=np.zeros((0, 0), dtype=np.bool_), resolution=resolution)
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
    return OccupancyGrid(occupied=occupied, resolution=resolution, origin=origin)


def _bands(first: int, last: int, width: int) -> Iterator[slice]:
    """Yield rows in parts of no more than _MOST_AT_ONCE cells."""
    height = max(_MOST_AT_ONCE // max(width, 1), 1)
    for row in range(first, last, height):
        yield slice(row, min(row + height, last))
