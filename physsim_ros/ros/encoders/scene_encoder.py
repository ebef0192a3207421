# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Encoders whose template holds as long as the scene, and the poses that several streams have."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import lru_cache

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.ros.encoders.cdr import MessageTemplate


class SceneEncoder(ABC):
    """
    Encodes the state of every body, in spawn order.

    :param frame_id: name of the world frame
    """

    def __init__(self, frame_id: str) -> None:
        self._frame_id = frame_id
        self._scene: Scene | None = None

    def encode(self, frame: Frame) -> bytes:
        """Return the serialised message of a frame."""
        snapshot = frame.snapshot
        if snapshot.scene is not self._scene:
            self._template = self._template_of(snapshot.scene)
            self._scene = snapshot.scene
        self._fill(self._template, snapshot)
        return self._template.stamped(snapshot.stamp)

    @abstractmethod
    def _template_of(self, scene: Scene) -> MessageTemplate:
        """Return the message of a scene, all numbers 0."""

    def _fill(self, template: MessageTemplate, snapshot: Snapshot) -> None:
        """Write the numbers of a snapshot into the message of its scene: at least the poses."""
        template.write_poses(pose_columns(snapshot))


# Three streams need the poses of the same frame, one after the other.
@lru_cache(maxsize=1)
def pose_columns(snapshot: Snapshot) -> tuple[Floats, ...]:
    """Return x, y [m], and z and w of the quaternion about z, (n,) float64 each."""
    x, y, yaw = snapshot.poses.T
    return x, y, np.sin(yaw / 2), np.cos(yaw / 2)
