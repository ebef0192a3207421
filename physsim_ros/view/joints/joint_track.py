# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The joints in a recording: symbols, lines and dots of force."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats
from physsim_ros.view.frame_batch import FrameBatch, Times
from physsim_ros.view.joints.joint_geometry import JointGeometry, ROOT
from physsim_ros.view.meshes.mesh_track import MeshTrack
import rerun as rr

LINES, DOTS = f'{ROOT}/lines', f'{ROOT}/forces'


class JointTrack:
    """
    Sends the joints of frames.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._symbols = MeshTrack(recording)
        self._joints: JointGeometry | None = None
        self._filled: set[str] = set()
        # Poses of the symbols that were sent last.
        self._poses: Floats = np.empty((0, 3))
        recording.log(DOTS, rr.Points3D.from_fields(point_shading='flat'), static=True)

    def change_scene(self, joints: JointGeometry | None) -> None:
        """Send other joints from now on; None is none."""
        self._joints = joints

    def send_symbols(self, times: Times, *, everything: bool) -> None:
        """
        Send new symbols, and clear what is gone.

        :param times: of one frame
        :param everything: send the symbols that have been sent, too
        """
        joints = self._joints
        groups = [] if joints is None else joints.groups
        self._poses = np.empty((0, 3))
        self._symbols.send_meshes(groups, times, everything=everything)
        for path in self._filled:
            self._recording.send_columns(path, times, rr.Clear.columns(is_recursive=[False]))
        self._filled.clear()

    def send(self, batch: FrameBatch, moved: NDArray[np.bool_]) -> None:
        """
        Send the joints of a batch, if one of their bodies has moved.

        :param moved: (n,) bool: whether each body has
        """
        joints = self._joints
        if joints is None or not joints.has_moved(moved):
            return
        poses = joints.symbol_poses(batch.poses)
        turned = np.ones(poses.shape[1], dtype=bool)
        if self._poses.shape == poses.shape[1:]:
            turned = (poses != self._poses).any(axis=(0, 2))
        self._poses = poses[-1]
        self._symbols.send_poses(joints.groups, poses, batch.times, turned)
        snapshots = [each.snapshot for each in batch.frames]
        for path, columns in (
            (LINES, joints.line_columns(batch.poses, snapshots)),
            (DOTS, joints.dot_columns(batch.poses, snapshots)),
        ):
            if columns:
                self._filled.add(path)
                self._recording.send_columns(path, batch.times, columns)
