# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Robots: the points that their lasers hit, and their paths, true and by odometry.

The frame of an odometry is placed so that both paths begin at one pose: where the robot starts to
drive, or where the recording first sees it. From there they part by the drift.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.appearance import LaserScans
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import local_to_world, Point, Pose, rotated
from physsim_ros.view.frame_batch import Change, FrameBatch
from physsim_ros.view.scenery import ARROWS, JOINTS
from physsim_ros.view.strips import strip_column
import rerun as rr

SCANS, TRUTH, ODOMETRY = 'world/scans', 'world/ways/truth', 'world/ways/odometry'
_HIT = (180, 56, 15)
_COLORS = {TRUTH: (40, 110, 60), ODOMETRY: (150, 60, 150)}
# Time from one row to the next [s].
_PERIOD = 0.1
# Longest simulation time between two rows that a segment connects [ns]: a seek draws no line.
_LONGEST = 1_000_000_000


class ScanPoints:
    """
    Sends the scans of frames, one entity for all robots.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._scans = LaserScans()
        self._scene: Scene | None = None
        style = rr.Points3D.from_fields(
            radii=rr.Radius.ui_points(1.5), colors=[_HIT], point_shading='flat'
        )
        recording.log(SCANS, style, static=True)

    def send(self, batch: FrameBatch, change: Change) -> None:
        """Send the scans of a batch, where a laser has read since the row before."""
        names = {batch.scene.names[row] for row in batch.scene.robot_rows.tolist()}
        due = {*batch.due(_PERIOD)}
        if batch.scene is not self._scene:
            self._scene = batch.scene
            due.add(0)
        rows, points = [], []
        for row in sorted(due):
            if self._scans.read(batch.frames[row].snapshot, names):
                rows.append(row)
                points.append(self._scans.hits())
        if not rows:
            return
        lengths = [len(each) for each in points]
        places = np.full((sum(lengths), 3), ARROWS * change.unit, dtype=np.float32)
        places[:, :2] = np.concatenate(points)
        hits = rr.Points3D.columns(positions=places).partition(lengths)
        self._recording.send_columns(SCANS, batch.times_at(rows), hits)


class RobotPaths:
    """
    Sends a segment of each path for each row.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        # Of the robots in the row before, by name: frame of the odometry in the world, and places.
        self._frames: dict[str, Pose] = {}
        self._places: dict[str, tuple[Point, Point]] = {}
        self._stamp = 0
        for path, color in _COLORS.items():
            style = rr.LineStrips3D.from_fields(radii=rr.Radius.ui_points(1.0), colors=[color])
            recording.log(path, style, static=True)

    def send(self, batch: FrameBatch, change: Change) -> None:
        """Send the paths of a batch."""
        count = len(batch.scene.robots)
        if not count:
            self._frames, self._places = {}, {}
        rows = batch.due(_PERIOD)
        if not count or not rows:
            return
        # x, y of the ends of each segment; of truth and of odometry.
        segments = [self._segments(batch.frames[row].snapshot) for row in rows]
        shape = 2, len(rows) * count * 2, 3
        corners = np.full(shape, JOINTS * change.unit, dtype=np.float32)
        corners[:, :, :2] = np.array(segments).transpose(3, 0, 1, 2, 4).reshape(2, -1, 2)
        for path, each in zip((TRUTH, ODOMETRY), corners, strict=True):
            strips = strip_column(each, 2, [count] * len(rows))
            self._recording.send_columns(path, batch.times_at(rows), [strips])

    def _segments(self, now: Snapshot) -> list[tuple[tuple[Point, Point], tuple[Point, Point]]]:
        """Return, true and by odometry, the positions of each robot at the row before and now."""
        known = self._places if abs(now.stamp - self._stamp) <= _LONGEST else {}
        rows, states = now.scene.robot_rows, now.robots
        self._stamp, self._places = now.stamp, {}
        frames, self._frames = self._frames, {}
        poses, odometry = now.poses[rows].tolist(), states['odometry'].tolist()
        for row, pose, reading in zip(rows.tolist(), poses, odometry, strict=True):
            name = now.scene.names[row]
            is_known = any(reading) and name in frames
            frame = frames[name] if is_known else _odometry_frame(pose, reading)
            self._frames[name] = frame
            estimate = local_to_world((reading[0], reading[1]), frame)
            self._places[name] = (pose[0], pose[1]), estimate
        return [(known.get(name, place), place) for name, place in self._places.items()]


def _odometry_frame(pose: Pose, reading: Pose) -> Pose:
    """Return the pose of the frame in which the odometry of a robot at a pose is a reading."""
    yaw = pose[2] - reading[2]
    ahead, aside = rotated((reading[0], reading[1]), yaw)
    return pose[0] - ahead, pose[1] - aside, yaw
