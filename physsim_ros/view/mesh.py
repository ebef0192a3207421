# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Flat meshes: filled polygons, discs and thick lines, in layers of one colour each.

Laws: all vertices of a mesh lie at z = 0 and have no normals, so Rerun draws it unlit, in the
colours as given; of two triangles that overlap, the later one is seen (Rerun 0.41 compares depths
by `GreaterEqual`). Meshes are sent on the timeline, not as static data, so that the past looks as
it did.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
import math

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats, Singles
from physsim_ros.model.colors import Color
from physsim_ros.model.transform import Point
from physsim_ros.view.frame_batch import Times
import rerun as rr

# Sides of a disc: the chord of a 64-gon lies 0.12 % of the radius inside the circle.
SIDES = 64
# Sides of the round end of a line.
_END_SIDES = 12
# Greatest length of a mitre, in widths of the band: sharper corners are cut off.
_MITRE = 4.0
# The path of an entity in a recording, by its parts.
EntityPath = tuple[str, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """
    A flat mesh.

    :param vertices: (v, 2) float32 [m]
    :param triangles: (t, 3) uint32: indices of vertices
    :param colors: (v, 4) uint8: red, green, blue, alpha
    """

    vertices: Singles
    triangles: NDArray[np.uint32]
    colors: NDArray[np.uint8]


class MeshBuilder:
    """Collects the triangles of a mesh, the lowest layer first."""

    def __init__(self) -> None:
        self._vertices: list[Floats] = []
        self._triangles: list[NDArray[np.int64]] = []
        self._colors: list[Floats] = []
        self._count = 0

    def mesh(self) -> Mesh:
        """Return the mesh of what has been added, at least one triangle."""
        return Mesh(
            vertices=np.concatenate(self._vertices).astype(np.float32),
            triangles=np.concatenate(self._triangles).astype(np.uint32),
            colors=np.rint(np.concatenate(self._colors) * 255).astype(np.uint8),
        )

    def add_convex(self, vertices: Sequence[Point] | Floats, color: Color) -> None:
        """Add a convex polygon of at least three vertices, in order [m]."""
        second = np.arange(1, len(vertices) - 1)
        self._add(vertices, np.column_stack((np.zeros_like(second), second, second + 1)), color)

    def add_disc(self, center: Point, radius: float, color: Color, *, sides: int = SIDES) -> None:
        """Add a regular polygon for a circle [m]."""
        self.add_convex(circle(center, radius, sides), color)

    def add_line(self, points: Sequence[Point], half_width: float, color: Color) -> None:
        """Add a polyline of at least two points with round joints and ends [m]."""
        for start, end in pairwise(points):
            length = math.dist(start, end)
            if length > 0.0:
                across = half_width / length
                side = np.array((start[1] - end[1], end[0] - start[0])) * across
                corners = np.array((start, end, end, start))
                corners[:2] -= side
                corners[2:] += side
                self.add_convex(corners, color)
        for point in dict.fromkeys(points):
            self.add_disc(point, half_width, color, sides=_END_SIDES)

    def add_band(self, outline: Sequence[Point], width: float, color: Color) -> None:
        """
        Add a band along the inner side of an outline.

        :param outline: of a polygon, counter-clockwise, at least three vertices [m]
        :param width: of the band [m]
        """
        outer, inner = np.array(outline), inset(outline, width)
        count = len(outer)
        near, far = np.arange(count), np.roll(np.arange(count), -1)
        triangles = np.concatenate(
            (
                np.column_stack((near, far, far + count)),
                np.column_stack((near, far + count, near + count)),
            )
        )
        self._add(np.concatenate((outer, inner)), triangles, color)

    def _add(
        self, vertices: Sequence[Point] | Floats, triangles: NDArray[np.int64], color: Color
    ) -> None:
        self._vertices.append(np.asarray(vertices, dtype=np.float64))
        self._triangles.append(triangles + self._count)
        self._colors.append(np.tile(color, (len(vertices), 1)))
        self._count += len(vertices)


def circle(center: Point, radius: float, sides: int = SIDES) -> Floats:
    """Return the vertices of a regular polygon, (sides, 2) float64 [m], counter-clockwise."""
    angles = np.linspace(0.0, math.tau, sides, endpoint=False)
    return center + radius * np.column_stack((np.cos(angles), np.sin(angles)))


def inset(outline: Sequence[Point], width: float) -> Floats:
    """
    Return the vertices of a polygon moved inward, so that its edges move by a width.

    :param outline: counter-clockwise, at least three vertices [m]
    :param width: [m]
    :return: (n, 2) float64 [m], vertex by vertex
    """
    vertices = np.array(outline, dtype=np.float64)
    edges = np.roll(vertices, -1, axis=0) - vertices
    lengths = np.hypot(edges[:, 0], edges[:, 1])[:, None]
    after = np.column_stack((-edges[:, 1], edges[:, 0])) / np.maximum(lengths, 1e-12)
    before = np.roll(after, 1, axis=0)
    mitre = before + after
    # Of unit normals m, n the mitre is (m + n) / (1 + m · n).
    scale = 1.0 + (before * after).sum(axis=1, keepdims=True)
    mitre /= np.maximum(scale, 2.0 / _MITRE**2)
    moved: Floats = vertices + width * mitre
    return moved


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class MeshGroup:
    """
    Instances of a mesh.

    :param path: of the entity
    :param names: of the instances
    :param mesh: in the frame of an instance
    :param rows: (k,) intp: rows of the instances among all poses
    :param depths: (k,) float32: z [m]
    :param scales: (k, 3) float32: size of each instance by that of the mesh; None where all are 1
    :param opacity: of the mesh, 0 .. 1
    """

    path: EntityPath
    names: tuple[str, ...]
    mesh: Mesh
    rows: NDArray[np.intp]
    depths: Singles
    scales: Singles | None = None
    opacity: float = 1.0

    def translations(self, poses: Floats) -> Singles:
        """
        Return the positions of the instances in frames, (f * k, 3) float32 [m].

        :param poses: (f, n, 3) float64: x, y [m], yaw [rad]
        """
        places = np.empty((len(poses), len(self.rows), 3), dtype=np.float32)
        places[..., :2] = poses[:, self.rows, :2]
        places[..., 2] = self.depths
        return places.reshape(-1, 3)

    def rotations(self, poses: Floats) -> Singles:
        """
        Return the rotations of the instances in frames, (f * k, 4) float32: x, y, z, w.

        :param poses: (f, n, 3) float64: x, y [m], yaw [rad]
        """
        half = poses[:, self.rows, 2].ravel() / 2
        quaternions = np.zeros((len(half), 4), dtype=np.float32)
        quaternions[:, 2], quaternions[:, 3] = np.sin(half), np.cos(half)
        return quaternions


class MeshTrack:
    """
    Sends groups of instances.

    :param recording: stream to log to
    """

    def __init__(self, recording: rr.RecordingStream) -> None:
        self._recording = recording
        self._sent: dict[EntityPath, MeshGroup] = {}

    def send_meshes(self, groups: Sequence[MeshGroup], times: Times, *, everything: bool) -> None:
        """
        Send meshes and names of new groups, and clear the entities of groups that are gone.

        :param groups: to be seen from now on
        :param times: of one frame
        :param everything: send the groups that have been sent, too
        """
        by_path = {group.path: group for group in groups}
        for path in self._sent.keys() - by_path.keys():
            clear = rr.Clear.columns(is_recursive=[False])
            self._recording.send_columns(rr.new_entity_path([*path]), times, clear)
        for path, group in by_path.items():
            before = self._sent.get(path)
            if everything or before is None or before.mesh is not group.mesh:
                self._send_mesh(group, times)
            if everything or before is None or before.names != group.names:
                names = rr.AnyValues.columns(name=list(group.names)).partition([len(group.names)])
                self._recording.send_columns(rr.new_entity_path([*path]), times, names)
        self._sent = by_path

    def send_poses(
        self, groups: Sequence[MeshGroup], poses: Floats, times: Times, moved: NDArray[np.bool_]
    ) -> None:
        """
        Send the poses of the groups in which an instance has moved.

        :param poses: (f, n, 3) float64: x, y [m], yaw [rad] of all instances in frames
        :param times: of the frames
        :param moved: (n,) bool: whether each instance has
        """
        for group in groups:
            if not moved[group.rows].any():
                continue
            # Rerun (0.41) takes all components of a pose from one row.
            scales = None if group.scales is None else np.tile(group.scales, (len(poses), 1))
            instances = rr.InstancePoses3D.columns(
                translations=group.translations(poses),
                quaternions=group.rotations(poses),
                scales=scales,
            ).partition([len(group.rows)] * len(poses))
            self._recording.send_columns(rr.new_entity_path([*group.path]), times, instances)

    def _send_mesh(self, group: MeshGroup, times: Times) -> None:
        mesh = group.mesh
        vertices = np.zeros((len(mesh.vertices), 3), dtype=np.float32)
        vertices[:, :2] = mesh.vertices
        lengths = [[len(vertices)], [len(mesh.triangles)], [len(vertices)], [1]]
        fields = (
            rr.Mesh3D.columns(vertex_positions=vertices),
            rr.Mesh3D.columns(triangle_indices=mesh.triangles),
            rr.Mesh3D.columns(vertex_colors=mesh.colors),
            rr.Mesh3D.columns(albedo_factor=[(255, 255, 255, round(255 * group.opacity))]),
        )
        parts = [
            part
            for field, length in zip(fields, lengths, strict=True)
            for part in field.partition(length)
        ]
        self._recording.send_columns(rr.new_entity_path([*group.path]), times, parts)
