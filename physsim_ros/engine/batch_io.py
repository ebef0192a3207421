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
The engine's bodies and contacts as arrays, in the order of its own listing.

Pymunk reads and writes them in batch; attribute by attribute it would take a hundred times as
long.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats
import pymunk
from pymunk import batch

Ids = NDArray[np.uint64]

_PLACE = batch.BodyFields.POSITION
_TWIST = batch.BodyFields.VELOCITY | batch.BodyFields.ANGULAR_VELOCITY
_POSE = _PLACE | batch.BodyFields.ANGLE
_STATE = _POSE | _TWIST

_F = batch.ArbiterFields
_POINTS = _F.BODY_A_ID | _F.BODY_B_ID | _F.NORMAL | _F.CONTACT_COUNT
_POINTS |= _F.POINT_A_1 | _F.POINT_B_1 | _F.POINT_A_2 | _F.POINT_B_2


class Touching(NamedTuple):
    """
    Points at which bodies touch.

    :ivar bodies: (c, 2): ids of both, or whatever else tells them
    :ivar points: (c, 2) float64 [m]
    :ivar normals: (c, 2) float64: from the first to the second
    """

    bodies: NDArray[Any]
    points: Floats
    normals: Floats


class EngineArrays:
    """
    Reads and writes what is in a space, all at once.

    :param space: of the engine
    """

    def __init__(self, space: pymunk.Space) -> None:
        self._space = space
        # Used again and again: a new one a call would leak. One to read and one to write with: the
        # engine must not grow memory that numpy owns.
        self._buffer, self._written = batch.Buffer(), batch.Buffer()

    def ids(self) -> list[int]:
        """Return the engine's ids of all bodies."""
        self._buffer.clear()
        batch.get_space_bodies(self._space, batch.BodyFields.BODY_ID, self._buffer)
        ids: list[int] = np.frombuffer(self._buffer.int_buf(), dtype=np.uintp).tolist()
        return ids

    def centers(self) -> Floats:
        """Return (m, 2) float64: where the engine has its origins [m]."""
        return self._bodies(_PLACE, 2)

    def poses(self) -> Floats:
        """Return (m, 3) float64: where they are, and their angles [m, rad]."""
        return self._bodies(_POSE, 3)

    def twists(self) -> Floats:
        """Return (m, 3) float64: velocities [m/s] and spins [rad/s]."""
        return self._bodies(_TWIST, 3)

    def states(self) -> Floats:
        """Return (m, 6) float64: where they are [m, rad], velocities and spins."""
        return self._bodies(_STATE, 6)

    def write_poses(self, poses: Floats) -> None:
        """Set where all bodies are, and their angles, (m, 3) float64."""
        self._written.set_float_buf(np.ascontiguousarray(poses))
        batch.set_space_bodies(self._space, _POSE, self._written)

    def write_twists(self, twists: Floats) -> None:
        """Set the velocities and spins of all bodies, (m, 3) float64."""
        self._written.set_float_buf(np.ascontiguousarray(twists))
        batch.set_space_bodies(self._space, _TWIST, self._written)

    def write_states(self, states: Floats) -> None:
        """Set all bodies, (m, 6) float64."""
        self._written.set_float_buf(states)
        batch.set_space_bodies(self._space, _STATE, self._written)

    def contacts(self, fields: batch.ArbiterFields) -> tuple[Ids, Floats]:
        """Return some fields of what touches; to be used up before anything else is read."""
        self._buffer.clear()
        batch.get_space_arbiters(self._space, fields, self._buffer)
        ints = np.frombuffer(self._buffer.int_buf(), dtype=np.uint64)
        return ints, np.frombuffer(self._buffer.float_buf(), dtype=np.float64)

    def touching(self) -> Touching:
        """Return all points at which bodies touched in the last step, in no order."""
        ints, floats = self.contacts(_POINTS)
        ids, floats = ints.reshape(-1, 3), floats.reshape(-1, 10)
        first, second = ids[:, 2] > 0, ids[:, 2] > 1
        # On either body; the second point comes behind all first ones.
        ones = (floats[first, 2:4] + floats[first, 4:6]) / 2
        others = (floats[second, 6:8] + floats[second, 8:10]) / 2
        return Touching(
            bodies=np.concatenate((ids[first, :2], ids[second, :2])),
            points=np.concatenate((ones, others)),
            normals=np.concatenate((floats[first, :2], floats[second, :2])),
        )

    def _bodies(self, fields: batch.BodyFields, width: int) -> Floats:
        self._buffer.clear()
        batch.get_space_bodies(self._space, fields, self._buffer)
        numbers = np.frombuffer(self._buffer.float_buf(), dtype=np.float64)
        return numbers.reshape(-1, width).copy()
