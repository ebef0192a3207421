# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The points that the lasers of robots hit, one entity for all robots."""

from __future__ import annotations

import numpy as np
from physsim_ros.appearance import LaserScans
from physsim_ros.model.scene import Scene
from physsim_ros.view.frame_batch import FrameBatch
import rerun as rr

PATH = 'world/scans'
_HIT = (180, 56, 15)
# Frames from one row to the next, ten a second: a row has the points of all robots.
PERIOD = 6


class ScanPoints:
    """
    Sends the scans of frames.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._scans = LaserScans()
        self._scene: Scene | None = None
        style = rr.Points3D.from_fields(
            radii=rr.Radius.ui_points(1.5), colors=[_HIT], point_shading='flat'
        )
        recording.log(PATH, style, static=True)

    def send(self, batch: FrameBatch, height: float) -> None:
        """
        Send the scans of a batch, where a laser has read since the row before.

        :param height: z of the points [m]
        """
        names = {batch.scene.names[row] for row in batch.scene.robot_rows.tolist()}
        rows, points = [], []
        for row, number in enumerate(batch.numbers):
            due = number % PERIOD == 0 or batch.scene is not self._scene
            self._scene = batch.scene
            if due and self._scans.read(batch.frames[row].snapshot, names):
                rows.append(row)
                points.append(self._scans.hits())
        if not rows:
            return
        lengths = [len(each) for each in points]
        places = np.full((sum(lengths), 3), height, dtype=np.float32)
        places[:, :2] = np.concatenate(points)
        hits = rr.Points3D.columns(positions=places).partition(lengths)
        self._recording.send_columns(PATH, batch.times_at(rows), hits)
