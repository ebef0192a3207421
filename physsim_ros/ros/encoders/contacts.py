# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`~/contacts`: sensor_msgs/MultiDOFJointState, an entry for every pair of bodies that touched.

Its name is `a|b`, its transform the contact point with the x axis along the normal from a to b,
its wrench the impulse on b [N s].
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from physsim_ros.model.arrays import Ints
from physsim_ros.model.names import WORLD
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Frame
from physsim_ros.ros.encoders.cdr import fill_columns, padded_string
from physsim_ros.ros.encoders.states import multi_dof_template


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
        scene = snapshot.scene
        # In a pile at rest the same pairs touch in frame after frame.
        if scene is not self._scene or not np.array_equal(contacts.pairs, self._pairs):
            # Row -1, the boundary, is the last one.
            bodies = (*scene.names, WORLD)
            names = [_pair_name(bodies[a], bodies[b]) for a, b in contacts.pairs.tolist()]
            self._template = multi_dof_template(self._frame_id, names, wrenches=len(names))
            self._scene, self._pairs = scene, contacts.pairs
        x, y = contacts.normals.T
        half = np.arctan2(y, x) / 2
        self._template.write_poses((*contacts.points.T, np.sin(half), np.cos(half)))
        fill_columns(self._template.blocks[1], (0, 1), contacts.impulses.T)
        return self._template.stamped(snapshot.stamp)


# 10 MB. A dense crowd of 1000 bodies that keeps changing its neighbours fills it in minutes.
@lru_cache(maxsize=100_000)
def _pair_name(a: str, b: str) -> bytes:
    """Return the name of a pair of bodies, serialised with padding."""
    return padded_string(f'{a}|{b}')
