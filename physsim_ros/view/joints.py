# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The joints in a recording: symbols that keep their form, lines that do not, and dots of force.

Laws: a scene without joints sends nothing, and joints whose bodies did not move are not sent
again. Symbols that look alike share a mesh. A joint that has no line shows its force by a dot.
"""

from __future__ import annotations

from itertools import count

import numpy as np
from numpy.typing import NDArray
from physsim_ros.appearance import JointGlyphs, Symbol
from physsim_ros.model.arrays import Floats, Singles
from physsim_ros.view.frame_batch import Change, FrameBatch
from physsim_ros.view.mesh import EntityPath, Mesh, MeshBuilder, MeshGroup, MeshTrack
from physsim_ros.view.scenery import JOINTS
from physsim_ros.view.strips import strip_column
import rerun as rr

ROOT = 'world/joints'
LINES, DOTS = f'{ROOT}/lines', f'{ROOT}/forces'
# Half the width of the lines [units], and their colour where it does not tell the force.
_LINE, _INK = 0.02, (0.16, 0.19, 0.24, 1.0)
# Half the size of the smallest visible symbol [units].
_LEAST = 0.1
# Radius of a dot, in half sizes of the symbol.
_DOT = 0.6


class Joints:
    """
    Sends the joints of frames.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._track = MeshTrack(recording)
        self._glyphs: JointGlyphs | None = None
        self._groups: list[MeshGroup] = []
        self._unit = 0.0
        # Path and mesh of each symbol of the scene, for one unit of the view.
        self._meshes: dict[Symbol, tuple[EntityPath, Mesh]] = {}
        self._numbers = count()
        self._filled: set[str] = set()
        recording.log(DOTS, rr.Points3D.from_fields(point_shading='flat'), static=True)

    def send(self, batch: FrameBatch, change: Change) -> None:
        """Send the joints of a batch, if they are others or one of their bodies has moved."""
        if change.resends_scene:
            self._change_scene(batch, change)
        glyphs = self._glyphs
        if glyphs is None or not np.append(change.moved, False)[glyphs.scene.joint_rows].any():
            return
        poses, moved = glyphs.symbol_poses(batch.poses), glyphs.moved_symbols(change.moved)
        self._track.send_poses(self._groups, poses, batch.times, moved)
        colors = np.stack([glyphs.colors(each.snapshot) for each in batch.frames])
        levels = np.rint(colors * 255).astype(np.uint8)
        for path, values in (
            (LINES, self._line_columns(glyphs, batch, levels)),
            (DOTS, self._dot_columns(glyphs, batch, levels)),
        ):
            if values:
                self._filled.add(path)
                self._recording.send_columns(path, batch.times, values)

    def _line_columns(
        self, glyphs: JointGlyphs, batch: FrameBatch, levels: NDArray[np.uint8]
    ) -> list[rr.ComponentColumn]:
        """
        Return the lines of each frame; no columns where no joint has a line.

        :param levels: (f, j, 4) uint8: colours of the joints in the frames
        """
        frames = len(batch)
        if not len(glyphs.owner):
            return []
        places = self._raised(glyphs.corners(batch.poses))
        lengths = [len(glyphs.owner)] * frames
        colors = levels[:, glyphs.owner].reshape(-1, 4)
        return [
            strip_column(places, np.tile(glyphs.lengths, frames), lengths),
            *rr.LineStrips3D.columns(colors=colors).partition(lengths),
            *rr.LineStrips3D.columns(radii=[_LINE * self._unit] * frames),
        ]

    def _dot_columns(
        self, glyphs: JointGlyphs, batch: FrameBatch, levels: NDArray[np.uint8]
    ) -> list[rr.ComponentColumn]:
        """
        Return the dots of each frame; no columns where every joint has a line.

        :param levels: (f, j, 4) uint8: colours of the joints in the frames
        """
        dotted = np.setdiff1d(np.arange(len(glyphs.sizes)), glyphs.owner)
        frames = len(batch)
        if not len(dotted):
            return []
        radii = np.array([_DOT * glyphs.sizes[row] for row in dotted], dtype=np.float32)
        points = rr.Points3D.columns(
            positions=self._raised(glyphs.points(batch.poses)[:, dotted, 0]),
            colors=levels[:, dotted].reshape(-1, 4),
            radii=np.tile(radii, frames),
        )
        return list(points.partition([len(dotted)] * frames))

    def _raised(self, points: Floats) -> Singles:
        """Return points of frames, (f, k, 2) float64, above bodies, (f * k, 3) float32 [m]."""
        places = np.full((*points.shape[:2], 3), JOINTS * self._unit, dtype=np.float32)
        places[..., :2] = points
        return places.reshape(-1, 3)

    def _change_scene(self, batch: FrameBatch, change: Change) -> None:
        """Send new symbols, and clear symbols and lines of joints that are gone."""
        scene, times = batch.scene, batch.times_at([0])
        if self._unit != change.unit:
            self._meshes.clear()
        self._unit, self._glyphs = change.unit, None
        if scene.joints:
            self._glyphs = JointGlyphs(scene, least=_LEAST * change.unit, with_symbols=True)
        self._groups = [] if self._glyphs is None else self._symbol_groups(self._glyphs)
        self._track.send_meshes(self._groups, times, everything=change.resends_all)
        for path in self._filled:
            self._recording.send_columns(path, times, rr.Clear.columns(is_recursive=[False]))
        self._filled.clear()

    def _symbol_groups(self, glyphs: JointGlyphs) -> list[MeshGroup]:
        """Return the symbols of joints, in the order of their poses."""
        groups, start, known = [], 0, self._meshes
        self._meshes = {}
        for symbol, places in glyphs.symbols.items():
            path, mesh = self._meshes[symbol] = known.get(symbol) or self._new(symbol)
            rows = np.arange(start, start + len(places))
            start += len(places)
            groups.append(
                MeshGroup(
                    path=path,
                    names=tuple(glyphs.scene.joints[place.joint].name for place in places),
                    mesh=mesh,
                    rows=rows,
                    depths=np.full(len(places), JOINTS * self._unit, np.float32),
                )
            )
        return groups

    def _new(self, symbol: Symbol) -> tuple[EntityPath, Mesh]:
        """Return path and mesh of a symbol."""
        builder = MeshBuilder()
        for line in symbol:
            builder.add_line(line, _LINE * self._unit, _INK)
        return (*ROOT.split('/'), 'symbols', str(next(self._numbers))), builder.mesh()
