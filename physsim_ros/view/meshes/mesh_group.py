# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Things that are drawn by one mesh, each with a pose of its own."""

from __future__ import annotations

from dataclasses import dataclass
import math

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats, Singles
from physsim_ros.view.meshes.mesh import Mesh

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

    def yaws(self, poses: Floats) -> Singles:
        """
        Return the rotations of the instances in frames, (f * k,) float32 [rad], -pi .. pi.

        :param poses: (f, n, 3) float64: x, y [m], yaw [rad]
        """
        # float32 has no digits to spare for whole turns.
        yaw = np.remainder(poses[:, self.rows, 2] + math.pi, math.tau) - math.pi
        return yaw.astype(np.float32).ravel()
