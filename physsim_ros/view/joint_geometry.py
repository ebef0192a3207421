# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
The joints of a scene in Rerun: one entity of line strips, sent for many frames at once.

Law: a scene without joints sends nothing, and joints whose bodies did not move are not sent again.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Scene
from physsim_ros.view.body_geometry import FINE
from physsim_ros.view.joint_glyphs import JointLines
import pyarrow as pa
import rerun as rr

PATH = 'world/joints'
# Half the size of the smallest visible symbol [units].
_LEAST = 0.1


class JointGeometry:
    """
    The line strips of the joints of one scene, as columns of components.

    :param scene: with the joints
    :param unit: length of a unit of the view [m]
    :param height: z of the strips, above all bodies [m]
    """

    def __init__(self, scene: Scene, unit: float, height: float) -> None:
        self._lines = JointLines(scene, least=_LEAST * unit)
        self._height = height
        self._radius = 0.8 * FINE * unit
        self._bodies = np.unique(scene.joint_rows[scene.joint_rows >= 0])

    def has_moved(self, moved: NDArray[np.bool_]) -> bool:
        """
        Return whether a body of a joint has moved.

        :param moved: (n,) bool: whether each body has
        """
        return bool(moved[self._bodies].any())

    def columns(self, poses: Floats, forces: list[Floats]) -> list[rr.ComponentColumn]:
        """
        Return the strips of each frame.

        :param poses: (f, n, 3) float64: of the bodies, x, y [m], yaw [rad]
        :param forces: (j,) float64 each: of the joints [N], empty where they are unknown
        """
        lines, frames = self._lines, len(poses)
        corners = lines.corners(poses)
        places = np.full((frames, corners.shape[1], 3), self._height, dtype=np.float32)
        places[..., :2] = corners
        colors = np.stack([lines.colors(each) for each in forces])[:, lines.owner]
        levels = np.rint(colors * 255).astype(np.uint8).reshape(-1, 4)
        lengths = [len(lines.owner)] * frames
        return [
            rr.ComponentColumn(_STRIPS, _Strips(places, lines.lengths), lengths=lengths),
            rr.ComponentColumn(_COLORS, rr.components.ColorBatch(levels), lengths=lengths),
            rr.ComponentColumn(
                _RADII,
                rr.components.RadiusBatch(np.full(frames, self._radius, np.float32)),
                lengths=[1] * frames,
            ),
        ]


class _Strips:
    """Line strips as an Arrow array; `LineStrip3DBatch` (Rerun 0.41) is a loop in Python."""

    def __init__(self, places: NDArray[np.float32], lengths: NDArray[np.intp]) -> None:
        self._places, self._lengths = places, lengths

    def as_arrow_array(self) -> pa.Array:
        """Return a list of corners for each strip of each frame."""
        every = np.tile(self._lengths, len(self._places))
        offsets = np.concatenate(([0], np.cumsum(every))).astype(np.int32)
        corner = pa.list_(pa.field('item', pa.float32(), nullable=False), 3)
        flat = pa.FixedSizeListArray.from_arrays(pa.array(self._places.ravel()), type=corner)
        kind = pa.list_(pa.field('item', corner, nullable=False))
        return pa.ListArray.from_arrays(pa.array(offsets), flat, type=kind)


_STRIPS, _RADII, _COLORS = (
    column.descriptor
    for column in rr.LineStrips3D.columns(
        strips=[[(0, 0, 0), (1, 0, 0)]], radii=[1.0], colors=[(0, 0, 0)]
    )
)
