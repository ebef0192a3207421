# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The joints of a scene in Rerun: symbols that keep their form, lines that do not, and dots of force.

Laws: a scene without joints sends nothing, and joints whose bodies did not move are not sent
again. A joint that has no line shows its force by a dot.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.view import columns
from physsim_ros.view.joints.joint_colors import JointColors
from physsim_ros.view.joints.joint_glyphs import is_rigid
from physsim_ros.view.joints.joint_lines import JointLines
from physsim_ros.view.joints.joint_symbols import symbol_sizes, symbols_of
from physsim_ros.view.meshes.body_mesh import JOINT_INK, JOINT_LINE
from physsim_ros.view.meshes.mesh import MeshBuilder, Strips
from physsim_ros.view.meshes.mesh_group import MeshGroup
import rerun as rr

ROOT = 'world/joints'
# Half the size of the smallest visible symbol [units].
_LEAST = 0.1
# Radius of a dot, in half sizes of the symbol.
_DOT = 0.6


class JointGeometry:
    """
    The joints of one scene, as columns of components.

    :param scene: with the joints
    :param unit: length of a unit of the view [m]
    :param height: z of the joints, above all bodies [m]

    :ivar body_symbols: symbols of bodies by their rows
    :ivar groups: of the other symbols
    """

    def __init__(self, scene: Scene, unit: float, height: float) -> None:
        self._scene = scene
        least = _LEAST * unit
        self._lines = JointLines(scene, least=least, chosen=lambda strip: not is_rigid(strip))
        self._colors = JointColors(scene)
        self._height, self._radius = height, JOINT_LINE * unit
        self._bodies = np.unique(scene.joint_rows[scene.joint_rows >= 0])
        sizes = symbol_sizes(scene, least)
        self._dotted = np.setdiff1d(np.arange(len(scene.joints)), self._lines.owner)
        self._dots = np.array([_DOT * sizes[row] for row in self._dotted], dtype=np.float32)
        self.body_symbols, symbols = symbols_of(scene, sizes)
        joints = np.array([each.joint for each in symbols], np.intp)
        sides = np.array([each.side for each in symbols], np.intp)
        self._places = joints, np.array([each.point for each in symbols], np.intp)
        self._sides = scene.joint_rows[joints, sides]
        self.groups = [
            self._group(row, scene.joints[each.joint].name, each.strips)
            for row, each in enumerate(symbols)
        ]

    def _group(self, row: int, joint: str, strips: Strips) -> MeshGroup:
        builder = MeshBuilder()
        for strip in strips:
            builder.add_line(strip, self._radius, JOINT_INK)
        return MeshGroup(
            path=(*ROOT.split('/'), *joint.rsplit('/', 1), str(row)),
            names=(joint,),
            mesh=builder.mesh(),
            rows=np.array([row], np.intp),
            depths=np.full(1, self._height, np.float32),
        )

    def has_moved(self, moved: NDArray[np.bool_]) -> bool:
        """
        Return whether a body of a joint has moved.

        :param moved: (n,) bool: whether each body has
        """
        return bool(moved[self._bodies].any())

    def symbol_poses(self, poses: Floats) -> Floats:
        """
        Return the poses of the symbols in frames, (f, s, 3) float64.

        :param poses: (f, n, 3) float64: of the bodies, x, y [m], yaw [rad]
        """
        result = np.empty((len(poses), len(self._sides), 3))
        points = self._lines.points(poses)
        result[..., :2] = points[:, *self._places]
        background = np.zeros((len(poses), 1))
        result[..., 2] = np.concatenate((poses[..., 2], background), axis=1)[:, self._sides]
        return result

    def line_columns(self, poses: Floats, snapshots: list[Snapshot]) -> list[rr.ComponentColumn]:
        """
        Return the lines of each frame; none where no joint has a line.

        :param poses: (f, n, 3) float64: of the bodies, x, y [m], yaw [rad]
        :param snapshots: of the frames, with the forces of joints
        """
        lines, frames = self._lines, len(poses)
        if not len(lines.owner):
            return []
        corners = lines.corners(poses)
        places = np.full((frames, corners.shape[1], 3), self._height, dtype=np.float32)
        places[..., :2] = corners
        lengths = [len(lines.owner)] * frames
        every = np.tile(lines.lengths, frames)
        return [
            columns.column(columns.STRIPS, (places.reshape(-1, 3), every), lengths),
            columns.column(columns.STRIP_COLORS, self._levels(snapshots, lines.owner), lengths),
            columns.column(
                columns.STRIP_RADII, np.full(frames, self._radius, np.float32), [1] * frames
            ),
        ]

    def dot_columns(self, poses: Floats, snapshots: list[Snapshot]) -> list[rr.ComponentColumn]:
        """
        Return the dots of each frame; none where every joint has a line.

        :param poses: (f, n, 3) float64: of the bodies, x, y [m], yaw [rad]
        :param snapshots: of the frames, with the forces of joints
        """
        frames, count = len(poses), len(self._dotted)
        if not count:
            return []
        places = np.full((frames, count, 3), self._height, dtype=np.float32)
        places[..., :2] = self._lines.points(poses)[:, self._dotted, 0]
        lengths = [count] * frames
        return [
            columns.column(columns.POSITIONS, places.reshape(-1, 3), lengths),
            columns.column(columns.POINT_COLORS, self._levels(snapshots, self._dotted), lengths),
            columns.column(columns.POINT_RADII, np.tile(self._dots, frames), lengths),
        ]

    def _levels(self, snapshots: list[Snapshot], joints: NDArray[np.intp]) -> NDArray[np.uint8]:
        """Return the colours of some joints in each frame, (f * k, 4) uint8."""
        colors = np.stack([self._colors.at(each) for each in snapshots])[:, joints]
        levels: NDArray[np.uint8] = np.rint(colors * 255).astype(np.uint8)
        return levels.reshape(-1, 4)
