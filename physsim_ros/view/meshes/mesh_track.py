# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Meshes in a recording: sent when they change, and the poses of their instances when these move.

Law: meshes are sent on the timeline, not as static data, so that the past looks as it did.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats, Singles
from physsim_ros.view.frame_batch import Times
from physsim_ros.view.meshes.mesh import Mesh
import rerun as rr

Path = tuple[str, ...]


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

    path: Path
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
        self._sent: dict[Path, MeshGroup] = {}

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
        self,
        groups: Sequence[MeshGroup],
        poses: Floats,
        times: Times,
        moved: NDArray[np.bool_],
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
