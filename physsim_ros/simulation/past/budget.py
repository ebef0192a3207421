# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The budget of the past in bytes, and the sizes of what is kept.

Law: arrays count by their `nbytes`; requests, shapes and names by a constant each, which is good
to a factor of two. When the budget is spent, `Past` drops the oldest entries.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from physsim_ros.model.checkpoint import Checkpoint
from physsim_ros.model.checks import Within
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
from physsim_ros.model.snapshot import Answer, Contacts, Snapshot

# Bytes of a megabyte.
MEGABYTE = 10**6
# Least and greatest budget [MB]: a second of a few hundred commands; a large machine.
LEAST_MEMORY, MOST_MEMORY = 1.0, 1e6
# Default budget [MB].
DEFAULT_MEMORY = 256.0
# Share of the budget from which the requests after a checkpoint make the next one due [1], so that
# the history has at least eight parts that can be dropped.
_LOG_SHARE = 1 / 8
# Share of the budget for frames [1]: 64 MB of 256, three minutes of 100 bodies. More saves little,
# since a rewind replays ahead of the frame that is shown.
_FRAME_SHARE = 1 / 4
# Share of the budget below which the next loss is reported again [1].
_RELIEF = 1 / 2

# Memory of a request, of the description of a body or joint, and of a piece or vertex of a shape
# [bytes], measured with tracemalloc on CPython 3.11.
_REQUEST, _BODY, _VERTEX = 800, 1200, 150
# A name of a body in a list; names are in memory once.
_NAME = 8
# A checkpoint and a frame beside their arrays, and a body or joint in a scene.
_CHECKPOINT, _FRAME, _PLACE = 2000, 1000, 50


def request_size(request: Request) -> int:
    """Return the memory of a request [bytes]."""
    match request:
        case Command(names=names):
            return _REQUEST + request.nbytes + _NAME * len(names)
        case Spawn(shape=shape):
            return _REQUEST + _BODY + _shape_size(shape)
        case ChangeBody():
            return _REQUEST + _BODY
        case MoveBodies(names=names) | DeleteBodies(names=names):
            return _REQUEST + _NAME * len(names)
        case Restore(state=state):
            size = sum(_REQUEST + _BODY + _shape_size(each.body.shape) for each in state.bodies)
            impulses = 0 if state.memory is None else state.memory.nbytes
            return _REQUEST + size + _BODY * len(state.joints) + impulses
    return _REQUEST


def checkpoint_size(checkpoint: Checkpoint, before: Checkpoint | None) -> int:
    """
    Return the memory of a checkpoint [bytes].

    :param before: the checkpoint before it, with which it may share the scene
    """
    size = _CHECKPOINT + checkpoint.nbytes
    if before is None or before.scene is not checkpoint.scene:
        # The digest of a checkpoint makes the key of the scene.
        size += scene_size(checkpoint.scene) + len(checkpoint.scene.key)
    return size


def frame_size(snapshot: Snapshot, contacts: Contacts | None) -> int:
    """Return the memory of a frame without its scene [bytes]."""
    return _FRAME + snapshot.nbytes + (0 if contacts is None else contacts.nbytes)


def scene_size(scene: Scene) -> int:
    """Return the memory of a scene [bytes]; its bodies and joints are those of requests."""
    return _REQUEST + _PLACE * (len(scene.bodies) + len(scene.joints))


def frames_size(frames: Iterable[tuple[Snapshot, Contacts | None]]) -> int:
    """Return the memory of frames [bytes], each scene counted once."""
    frames = list(frames)
    scenes = {id(snapshot.scene): snapshot.scene for snapshot, _ in frames}
    return sum(frame_size(*frame) for frame in frames) + sum(map(scene_size, scenes.values()))


def _shape_size(shape: Shape) -> int:
    pieces = shape.form.pieces
    vertices = sum(len(each.vertices) for each in pieces if isinstance(each, Convex))
    return _VERTEX * (3 * len(pieces) + vertices + len(getattr(shape, 'outline', ())))


class Budget:
    """
    The budget of the past.

    :param megabytes: the budget [MB]
    :raises BadProperty: it is out of range
    :raises Malformed: it is not a finite number

    :ivar used: memory of the past at the last count [bytes]
    """

    def __init__(self, megabytes: float) -> None:
        self.used = 0
        self.megabytes = megabytes

    @property
    def megabytes(self) -> float:
        """Return the budget [MB]."""
        return self._megabytes

    @megabytes.setter
    def megabytes(self, megabytes: float) -> None:
        self._megabytes = Within(LEAST_MEMORY, MOST_MEMORY, 'MB')(megabytes, 'history_memory')
        self._told = False

    @property
    def size(self) -> int:
        """Return the budget [bytes]."""
        return round(self._megabytes * MEGABYTE)

    @property
    def in_megabytes(self) -> tuple[float, float]:
        """Return the memory of the past at the last count, and the budget [MB]."""
        return self.used / MEGABYTE, self._megabytes

    @property
    def log_limit(self) -> int:
        """Return the memory of requests from which a checkpoint is due [bytes]."""
        return round(self.size * _LOG_SHARE)

    @property
    def frame_limit(self) -> int:
        """Return the budget of frames [bytes]."""
        return round(self.size * _FRAME_SHARE)

    def fit(self, used: Callable[[], int], kinds: Sequence[Callable[[], object]]) -> bool:
        """
        Drop the oldest entries until everything fits.

        :param used: returns the memory of the past [bytes]
        :param kinds: functions that drop the oldest entry of a kind, and return whether there was
            one; in their order, the first for frames that a replay makes again
        :return: whether other entries than frames were lost; once, until less than half of the
            budget is used
        """
        self.used = used()
        self._told = self._told and self.used > _RELIEF * self.size
        lost = False
        for drop in kinds:
            while self.used > self.size and drop():
                self.used = used()
                lost |= drop != kinds[0]
        news = lost and not self._told
        self._told |= lost
        return news

    def report(self, oldest: float) -> Answer:
        """
        Return the event that the past was shortened.

        :param oldest: oldest time of the course in force that is kept [s]
        """
        message = (
            f'the past would take more than {self._megabytes:g} MB (history_memory): the oldest '
            f'goes, {oldest:.3f} s is the oldest that is kept'
        )
        return Answer(topic='history', message=message, code='history')
