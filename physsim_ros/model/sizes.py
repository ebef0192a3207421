# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The memory of requests, checkpoints and frames.

Law: arrays count by their `nbytes`, all else by constants, measured with tracemalloc on CPython
3.11; a sum is good to a factor of two.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checkpoint import Checkpoint
from physsim_ros.model.declarations import Checked
from physsim_ros.model.motor_command import MotorCommand
from physsim_ros.model.requests import Request, Restore
from physsim_ros.model.scene import Body
from physsim_ros.model.shapes import Convex, Shape
from physsim_ros.model.snapshot import Contacts, Snapshot

# Memory of a value without its arrays [bytes]: a request, the description of a body or joint, a
# frame, a scene, half a checkpoint; and of a piece or vertex of a shape.
_VALUE, _VERTEX = 1200, 150
# Memory of a name in a list, since names are in memory once; and of a body or joint in a scene,
# and in each frame, many of which share one scene [bytes].
_NAME, _PLACE, _FRAME_PLACE = 8, 50, 20
# Memory of a number or name of a robot, an actor or a command of motors [bytes]: 28 in many
# lasers, 72 in many landmarks.
_ENTRY = 50


def request_size(request: Request) -> int:
    """Return the memory of a request [bytes]."""
    if isinstance(request, Restore):
        state = request.state
        bodies = [each.body for each in state.bodies]
        parts = sum(_shape_size(each.shape) + _role_size(each) for each in bodies)
        parts += _ENTRY * _entries(tuple(each.command for each in state.commands))
        impulses = 0 if state.memory is None else state.memory.nbytes
        return _VALUE * (1 + len(bodies) + len(state.joints)) + parts + impulses
    return _VALUE + sum(map(_field_size, request.explicit().values()))


def _field_size(value: object) -> int:
    """Return the memory of a field of a request, beyond that of every request [bytes]."""
    match value:
        case np.ndarray():
            return value.nbytes
        case (str(), *_):
            return _NAME * len(value)
        case tuple():
            return sum(map(_field_size, value))
        case Request():
            return request_size(value)
        case MotorCommand():
            return _ENTRY * _entries(value)
        case Properties():
            return _role_size(value)
    return _shape_size(value) if isinstance(value, Shape) else 0


def checkpoint_size(checkpoint: Checkpoint, before: Checkpoint | None) -> int:
    """
    Return the memory of a checkpoint [bytes].

    :param before: the checkpoint before it, with which it may share the scene
    """
    scene = checkpoint.scene
    size = 2 * _VALUE + checkpoint.nbytes
    if before is None or before.scene is not scene:
        # The digest of a checkpoint makes the key of the scene.
        size += _VALUE + _PLACE * (len(scene.bodies) + len(scene.joints)) + len(scene.key)
    return size


def frame_size(snapshot: Snapshot, contacts: Contacts | None) -> int:
    """Return the memory of a frame [bytes]."""
    places = len(snapshot.scene.bodies) + len(snapshot.scene.joints)
    arrays = snapshot.nbytes + (0 if contacts is None else contacts.nbytes)
    return _VALUE + _FRAME_PLACE * places + arrays


def _shape_size(shape: Shape) -> int:
    pieces = shape.form.pieces
    vertices = sum(len(each.vertices) for each in pieces if isinstance(each, Convex))
    return _VERTEX * (3 * len(pieces) + vertices + len(getattr(shape, 'outline', ())))


def _role_size(body: Properties | Body) -> int:
    """Return the memory of what makes a body a robot or an actor [bytes]."""
    roles = (role for role in (body.robot, body.actor) if role is not None)
    return _ENTRY * sum(map(_entries, roles))


def _entries(value: object) -> int:
    """Return the count of the numbers and names of a value."""
    if isinstance(value, Checked):
        return sum(map(_entries, value.explicit().values()))
    return sum(map(_entries, value)) if isinstance(value, tuple) else 1
