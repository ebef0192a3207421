# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A segment: the frames between two checkpoints, which a rewind shows.

Law: frames are replayed forward from the first checkpoint, each step with the requests with which
it was shown; a replay that ends with another digest than the second checkpoint is reported.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import NamedTuple

from physsim_ros.model.scene import Scene
from physsim_ros.model.snapshot import Contacts, Snapshot
from physsim_ros.simulation.past.memory_size import frame_size, scene_size
from physsim_ros.simulation.past.replay import Replay
from physsim_ros.simulation.past.tree import Keyframe


class CachedFrame(NamedTuple):
    """
    The state after a step, as it was shown.

    :ivar snapshot: of the world
    :ivar contacts: since the frame before; None if contacts were not reported
    """

    snapshot: Snapshot
    contacts: Contacts | None

    def copy(self) -> CachedFrame:
        """Return a copy whose snapshot has no cached properties."""
        return self._replace(snapshot=replace(self.snapshot))


def size_of_frames(frames: Iterable[CachedFrame]) -> int:
    """Return the memory of frames [bytes], each scene counted once."""
    frames = list(frames)
    scenes = {id(frame.snapshot.scene): frame.snapshot.scene for frame in frames}
    size = sum(frame_size(*frame) for frame in frames)
    return size + sum(map(scene_size, scenes.values()))


class FrameSegment:
    """
    The frames between two checkpoints.

    :ivar frames: by step
    :ivar size: memory of the frames [bytes]
    """

    def __init__(self) -> None:
        self.frames: dict[int, CachedFrame] = {}
        self.size = 0
        # The scene of the frame that was added last.
        self._scene: Scene | None = None

    def add(self, frame: CachedFrame) -> None:
        """Add a frame, in place of the one of the same step."""
        replaced = frame.snapshot.step in self.frames
        self.frames[frame.snapshot.step] = frame.copy()
        if replaced:
            self.size = size_of_frames(self.frames.values())
            return
        self.size += frame_size(*frame)
        if frame.snapshot.scene is not self._scene:
            self._scene = frame.snapshot.scene
            self.size += scene_size(self._scene)

    def pop_from(self, step: int) -> list[CachedFrame]:
        """Drop the frames from a step on, and return them."""
        popped = [self.frames.pop(each) for each in [*self.frames] if each >= step]
        if popped:
            self.size = size_of_frames(self.frames.values())
        return popped


class SegmentReplay:
    """
    The replay of a segment.

    :param replay: makes the steps
    :param keyframe: at which it begins
    :param end: its last step
    :param stride: steps from one frame to the next
    """

    def __init__(self, replay: Replay, keyframe: Keyframe, end: int, stride: int) -> None:
        self.keyframe = keyframe
        self.segment = FrameSegment()
        self._replay = replay
        self._end = end
        self._stride = stride
        replay.resume(keyframe)
        replay.replay_shown(keyframe.step)
        # The step may have been shown without the requests before the keyframe.
        if replay.serial == replay.history.serial_shown_at(keyframe.step):
            self._add_frame()

    def suits(self, keyframe: Keyframe, end: int, stride: int) -> bool:
        """Return whether it has the frames of a stride from a keyframe to a step."""
        return self.keyframe == keyframe and self._end == end and self._stride <= stride

    @property
    def steps_left(self) -> int:
        """Return how many steps remain."""
        return self._end - self._replay.world.step_count

    def replay_steps(self, steps: int, is_overdue: Callable[[], bool]) -> None:
        """Make a number of steps, at most those that remain, until it is overdue."""
        replay = self._replay
        goal = min(self._end, replay.world.step_count + steps)
        while (at := replay.world.step_count) < goal:
            stop = min(self._end, at - at % self._stride + self._stride)
            replay.replay_shown(stop)
            self._add_frame()
            if is_overdue():
                break
        if self.steps_left == 0:
            replay.check_digest()

    def _add_frame(self) -> None:
        world = self._replay.world
        snapshot = world.snapshot()
        self.segment.add(
            CachedFrame(snapshot, world.contacts(snapshot) if world.reports_contacts else None)
        )
