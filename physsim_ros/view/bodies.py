# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The bodies of a scene in Rerun: one mesh for all bodies that look alike, a pose for each; texts.

Laws: a mesh is sent when it changes, poses follow from those of the bodies by array operations;
bodies are drawn in spawn order, the last one on top.

Names are hidden at first; a click on the eye of `names` in the panel of the blueprint shows them.
Rerun (0.41) tells instances of a mesh apart neither where one points nor in a selection.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.scene import Body, Scene
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.view.body_mesh import body_mesh, opacity
from physsim_ros.view.frame_batch import Change, FrameBatch, sampling_period
from physsim_ros.view.mesh import EntityPath, MeshGroup, MeshTrack
from physsim_ros.view.scenery import DEPTH, LABELS, TEXTS
import rerun as rr

ROOT, NAMES, WORDS = 'world/bodies', 'world/names', 'world/labels'
# Greatest ratio of two boxes or discs that share a scaled mesh: it scales their outlines too.
_SIZE_RATIO = 1.5
# Shortest period at which the places of texts are sent [s].
_TEXT_PERIOD = 0.1


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class BodyGroup(MeshGroup):
    """
    The bodies that share a mesh.

    :param first: the body for which the mesh is made
    """

    first: Body


class BodyGeometry:
    """
    The bodies of one scene in groups.

    :param scene: with the bodies
    :param unit: length of a unit of the view [m]
    :param before: the geometry of the scene before; its meshes and paths are used again

    :ivar groups: with at least one body each
    """

    def __init__(self, scene: Scene, unit: float, before: BodyGeometry | None = None) -> None:
        self.scene = scene
        self.unit = unit
        # Keys are found again by the identity of a body; the reference keeps the id from reuse.
        self._keys: dict[int, tuple[Body, Hashable]] = {}
        known = {} if before is None else before._keys  # noqa: SLF001  of the same class
        kept = {} if before is None or before.unit != unit else before._by_key  # noqa: SLF001
        members: defaultdict[Hashable, list[int]] = defaultdict(list)
        for row, body in enumerate(scene.bodies):
            _, key = self._keys[id(body)] = known.get(id(body)) or (body, _appearance(body))
            members[key].append(row)
        self._by_key: dict[Hashable, BodyGroup] = {}
        taken = {kept[key].path for key in members if key in kept}
        for key, rows in members.items():
            self._by_key[key] = self._group(rows, kept.get(key), taken)
        self.groups = list(self._by_key.values())

    def _group(
        self, rows: list[int], before: BodyGroup | None, taken: set[EntityPath]
    ) -> BodyGroup:
        """
        Return the group of some bodies, by their rows.

        :param before: the group of their look in the scene before
        :param taken: paths of other groups
        """
        bodies = [self.scene.bodies[row] for row in rows]
        first = bodies[0]
        mesh = None if before is None or before.first.shape != first.shape else before.mesh
        scales = np.array([_scale(body, first) for body in bodies], dtype=np.float32)
        spacing = DEPTH * self.unit / len(self.scene.bodies)
        return BodyGroup(
            path=before.path if before is not None else _new_path(first.name, taken),
            first=first,
            names=tuple(body.name for body in bodies),
            mesh=mesh or body_mesh(first, self.unit),
            opacity=opacity(first),
            rows=np.array(rows, dtype=np.intp),
            scales=None if (scales == 1.0).all() else scales,
            depths=(np.array(rows) * spacing).astype(np.float32),
        )


class Bodies:
    """
    Sends the bodies of frames.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._meshes = MeshTrack(recording)
        self._geometry: BodyGeometry | None = None

    def send(self, batch: FrameBatch, change: Change) -> None:
        """Send poses, before the meshes: a viewer that draws in between has no body at 0, 0."""
        known = self._geometry
        if known is None or known.scene is not batch.scene or known.unit != change.unit:
            self._geometry = known = BodyGeometry(batch.scene, change.unit, known)
        self._meshes.send_poses(known.groups, batch.poses, batch.times, change.moved)
        if change.resends_scene:
            times = batch.times_at([0])
            self._meshes.send_meshes(known.groups, times, everything=change.resends_all)


class BodyTexts:
    """
    Sends the texts of bodies, at their centroids.

    :param recording: stream to log to
    :param path: of the entity
    :param texts: of a scene, one for each body; '' is none
    """

    def __init__(
        self, recording: rr.RecordingStream, path: str, texts: Callable[[Scene], Sequence[str]]
    ) -> None:
        self._recording = recording
        self._path = path
        self._texts = texts
        # Rows of the bodies that have a text.
        self._rows: NDArray[np.intp] = np.empty(0, np.intp)
        recording.log(path, LABELS, static=True)

    def send(self, batch: FrameBatch, change: Change) -> None:
        """Send the texts of a scene, and their places if a body that has one has moved."""
        if change.resends_scene:
            self._send_texts(batch)
        rows, count = self._rows, len(self._rows)
        if not change.moved[rows].any():
            return
        chosen = batch.sampled(max(_TEXT_PERIOD, sampling_period(count)))
        places = np.full((len(chosen), count, 3), TEXTS * change.unit, dtype=np.float32)
        for number, index in enumerate(chosen):
            places[number, :, :2] = batch.frames[index].snapshot.centers[rows]
        points = rr.Points3D.columns(positions=places.reshape(-1, 3))
        times = batch.times_at(chosen)
        self._recording.send_columns(self._path, times, points.partition([count] * len(chosen)))

    def _send_texts(self, batch: FrameBatch) -> None:
        """Send the texts of a scene, at the first frame of a batch."""
        texts = self._texts(batch.scene)
        before = len(self._rows)
        self._rows = np.flatnonzero([bool(text) for text in texts])
        if before or len(self._rows):
            shown = [text for text in texts if text]
            nowhere = None if shown else np.empty((0, 3), np.float32)
            points = rr.Points3D.columns(labels=shown, positions=nowhere)
            times = batch.times_at([0])
            self._recording.send_columns(self._path, times, points.partition([len(shown)]))


def _appearance(body: Body) -> Hashable:
    """Return a key that is equal for bodies that share a mesh."""
    shape: Hashable = body.shape
    # Arrows are not scaled with their body.
    flow = body.one_way if any(body.one_way) else None
    if body.medium is not None:
        flow = body.medium.flow
    match body.shape:
        case Disc(radius=radius) if flow is None:
            shape = _size_class(radius)
        case Box(width=width, height=height) if flow is None:
            shape = _size_class(width), _size_class(height)
    return shape, body.color, body.anchored, body.kinematic, body.sensor, flow


def _size_class(size: float) -> int:
    """Return the class of a size [m]; the next class is greater by `_SIZE_RATIO`."""
    return round(math.log(size, _SIZE_RATIO))


def _scale(body: Body, first: Body) -> tuple[float, float, float]:
    """Return the size of a body by that of the first of its group."""
    match body.shape, first.shape:
        case Disc(radius=radius), Disc(radius=base):
            return radius / base, radius / base, 1.0
        case Box(width=width, height=height), Box(width=wide, height=high):
            return width / wide, height / high, 1.0
    return 1.0, 1.0, 1.0


def _new_path(name: str, taken: set[EntityPath]) -> EntityPath:
    """Return the path of an entity that is called like a body, and take it."""
    path = (*ROOT.split('/'), *name.rsplit('/', 1))
    while path in taken:
        path = (*path, 'and others')
    taken.add(path)
    return path
