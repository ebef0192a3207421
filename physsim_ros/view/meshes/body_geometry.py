# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The bodies of a scene in Rerun: one mesh for all bodies that look alike, and a pose for each.

Laws: a mesh is sent when it changes, poses follow from those of the bodies by array operations;
bodies are drawn in spawn order, the last one on top.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Hashable, Mapping
from dataclasses import dataclass
import math
from types import MappingProxyType

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Body, Scene
from physsim_ros.model.settings import Bounds
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.model.transform import rotated_each
from physsim_ros.view.meshes.body_mesh import body_mesh, opacity
from physsim_ros.view.meshes.mesh import Strips
from physsim_ros.view.meshes.mesh_track import MeshGroup, Path

ROOT = 'world/bodies'
# Depth over which later bodies lie above earlier ones [units]: enough for the renderer's depth
# buffer, too little for a difference in perspective.
DEPTH = 0.02
# Greatest ratio of two boxes or discs that share a scaled mesh: it scales their outlines too.
_SIZE_RATIO = 1.5


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
    :param symbols: of joints, by the row of the body that they are drawn on

    :ivar groups: with at least one body each
    """

    def __init__(
        self,
        scene: Scene,
        unit: float,
        before: BodyGeometry | None = None,
        symbols: Mapping[int, Strips] = MappingProxyType({}),
    ) -> None:
        self.scene = scene
        self.unit = unit
        # Keys are found again by the identity of a body; the reference keeps the id from reuse.
        self._keys: dict[int, tuple[Body, Hashable]] = {}
        known = {} if before is None else before._keys  # noqa: SLF001  of the same class
        kept = {} if before is None or before.unit != unit else before._by_key  # noqa: SLF001
        members: defaultdict[Hashable, list[int]] = defaultdict(list)
        for row, body in enumerate(scene.bodies):
            if row in symbols:
                key: Hashable = body.shape, *_look(body), symbols[row]
            else:
                _, key = self._keys[id(body)] = known.get(id(body)) or (body, _appearance(body))
            members[key].append(row)
        self._by_key: dict[Hashable, BodyGroup] = {}
        taken = {kept[key].path for key in members if key in kept}
        for key, rows in members.items():
            self._by_key[key] = self._group(rows, kept.get(key), symbols.get(rows[0], ()), taken)
        self.groups = list(self._by_key.values())

    def _group(
        self, rows: list[int], before: BodyGroup | None, symbols: Strips, taken: set[Path]
    ) -> BodyGroup:
        """
        Return the group of some bodies, by their rows.

        :param before: the group of their look in the scene before
        :param symbols: of joints, in the mesh
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
            mesh=mesh or body_mesh(first, self.unit, symbols),
            opacity=opacity(first),
            rows=np.array(rows, dtype=np.intp),
            scales=None if (scales == 1.0).all() else scales,
            depths=(np.array(rows) * spacing).astype(np.float32),
        )

    def extent(self, poses: Floats) -> Bounds:
        """
        Return left, bottom, right, top [m] of all bodies; at least one body.

        :param poses: (n, 3) float64: x, y [m], yaw [rad]
        """
        low, high = [], []
        for group in self.groups:
            (left, bottom), (right, top) = group.mesh.extent
            corners = np.array(((left, bottom), (right, bottom), (right, top), (left, top)))
            scales = np.ones((1, 3)) if group.scales is None else group.scales
            offsets = rotated_each(corners * scales[:, None, :2], poses[group.rows, 2][:, None])
            places = poses[group.rows, None, :2] + offsets
            low.append(places.min(axis=(0, 1)))
            high.append(places.max(axis=(0, 1)))
        left, bottom = np.min(low, axis=0).tolist()
        right, top = np.max(high, axis=0).tolist()
        return left, bottom, right, top


def _appearance(body: Body) -> Hashable:
    """Return a key that is equal for bodies that share a mesh."""
    shape: Hashable = body.shape
    match body.shape:
        case Disc(radius=radius):
            shape = _size_class(radius)
        case Box(width=width, height=height):
            shape = _size_class(width), _size_class(height)
    return shape, *_look(body)


def _look(body: Body) -> tuple[Hashable, ...]:
    """Return the properties of a body, beside its shape, on which its look depends."""
    return body.color, body.anchored, body.kinematic, body.sensor


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


def _new_path(name: str, taken: set[Path]) -> Path:
    """Return the path of an entity that is called like a body, and take it."""
    path = (*ROOT.split('/'), *name.rsplit('/', 1))
    while path in taken:
        path = (*path, 'and others')
    taken.add(path)
    return path
