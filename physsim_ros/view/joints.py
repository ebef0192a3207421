# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The joints in a recording: symbols that keep their form, lines that do not, and dots of force.

Laws: a scene without joints sends nothing, and joints whose bodies did not move are not sent
again. A joint that has no line shows its force by a dot.

A symbol belongs to the mesh of its body, so that it costs nothing while it moves. Where two bodies
are joined at one point, the symbol is drawn on the later spawned one, which lies above the other.
"""

from __future__ import annotations

from collections import defaultdict
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from physsim_ros.appearance import (
    is_rigid,
    joint_strips,
    JointColors,
    JointLines,
    Strip,
    symbol_sizes,
)
from physsim_ros.model.arrays import Floats
from physsim_ros.model.joints import JointKind
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import Point
from physsim_ros.view.frame_batch import FrameBatch, Times
from physsim_ros.view.line_strips import strip_column
from physsim_ros.view.meshes.body_mesh import JOINT_INK, JOINT_LINE
from physsim_ros.view.meshes.mesh import MeshBuilder, Strips
from physsim_ros.view.meshes.mesh_track import MeshGroup, MeshTrack
import rerun as rr

ROOT = 'world/joints'
LINES, DOTS = f'{ROOT}/lines', f'{ROOT}/forces'
# Half the size of the smallest visible symbol [units].
_LEAST = 0.1
# Radius of a dot, in half sizes of the symbol.
_DOT = 0.6
# Decimals that corners are rounded to, so that equal symbols are equal: a micrometre.
_DIGITS = 6
# Kinds whose two points are one.
_POINTED = {JointKind.PIN, JointKind.AXLE, JointKind.MOTOR}


class Place(NamedTuple):
    """
    The frame of a symbol.

    :ivar joint: row of the joint
    :ivar point: 0 or 1: the first or the second point of the joint, about which it is drawn
    :ivar side: 0 or 1: the body a or b, with which it turns
    """

    joint: int
    point: int
    side: int


class JointGeometry:
    """
    The joints of one scene, as columns of components.

    :param scene: with the joints
    :param unit: length of a unit of the view [m]
    :param height: z of the joints, above all bodies [m]

    :ivar body_symbols: by the row of a body: the symbols in the mesh of that body
    :ivar groups: the other symbols: on the background, or turning with the other body
    """

    def __init__(self, scene: Scene, unit: float, height: float) -> None:
        self._scene = scene
        sizes = symbol_sizes(scene, least=_LEAST * unit)
        strips = [joint_strips(each, size) for each, size in zip(scene.joints, sizes, strict=True)]
        rigid = [list(filter(is_rigid, each)) for each in strips]
        self._lines = JointLines(
            scene, [[strip for strip in each if not is_rigid(strip)] for each in strips]
        )
        self._colors = JointColors(scene)
        self._height, self._radius = height, JOINT_LINE * unit
        self._bodies = np.unique(scene.joint_rows[scene.joint_rows >= 0])
        self._dotted = np.setdiff1d(np.arange(len(scene.joints)), self._lines.owner)
        self._dots = np.array([_DOT * sizes[row] for row in self._dotted], dtype=np.float32)
        self.body_symbols, loose = _symbols(scene, rigid, self._lines.seats)
        joints, points, sides = np.array(list(loose), np.intp).reshape(-1, 3).T
        self._places = joints, points
        self._rows = scene.joint_rows[joints, sides]
        self.groups = [
            self._group(row, scene.joints[place.joint].name, loose[place])
            for row, place in enumerate(loose)
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
        Return the poses of the symbols of `groups` in frames, (f, s, 3) float64.

        :param poses: (f, n, 3) float64: of the bodies, x, y [m], yaw [rad]
        """
        result = np.empty((len(poses), len(self._rows), 3))
        points = self._lines.points(poses)
        result[..., :2] = points[:, *self._places]
        background = np.zeros((len(poses), 1))
        result[..., 2] = np.concatenate((poses[..., 2], background), axis=1)[:, self._rows]
        return result

    def line_columns(self, poses: Floats, snapshots: list[Snapshot]) -> list[rr.ComponentColumn]:
        """
        Return the lines of each frame; no columns where no joint has a line.

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
        levels = self._levels(snapshots, lines.owner)
        return [
            strip_column(places.reshape(-1, 3), every, lengths),
            *rr.LineStrips3D.columns(colors=levels).partition(lengths),
            *rr.LineStrips3D.columns(radii=[self._radius] * frames),
        ]

    def dot_columns(self, poses: Floats, snapshots: list[Snapshot]) -> list[rr.ComponentColumn]:
        """
        Return the dots of each frame; no columns where every joint has a line.

        :param poses: (f, n, 3) float64: of the bodies, x, y [m], yaw [rad]
        :param snapshots: of the frames, with the forces of joints
        """
        frames, count = len(poses), len(self._dotted)
        if not count:
            return []
        places = np.full((frames, count, 3), self._height, dtype=np.float32)
        places[..., :2] = self._lines.points(poses)[:, self._dotted, 0]
        points = rr.Points3D.columns(
            positions=places.reshape(-1, 3),
            colors=self._levels(snapshots, self._dotted),
            radii=np.tile(self._dots, frames),
        )
        return list(points.partition([count] * frames))

    def _levels(self, snapshots: list[Snapshot], joints: NDArray[np.intp]) -> NDArray[np.uint8]:
        """Return the colours of some joints in each frame, (f * k, 4) uint8."""
        colors = np.stack([self._colors.at(each) for each in snapshots])[:, joints]
        levels: NDArray[np.uint8] = np.rint(colors * 255).astype(np.uint8)
        return levels.reshape(-1, 4)


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

    def change_scene(self, scene: Scene, unit: float, height: float) -> dict[int, Strips]:
        """
        Send the joints of another scene from now on.

        :param unit: length of a unit of the view [m]
        :param height: z of the joints [m]
        :return: symbols for the meshes of bodies, by the rows of these
        """
        self._joints = JointGeometry(scene, unit, height) if scene.joints else None
        return {} if self._joints is None else self._joints.body_symbols

    def send_symbols(self, times: Times, *, everything: bool) -> None:
        """
        Send new symbols, and clear symbols and lines of joints that are gone.

        :param times: of one frame
        :param everything: send the symbols that have been sent, too
        """
        groups = [] if self._joints is None else self._joints.groups
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
        for path, values in (
            (LINES, joints.line_columns(batch.poses, snapshots)),
            (DOTS, joints.dot_columns(batch.poses, snapshots)),
        ):
            if values:
                self._filled.add(path)
                self._recording.send_columns(path, batch.times, values)


def _symbols(
    scene: Scene, strips: list[list[Strip]], seats: Floats
) -> tuple[dict[int, Strips], dict[Place, Strips]]:
    """
    Return the symbols in the frames of bodies, by their rows, and all others by their places.

    :param strips: of each joint, those that keep their form
    :param seats: (j, 2, 2) float64: points of the joints in the frames of a and b [m]
    """
    fixed: defaultdict[int, Strips] = defaultdict(tuple)
    loose: defaultdict[Place, Strips] = defaultdict(tuple)
    for number, joint in enumerate(scene.joints):
        rows = scene.joint_rows[number].tolist()
        for strip in strips[number]:
            point, side = int(strip[0].along), int(strip[0].on_b)
            if joint.kind in _POINTED:
                point = side = int(np.argmax(rows))
            if point == side and rows[side] >= 0:
                x, y = seats[number, side].tolist()
                fixed[rows[side]] += (_placed(strip, (x, y)),)
            else:
                loose[Place(number, point, side)] += (_placed(strip, (0.0, 0.0)),)
    return fixed, loose


def _placed(strip: Strip, at: Point) -> tuple[Point, ...]:
    """Return the corners of a strip about a point."""
    return tuple(
        (round(corner.arm[0] + at[0], _DIGITS), round(corner.arm[1] + at[1], _DIGITS))
        for corner in strip
    )
