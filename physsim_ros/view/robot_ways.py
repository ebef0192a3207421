# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The ways of robots: where each is, and where its odometry reckons it to be.

An odometry begins in a frame of its own. That is placed where the robot is while it has not
driven yet, or else where the recording first sees it, so that both ways part there by its drift.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import local_to_world, Point, Pose, rotated
from physsim_ros.view.frame_batch import FrameBatch
from physsim_ros.view.line_strips import strip_column
import rerun as rr

TRUTH, ODOMETRY = 'world/ways/truth', 'world/ways/odometry'
_COLORS = {TRUTH: (40, 110, 60), ODOMETRY: (150, 60, 150)}
# Frames from one row to the next, ten a second.
PERIOD = 6
# Longest simulation time from one row to the next along which a robot has driven [ns]: a seek is
# no way.
_LONGEST = 1_000_000_000


class RobotWays:
    """
    Sends a segment of each way for each row.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        # Frame of each odometry in the world, and places at the row before, by name of the robot.
        self._frames: dict[str, Pose] = {}
        self._places: dict[str, tuple[Point, Point]] = {}
        self._stamp = 0
        for path, color in _COLORS.items():
            style = rr.LineStrips3D.from_fields(radii=rr.Radius.ui_points(1.0), colors=[color])
            recording.log(path, style, static=True)

    def send(self, batch: FrameBatch, height: float) -> None:
        """
        Send the ways of a batch.

        :param height: z of the lines [m]
        """
        count = len(batch.scene.robots)
        rows = [row for row, number in enumerate(batch.numbers) if number % PERIOD == 0]
        if not count or not rows:
            return
        # x, y of the ends of each segment; of truth and of odometry.
        segments = [self._segments(batch.frames[row].snapshot) for row in rows]
        corners = np.full((2, len(rows) * count * 2, 3), height, dtype=np.float32)
        corners[:, :, :2] = np.array(segments).transpose(3, 0, 1, 2, 4).reshape(2, -1, 2)
        for path, each in zip((TRUTH, ODOMETRY), corners, strict=True):
            strips = strip_column(each, 2, [count] * len(rows))
            self._recording.send_columns(path, batch.times_at(rows), [strips])

    def _segments(self, now: Snapshot) -> list[tuple[tuple[Point, Point], tuple[Point, Point]]]:
        """Return the places of each robot at the row before, and now."""
        known = self._places if abs(now.stamp - self._stamp) <= _LONGEST else {}
        rows, states = now.scene.robot_rows, now.robots
        self._stamp, self._places = now.stamp, {}
        poses, odometry = now.poses[rows].tolist(), states.odometry.tolist()
        for row, pose, told in zip(rows.tolist(), poses, odometry, strict=True):
            name = now.scene.names[row]
            if not any(told) or name not in self._frames:
                self._frames[name] = _frame_of(pose, told)
            reckoned = local_to_world((told[0], told[1]), self._frames[name])
            self._places[name] = (pose[0], pose[1]), reckoned
        return [(known.get(name, place), place) for name, place in self._places.items()]


def _frame_of(pose: Pose, told: Pose) -> Pose:
    """Return the frame in which an odometry tells a pose, in the world."""
    yaw = pose[2] - told[2]
    ahead, aside = rotated((told[0], told[1]), yaw)
    return pose[0] - ahead, pose[1] - aside, yaw
