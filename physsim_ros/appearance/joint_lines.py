# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The line strips of all joints of a scene, as arrays.

Law: the corners of the strips are computed once for a scene, relative to the two points of each
joint; array operations place them by the poses of a frame.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from physsim_ros.appearance.joint_glyphs import Strip
from physsim_ros.model.arrays import Floats
from physsim_ros.model.joints import JointKind
from physsim_ros.model.scene import Scene
from physsim_ros.model.transform import rotated_each


class JointLines:
    """
    Line strips of the joints of a scene.

    :param scene: with the joints
    :param glyphs: the strips of each joint

    :ivar seats: (j, 2, 2) float64: points of the joints in the frames of a and b [m]
    :ivar owner: (s,) intp: index of the joint of each strip
    :ivar lengths: (s,) intp: number of corners of each strip
    """

    def __init__(self, scene: Scene, glyphs: Sequence[Sequence[Strip]]) -> None:
        self._scene = scene
        owned = [(number, strip) for number, strips in enumerate(glyphs) for strip in strips]
        corners = [corner for _, strip in owned for corner in strip]
        owner, lengths = [number for number, _ in owned], [len(strip) for _, strip in owned]
        self.owner, self.lengths = np.array(owner, np.intp), np.array(lengths, np.intp)
        self._joints = np.repeat(self.owner, self.lengths)
        self._along = np.array([each.along for each in corners], np.float64)[:, None]
        self._across = np.array([each.across for each in corners], np.float64)[:, None]
        self._sag = np.array([each.sag for each in corners], np.float64)[:, None]
        self._arms = np.array([each.arm for each in corners], np.float64).reshape(-1, 2)
        on_b = np.array([each.on_b for each in corners], np.intp)
        self._rows = scene.joint_rows[self._joints, on_b]
        self.seats = _drawn_seats(scene)
        self._rope_lengths = np.array(
            [joint.rest_length if joint.kind is JointKind.ROPE else 0.0 for joint in scene.joints]
        )
        gravity = np.array(scene.settings.gravity)
        strength = float(np.hypot(*gravity))
        self._down = gravity / strength if strength > 0 else np.array((0.0, -1.0))

    def points(self, poses: Floats) -> Floats:
        """
        Return the two points of each joint.

        :param poses: (..., n, 3) float64: of the bodies, x, y [m], yaw [rad]
        :return: (..., j, 2, 2) float64 [m]
        """
        background = np.zeros((*poses.shape[:-2], 1, 3))
        frames = np.concatenate((poses, background), axis=-2)[..., self._scene.joint_rows, :]
        return frames[..., :2] + rotated_each(self.seats, frames[..., 2])

    def corners(self, poses: Floats) -> Floats:
        """
        Return all corners of all strips, one strip after the other.

        :param poses: (..., n, 3) float64: of the bodies, x, y [m], yaw [rad]
        :return: (..., c, 2) float64 [m]
        """
        points = self.points(poses)
        first, span = points[..., 0, :], points[..., 1, :] - points[..., 0, :]
        length = np.hypot(span[..., 0], span[..., 1])
        side = np.stack((-span[..., 1], span[..., 0]), axis=-1)
        side /= np.maximum(length, 1e-9)[..., None]
        # Depth of a shallow arc: https://en.wikipedia.org/wiki/Parabola#Arc_length.
        slack = np.maximum(0.0, self._rope_lengths - length)
        depth = np.sqrt(3 / 8 * slack * self._rope_lengths)[..., None] * self._down
        joints = self._joints
        background = np.zeros((*poses.shape[:-2], 1))
        yaw = np.concatenate((poses[..., 2], background), axis=-1)[..., self._rows]
        corners: Floats = first[..., joints, :] + self._along * span[..., joints, :]
        corners += self._across * side[..., joints, :] + self._sag * depth[..., joints, :]
        return corners + rotated_each(self._arms, yaw)


def _drawn_seats(scene: Scene) -> Floats:
    """Return the points of joints in body frames, (j, 2, 2) float64 [m]; a gear has centroids."""
    seats = scene.seats[:, :4].reshape(-1, 2, 2).copy()
    for number, joint in enumerate(scene.joints):
        if joint.kind is JointKind.GEAR:
            for side, row in enumerate(scene.joint_rows[number].tolist()):
                if row >= 0:
                    seats[number, side] = scene.centroids[row]
    return seats


def segment_corners(lengths: Sequence[int]) -> NDArray[np.intp]:
    """
    Return the indices of the two corners of each segment, (2 s,) intp.

    :param lengths: number of corners of each strip
    """
    ends = np.cumsum(lengths)
    first = np.delete(np.arange(ends[-1]), ends - 1)
    return np.column_stack((first, first + 1)).ravel()
