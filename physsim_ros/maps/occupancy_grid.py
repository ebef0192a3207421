# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""An occupancy grid: square cells that are occupied or not (`nav_msgs/OccupancyGrid`)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from physsim_ros.model.arrays import Flags
from physsim_ros.model.checks import check_pose
from physsim_ros.model.errors import BadSize, Malformed, WorldFull
from physsim_ros.model.shapes import LARGEST, SMALLEST
from physsim_ros.model.transform import Pose

# Greatest number of cells: 4,000 by 4,000, of 5 cm a hall of 200 m; some 2 s and 1 GB at most.
MOST_CELLS = 16_000_000


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class OccupancyGrid:
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
    if not np.isfinite(resolution):
        raise Malformed(f'resolution is {resolution}, not a finite number', field='resolution')
    if not SMALLEST <= resolution <= LARGEST:
        raise BadSize(
            f'resolution is {resolution:g} m; it must lie between {SMALLEST:g} and {LARGEST:g} m',
            field='resolution',
        )
    if rows * columns > MOST_CELLS:
        raise WorldFull(
            f'a map of {columns} by {rows} cells has more than {MOST_CELLS}', field='width'
        )
    if max(rows, columns) * resolution > LARGEST:
        raise BadSize(f'the map reaches further than {LARGEST:g} m', field='width')
