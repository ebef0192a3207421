# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The encoder of the map: nav_msgs/OccupancyGrid, the bodies that are anchored.

Law: a map is made when what it shows changes.
"""

from __future__ import annotations

from array import array
from collections.abc import Callable

from nav_msgs.msg import MapMetaData, OccupancyGrid
import numpy as np
from physsim_ros.maps import anchored_grid, Grid, is_on_map
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import Refusal
from physsim_ros.model.scene import Scene
from physsim_ros.model.shapes import Shape
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.ros.planar import pose_message
from rclpy.time import Time
from std_msgs.msg import Header

# Occupancy of a cell that is occupied [percent].
_OCCUPIED = 100


class MapEncoder:
    """
    Encodes the map of the world; nothing while what it shows is as before.

    :param frame_id: name of the world frame
    :param resolution: returns the side of a cell [m]
    """

    def __init__(self, frame_id: str, resolution: Callable[[], float]) -> None:
        self._frame_id = frame_id
        self._resolution = resolution
        self._scene: Scene | None = None
        # Of the bodies that the scene's map shows: their rows and shapes.
        self._rows: list[int] = []
        self._shapes: tuple[Shape, ...] = ()
        # Of the last map: side of a cell, bounds, and shapes; poses (a, 3).
        self._shown: tuple[object, ...] = ()
        self._poses: Floats = np.empty((0, 3))

    def encode(self, frame: Frame) -> OccupancyGrid | None:
        """Return the message of a frame; None where the map has not changed."""
        snapshot, cell = frame.snapshot, self._resolution()
        if snapshot.scene is not self._scene:
            self._scene, bodies = snapshot.scene, snapshot.scene.bodies
            self._rows = [row for row, body in enumerate(bodies) if is_on_map(body)]
            self._shapes = tuple(bodies[row].shape for row in self._rows)
        shown = cell, snapshot.scene.settings.bounds, self._shapes
        poses = snapshot.poses[self._rows]
        if shown == self._shown and np.array_equal(poses, self._poses):
            return None
        self._shown, self._poses = shown, poses
        return _map_message(_grid_of(snapshot, cell), self._frame_id, snapshot.stamp)


def _grid_of(snapshot: Snapshot, cell: float) -> Grid:
    """Return the map of a world; one without cells where it would have too many."""
    try:
        return anchored_grid(snapshot, cell)
    except Refusal:
        return Grid(occupied=np.zeros((0, 0), dtype=np.bool_), resolution=cell)


def _map_message(grid: Grid, frame_id: str, stamp: int) -> OccupancyGrid:
    time = Time(nanoseconds=stamp).to_msg()
    rows, columns = grid.occupied.shape
    cells = np.where(grid.occupied, _OCCUPIED, 0).astype(np.int8)
    return OccupancyGrid(
        header=Header(frame_id=frame_id, stamp=time),
        info=MapMetaData(
            map_load_time=time,
            resolution=grid.resolution,
            width=columns,
            height=rows,
            origin=pose_message(grid.origin),
        ),
        data=array('b', cells.tobytes()),
    )
