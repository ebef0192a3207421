# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The joints in a recording: symbols that keep their form, lines that do not, and dots of force.

Laws: a scene without joints sends nothing, and joints whose bodies did not move are not sent
again. Symbols that look alike share a mesh. A joint that has no line shows its force by a dot.
"""

from __future__ import annotations

from collections import defaultdict
from itertools import count
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
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import Point
from physsim_ros.view.frame_batch import Change, FrameBatch, strip_column
from physsim_ros.view.mesh import Mesh, MeshBuilder, MeshGroup, MeshTrack, Path
from physsim_ros.view.scenery import JOINTS
import rerun as rr

ROOT = 'world/joints'
LINES, DOTS = f'{ROOT}/lines', f'{ROOT}/forces'
# Half the width of the lines [units], and their colour where it does not tell the force.
_LINE, _INK = 0.02, (0.16, 0.19, 0.24, 1.0)
# Half the size of the smallest visible symbol [units].
_LEAST = 0.1
# Radius of a dot, in half sizes of the symbol.
_DOT = 0.6
# Decimals that corners are rounded to, so that equal symbols are equal: a micrometre.
_DIGITS = 6
# The lines of a symbol, each through its corners, about a point of its joint [m].
_Symbol = tuple[tuple[Point, ...], ...]


class _Place(NamedTuple):
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

    :ivar symbols: the lines of each, and the frames in which it is drawn
    """

    def __init__(self, scene: Scene, unit: float) -> None:
        self.scene, self.unit = scene, unit
        sizes = symbol_sizes(scene, least=_LEAST * unit)
        strips = [joint_strips(each, size) for each, size in zip(scene.joints, sizes, strict=True)]
        loose = [[strip for strip in each if not is_rigid(strip)] for each in strips]
        self._lines = JointLines(scene, loose)
        self._colors = JointColors(scene)
        self._bodies = np.unique(scene.joint_rows[scene.joint_rows >= 0])
        self._dotted = np.setdiff1d(np.arange(len(scene.joints)), self._lines.owner)
        self._dots = np.array([_DOT * sizes[row] for row in self._dotted], dtype=np.float32)
        self.symbols = _symbols(strips)
        places = [place for each in self.symbols.values() for place in each]
        joints, points, sides = np.array(places, np.intp).reshape(-1, 3).T
        self._points = joints, points
        self._rows = scene.joint_rows[joints, sides]

    def has_moved(self, moved: NDArray[np.bool_]) -> bool:
        """
        Return whether a body of a joint has moved.

        :param moved: (n,) bool: whether each body has
        """
        return bool(moved[self._bodies].any())

    def moved_symbols(self, moved: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """
        Return whether a body of the joint of each symbol has moved, (s,) bool.

        :param moved: (n,) bool: whether each body has
        """
        joints, _ = self._points
        of_bodies = np.append(moved, False)[self.scene.joint_rows[joints]]
        either: NDArray[np.bool_] = of_bodies[:, 0] | of_bodies[:, 1]
        return either

    def symbol_poses(self, poses: Floats) -> Floats:
        """
        Return the poses of the symbols in frames, (f, s, 3) float64.

        :param poses: (f, n, 3) float64: of the bodies, x, y [m], yaw [rad]
        """
        result = np.empty((len(poses), len(self._rows), 3))
        result[..., :2] = self._lines.points(poses)[:, *self._points]
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
        places = np.full((frames, corners.shape[1], 3), JOINTS * self.unit, dtype=np.float32)
        places[..., :2] = corners
        lengths = [len(lines.owner)] * frames
        levels = self._levels(snapshots, lines.owner)
        return [
            strip_column(places.reshape(-1, 3), np.tile(lines.lengths, frames), lengths),
            *rr.LineStrips3D.columns(colors=levels).partition(lengths),
            *rr.LineStrips3D.columns(radii=[_LINE * self.unit] * frames),
        ]

    def dot_columns(self, poses: Floats, snapshots: list[Snapshot]) -> list[rr.ComponentColumn]:
        """
        Return the dots of each frame; no columns where every joint has a line.

        :param poses: (f, n, 3) float64: of the bodies, x, y [m], yaw [rad]
        :param snapshots: of the frames, with the forces of joints
        """
        frames, dots = len(poses), len(self._dotted)
        if not dots:
            return []
        places = np.full((frames, dots, 3), JOINTS * self.unit, dtype=np.float32)
        places[..., :2] = self._lines.points(poses)[:, self._dotted, 0]
        points = rr.Points3D.columns(
            positions=places.reshape(-1, 3),
            colors=self._levels(snapshots, self._dotted),
            radii=np.tile(self._dots, frames),
        )
        return list(points.partition([dots] * frames))

    def _levels(self, snapshots: list[Snapshot], joints: NDArray[np.intp]) -> NDArray[np.uint8]:
        """Return the colours of some joints in each frame, (f * k, 4) uint8."""
        colors = np.stack([self._colors.at(each) for each in snapshots])[:, joints]
        levels: NDArray[np.uint8] = np.rint(colors * 255).astype(np.uint8)
        return levels.reshape(-1, 4)


class Joints:
    """
    Sends the joints of frames.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._track = MeshTrack(recording)
        self._geometry: JointGeometry | None = None
        self._groups: list[MeshGroup] = []
        # Path and mesh of each symbol of the scene, for one unit of the view.
        self._meshes: dict[_Symbol, tuple[Path, Mesh]] = {}
        self._numbers = count()
        self._filled: set[str] = set()
        recording.log(DOTS, rr.Points3D.from_fields(point_shading='flat'), static=True)

    def send(self, batch: FrameBatch, change: Change) -> None:
        """Send the joints of a batch, if they are others or one of their bodies has moved."""
        if change.scene:
            self._change_scene(batch, change)
        joints = self._geometry
        if joints is None or not joints.has_moved(change.moved):
            return
        poses = joints.symbol_poses(batch.poses)
        moved = joints.moved_symbols(change.moved)
        self._track.send_poses(self._groups, poses, batch.times, moved)
        snapshots = [each.snapshot for each in batch.frames]
        for path, values in (
            (LINES, joints.line_columns(batch.poses, snapshots)),
            (DOTS, joints.dot_columns(batch.poses, snapshots)),
        ):
            if values:
                self._filled.add(path)
                self._recording.send_columns(path, batch.times, values)

    def _change_scene(self, batch: FrameBatch, change: Change) -> None:
        """Send new symbols, and clear symbols and lines of joints that are gone."""
        scene, known, times = batch.scene, self._geometry, batch.times_at([0])
        if known is not None and known.unit != change.unit:
            self._meshes.clear()
        self._geometry = JointGeometry(scene, change.unit) if scene.joints else None
        self._groups = [] if self._geometry is None else self._symbol_groups(self._geometry)
        self._track.send_meshes(self._groups, times, everything=change.everything)
        for path in self._filled:
            self._recording.send_columns(path, times, rr.Clear.columns(is_recursive=[False]))
        self._filled.clear()

    def _symbol_groups(self, joints: JointGeometry) -> list[MeshGroup]:
        """Return the symbols of joints, in the order of their poses."""
        groups, start, known = [], 0, self._meshes
        self._meshes = {}
        for symbol, places in joints.symbols.items():
            path, mesh = self._meshes[symbol] = known.get(symbol) or self._new(symbol, joints.unit)
            rows = np.arange(start, start + len(places))
            start += len(places)
            groups.append(
                MeshGroup(
                    path=path,
                    names=tuple(joints.scene.joints[place.joint].name for place in places),
                    mesh=mesh,
                    rows=rows,
                    depths=np.full(len(places), JOINTS * joints.unit, np.float32),
                )
            )
        return groups

    def _new(self, symbol: _Symbol, unit: float) -> tuple[Path, Mesh]:
        """Return path and mesh of a symbol."""
        builder = MeshBuilder()
        for line in symbol:
            builder.add_line(line, _LINE * unit, _INK)
        return (*ROOT.split('/'), 'symbols', str(next(self._numbers))), builder.mesh()


def _symbols(strips: list[list[Strip]]) -> dict[_Symbol, list[_Place]]:
    """
    Return the symbols, with the frames in which each is drawn.

    :param strips: of each joint
    """
    symbols: defaultdict[_Symbol, list[_Place]] = defaultdict(list)
    for number, each in enumerate(strips):
        lines: defaultdict[_Place, _Symbol] = defaultdict(tuple)
        for strip in filter(is_rigid, each):
            place = _Place(number, int(strip[0].along), int(strip[0].on_b))
            lines[place] += (tuple(_rounded(corner.arm) for corner in strip),)
        for place, symbol in lines.items():
            symbols[symbol].append(place)
    return symbols


def _rounded(point: Point) -> Point:
    return round(point[0], _DIGITS), round(point[1], _DIGITS)
