# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Estimates of the memory of the past [bytes]: arrays by `nbytes`, Python objects by their number.

The constants were measured with tracemalloc on CPython 3.11; the tests compare the estimate with
tracemalloc, for requests, frames, checkpoints, branches and resets: within a fifth.
"""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache
import sys
from typing import Any

from numpy.typing import NDArray
from physsim_ros.model.checkpoint import Checkpoint, ImpulseCache, WorldState
from physsim_ros.model.requests import (
    ChangeBody,
    Command,
    DeleteBodies,
    MoveBodies,
    Request,
    Restore,
    Spawn,
)
from physsim_ros.model.scene import Scene
from physsim_ros.model.shapes import Convex, Shape
from physsim_ros.model.snapshot import Contacts, Snapshot

# A logged request with its fields and its place in the log.
_REQUEST = 600
# The body of a request, with name, colour and material.
_BODY = 1200
# A piece of a shape, and each of its vertices and of those of its outline.
_PIECE, _VERTEX = 400, 150
# A string of a few letters, and its place in a tuple.
_NAME = 70
# A checkpoint without its arrays; a wrench in it.
_CHECKPOINT, _WRENCH = 2100, 250
# A frame without its arrays; the views of its contacts.
_FRAME, _VIEWS = 870, 700
# A body in a scene: its place among bodies and names, inertia and centroid.
_PLACE = 48
# Number of tuples of names that commands of a log share: one a publisher.
_SHARED_NAMES = 16


class RequestSizes:
    """
    Sizes of requests in one log.

    Equal names of commands are in memory once: publishers command the same bodies again and again.
    """

    def __init__(self) -> None:
        self._shared_names = lru_cache(maxsize=_SHARED_NAMES)(_same_names)

    def size_of(self, request: Request) -> int:
        """Return the memory of a request; a command shares equal names of an earlier one."""
        if not isinstance(request, Command):
            return request_size(request)
        names = request.names
        request.share_names(self._shared_names(names))
        return request_size(request) + (names_size(names) if request.names is names else 0)


def _same_names(names: tuple[str, ...]) -> tuple[str, ...]:
    return names


def request_size(request: Request) -> int:
    """Return the memory of a logged request, of a command without its names."""
    match request:
        case Command():
            return _REQUEST + request.nbytes
        case Spawn(shape=shape, properties=properties):
            return _REQUEST + _BODY + _shape_size(shape) + sys.getsizeof(properties.label)
        case ChangeBody(properties=properties):
            return _REQUEST + _BODY + sys.getsizeof(properties.label)
        case MoveBodies(names=names) | DeleteBodies(names=names):
            return _REQUEST + names_size(names)
        case Restore(state=state):
            return _REQUEST + state_size(state)
    return _REQUEST


def names_size(names: tuple[str, ...]) -> int:
    """Return the memory of names."""
    return _NAME * len(names)


def state_size(state: WorldState) -> int:
    """Return the memory of a saved state."""
    shapes = sum(_shape_size(each.body.shape) for each in state.bodies)
    labels = sum(sys.getsizeof(each.body.label) for each in state.bodies)
    size = shapes + labels + (_BODY + _REQUEST) * len(state.bodies) + _BODY * len(state.joints)
    memory = state.memory
    if memory is not None:
        size += _nbytes(_memory_arrays(memory))
    return size


def checkpoint_size(checkpoint: Checkpoint, before: Checkpoint | None = None) -> int:
    """
    Return the memory of a checkpoint.

    :param before: the checkpoint before it, with which it may share the scene
    """
    memory = checkpoint.memory
    arrays = (checkpoint.state, checkpoint.free, *_memory_arrays(memory), memory.pushes)
    size = _CHECKPOINT + _nbytes((*arrays, *checkpoint.robots, *checkpoint.actors))
    size += _WRENCH * len(checkpoint.wrenches) + _NAME * len(checkpoint.unstepped)
    if before is None or before.scene is not checkpoint.scene:
        # The digest of a checkpoint makes the scene's checkpoint.
        size += scene_size(checkpoint.scene) + len(checkpoint.scene.key)
    return size


def scene_size(scene: Scene) -> int:
    """Return the memory of a scene; its bodies and joints are those of requests."""
    return _REQUEST + _PLACE * len(scene.bodies) + 80 * len(scene.joints)


def frame_size(snapshot: Snapshot, contacts: Contacts | None) -> int:
    """Return the memory of a frame, without its scene."""
    return _FRAME + snapshot.nbytes + (0 if contacts is None else _VIEWS + contacts.nbytes)


def _shape_size(shape: Shape) -> int:
    pieces = shape.form.pieces
    vertices = sum(len(each.vertices) for each in pieces if isinstance(each, Convex))
    vertices += len(getattr(shape, 'outline', ()))
    return _PIECE * len(pieces) + _VERTEX * vertices


def _memory_arrays(memory: ImpulseCache) -> tuple[NDArray[Any], ...]:
    contacts = memory.ids, memory.pairs, memory.hashes, memory.impulses
    return *contacts, memory.joints, memory.totals


def _nbytes(arrays: Iterable[NDArray[Any]]) -> int:
    return sum(array.nbytes for array in arrays)
