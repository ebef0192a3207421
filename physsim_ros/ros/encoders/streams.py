# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Encoders of the streams of numbers: states, poses, transforms, contacts, and the clock.

Law: bytes are those of rclpy. A template holds as long as the scene; of each frame only numbers
are written into it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import lru_cache

import numpy as np
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.names import PAIR_SEPARATOR, WORLD
from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.ros.encoders.cdr import (
    CdrWriter,
    fill_columns,
    MessageTemplate,
    padded_string,
    START,
)


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


# Doubles of a planar twist that are not always 0: vx, vy and the angular velocity.
_TWIST_COLUMNS = (0, 1, 5)


class StatesEncoder(SceneEncoder):
    """Encodes name, pose and twist [m/s, rad/s] of every body."""

    def _template_of(self, scene: Scene) -> MessageTemplate:
        names = [padded_string(name) for name in scene.names]
        return multi_dof_template(self._frame_id, names, twists=len(names))

    def _fill(self, template: MessageTemplate, snapshot: Snapshot) -> None:
        super()._fill(template, snapshot)
        fill_columns(template.blocks[0], _TWIST_COLUMNS, snapshot.twists.T)


def multi_dof_template(
    frame_id: str, names: list[bytes], *, twists: int = 0, wrenches: int = 0
) -> MessageTemplate:
    """
    Return a sensor_msgs/MultiDOFJointState; its blocks are twists and wrenches.

    :param frame_id: name of the world frame
    :param names: of the entries, serialised with padding
    :param twists: number of twists
    :param wrenches: number of wrenches
    """
    writer = CdrWriter(START)
    writer.header(frame_id)
    writer.ints(len(names))
    writer.data += b''.join(names)
    writer.ints(len(names))
    writer.pose(len(names))
    writer.block(twists, 6)
    writer.block(wrenches, 6)
    return MessageTemplate(writer)


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
    return padded_string(f'{a}{PAIR_SEPARATOR}{b}')


class PosesEncoder(SceneEncoder):
    """Encodes the pose of every body: position of its origin [m] and quaternion."""

    def _template_of(self, scene: Scene) -> MessageTemplate:
        writer = CdrWriter(START)
        writer.header(self._frame_id)
        writer.ints(len(scene.bodies))
        writer.pose(len(scene.bodies))
        return MessageTemplate(writer)


class TransformsEncoder(SceneEncoder):
    """Encodes the pose of every body as a transform, whose child frame is the body's name."""

    def _template_of(self, scene: Scene) -> MessageTemplate:
        writer = CdrWriter(START)
        writer.ints(len(scene.names))
        for name in scene.names:
            writer.header(self._frame_id)
            writer.text(name)
            writer.pose()
        return MessageTemplate(writer)


# The type UPDATE, and no markers.
_UPDATE, _NO_MARKERS = b'\1', 0


class InteractivePosesEncoder(SceneEncoder):
    """
    Encodes the poses of all bodies as those of interactive markers.

    :param frame_id: name of the world frame
    :param server: that the update names

    :ivar number: of the next update
    """

    def __init__(self, frame_id: str, server: str) -> None:
        super().__init__(frame_id)
        self.number = 0
        self._server = server

    def _template_of(self, scene: Scene) -> MessageTemplate:
        writer = CdrWriter(START)
        writer.text(self._server)
        writer.align(8)
        self._number_at = len(writer.data) // 8
        writer.doubles(0.0)
        writer.data += _UPDATE
        writer.ints(_NO_MARKERS, len(scene.names))
        for name in scene.names:
            writer.header(self._frame_id)
            writer.pose()
            writer.text(name)
        # No names of bodies that are gone.
        writer.ints(0)
        return MessageTemplate(writer)

    def _fill(self, template: MessageTemplate, snapshot: Snapshot) -> None:
        super()._fill(template, snapshot)
        template.doubles.view(np.int64)[self._number_at] = self.number


class ClockEncoder:
    """
    Encodes simulation time; nothing before the first step.

    A node that uses simulation time takes 0 for a clock that has not begun. A world that comes
    back to its beginning sends 1 ns instead.
    """

    def __init__(self) -> None:
        self._began = False
        writer = CdrWriter(START)
        writer.stamp()
        self._template = MessageTemplate(writer)

    def encode(self, frame: Frame) -> bytes | None:
        """Return the serialised message of a frame; None before the first step."""
        stamp = frame.snapshot.stamp
        self._began = self._began or stamp > 0
        return self._template.stamped(max(1, stamp)) if self._began else None
