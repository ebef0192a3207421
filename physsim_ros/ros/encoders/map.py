# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""`~/map`: nav_msgs/OccupancyGrid, what is anchored, when it changes."""

from __future__ import annotations

from array import array
from collections.abc import Callable

from geometry_msgs.msg import Point, Pose
from nav_msgs.msg import MapMetaData, OccupancyGrid
import numpy as np
from physsim_ros.maps import anchored_grid
from physsim_ros.maps import OccupancyGrid as Grid
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import Refusal
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.ros.robots.frames import rotation_of
from rclpy.time import Time
from std_msgs.msg import Header

# Occupancy of a cell that is occupied [percent].
_OCCUPIED = 100


class MapEncoder:
    """
    Encodes the map of the world; nothing while it is the one before.

    :param frame_id: name of the world frame
    :param resolution: returns the side of a cell [m]
    """

    def __init__(self, frame_id: str, resolution: Callable[[], float]) -> None:
        self._frame_id = frame_id
        self._resolution = resolution
        self._scene: Scene | None = None
        # Poses of the anchored bodies, (a, 3), and the resolution, of the last map.
        self._poses: Floats = np.empty((0, 3))
        self._cell = 0.0

    def encode(self, frame: Frame) -> OccupancyGrid | None:
        """Return the message of a frame; None where the map has not changed."""
        snapshot, cell = frame.snapshot, self._resolution()
        if snapshot.scene is not self._scene:
            anchored = [body.anchored for body in snapshot.scene.bodies]
            self._rows = np.flatnonzero(anchored)
        poses = snapshot.poses[self._rows]
        same = snapshot.scene is self._scene and cell == self._cell
        if same and np.array_equal(poses, self._poses):
            return None
        self._scene, self._poses, self._cell = snapshot.scene, poses, cell
        return _message(_grid_of(snapshot, cell), self._frame_id, snapshot.stamp)


def _grid_of(snapshot: Snapshot, cell: float) -> Grid:
    """Return the map of a world; one without cells where it would have too many."""
    try:
        return anchored_grid(snapshot, cell)
    except Refusal:
        return Grid(occupied=np.zeros((0, 0), dtype=np.bool_), resolution=cell)


def _message(grid: Grid, frame_id: str, stamp: int) -> OccupancyGrid:
    time = Time(nanoseconds=stamp).to_msg()
    rows, columns = grid.occupied.shape
    x, y, yaw = grid.origin
    cells = np.where(grid.occupied, _OCCUPIED, 0).astype(np.int8)
    return OccupancyGrid(
        header=Header(frame_id=frame_id, stamp=time),
        info=MapMetaData(
            map_load_time=time,
            resolution=grid.resolution,
            width=columns,
            height=rows,
            origin=Pose(position=Point(x=x, y=y), orientation=rotation_of(yaw)),
        ),
        data=array('b', cells.tobytes()),
    )
