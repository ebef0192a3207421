# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`~/contacts`: sensor_msgs/MultiDOFJointState, an entry for every pair of bodies that touched.

Its name is `a|b`, its transform the contact point with the x axis along the normal from a to b,
its wrench the impulse on b [N s].
"""

from __future__ import annotations

import numpy as np
from physsim_ros.model.arrays import Ints
from physsim_ros.model.names import WORLD
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Frame
from physsim_ros.ros.encoders.cdr import fill_columns, padded_string
from physsim_ros.ros.encoders.scene_encoder import POSE_COLUMNS
from physsim_ros.ros.encoders.states import multi_dof_template

# The greatest number of cached names: 10 MB. A dense crowd of 1000 bodies that keeps changing its
# neighbours reaches it in minutes.
_MOST_PAIRS = 100_000


class ContactsEncoder:
    """
    Encodes the contacts of a frame.

    :param frame_id: name of the world frame
    """

    def __init__(self, frame_id: str) -> None:
        self._frame_id = frame_id
        self._scene: Scene | None = None
        self._pairs: Ints = np.empty((0, 2), np.int64)

    def encode(self, frame: Frame) -> bytes | None:
        """Return the serialised message of a frame; None where its contacts were not recorded."""
        snapshot, contacts = frame.snapshot, frame.contacts
        if contacts is None:
            return None
        renamed = snapshot.scene is not self._scene
        if renamed:
            self._names = _PairNames(snapshot.scene.names)
            self._scene = snapshot.scene
        # In a pile at rest the same pairs touch in frame after frame.
        if renamed or not np.array_equal(contacts.pairs, self._pairs):
            names = self._names.of(contacts.pairs)
            self._template = multi_dof_template(self._frame_id, names, wrenches=len(names))
            self._pairs = contacts.pairs
        transforms, _, wrenches = self._template.blocks
        x, y = contacts.normals.T
        half = np.arctan2(y, x) / 2
        rotations = np.sin(half), np.cos(half)
        fill_columns(transforms, POSE_COLUMNS, (*contacts.points.T, *rotations))
        fill_columns(wrenches, (0, 1), contacts.impulses.T)
        return self._template.stamped(snapshot.stamp)


class _PairNames(dict[int, bytes]):
    """
    A cache of serialised names of pairs of bodies, by the number of the pair.

    :param names: of the bodies of a scene
    """

    def __init__(self, names: tuple[str, ...]) -> None:
        super().__init__()
        # Row -1, the boundary, is the last one.
        self._names = (*names, WORLD)

    def __missing__(self, pair: int) -> bytes:
        first, second = divmod(pair, len(self._names))
        name = self[pair] = padded_string(f'{self._names[first]}|{self._names[second]}')
        return name

    def of(self, pairs: Ints) -> list[bytes]:
        """Return the name of each pair of rows, (m, 2) int64."""
        if len(self) > _MOST_PAIRS:
            self.clear()
        count = len(self._names)
        numbers = pairs[:, 0] * count + pairs[:, 1] % count
        return list(map(self.__getitem__, numbers.tolist()))
