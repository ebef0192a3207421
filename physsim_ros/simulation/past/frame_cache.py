# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Frame cache: snapshots and contacts of the past, kept within a budget, replayed beyond it.

Laws: a step of the past is shown as it was the first time, to the bit; its contacts to a rounding,
since the engine lists them by address, and they are summed in that order. A replay that ends with
another digest than the checkpoint there is reported.

A rewind through cached frames, or a seek to one, costs nothing. Beyond them, a segment, the frames
between two checkpoints, is replayed forward while the segment after it is shown backward.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from physsim_ros.model.snapshot import Contacts, Snapshot
from physsim_ros.simulation.past.history_memory import HistoryMemory
from physsim_ros.simulation.past.memory_size import frame_size, scene_size
from physsim_ros.simulation.past.replay import Replay
from physsim_ros.simulation.past.tree import Keyframe

# Greatest memory of a body in a frame, on average of all frames [bytes]: a pose.
_BODY = 24


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


class FrameCache:
    """
    The cached frames of a history.

    :param replay: in a world of its own, of the history of the frames
    :param memory: with the greatest memory of frames; for few bodies it is less: a pose of each
        body in each frame of the history

    :ivar size: memory that the frames take [bytes]
    """

    def __init__(self, replay: Replay, memory: HistoryMemory) -> None:
        # The world of the replay makes the segment which is shown next in a rewind.
        self._replay = replay
        self._history = replay.history
        self._frame_steps = replay.world.frame_steps
        self._memory = memory
        self.size = 0
        # The frames by step, and their steps in the order of time.
        self._frames: dict[int, CachedFrame] = {}
        self._steps: list[int] = []
        # Number of frames of each scene, whose memory is counted once.
        self._scenes: Counter[int] = Counter()
        # The step that is shown.
        self._shown = 0
        # Number of bodies in the last frame.
        self._bodies = 0
        self._segment: SegmentReplay | None = None

    def snapshots(self, end: int, count: int) -> list[Snapshot]:
        """
        Return the last cached snapshots up to a step, in the order of time.

        :param end: the step
        :param count: greatest number of snapshots
        """
        steps = self._steps[: bisect_right(self._steps, end)]
        return [self._frames[step].snapshot for step in steps[-count:]]

    def add_frame(self, frame: CachedFrame) -> None:
        """Add a frame that has just been shown; to a history without length none is added."""
        if not self._history.length:
            return
        self._bodies = len(frame.snapshot.poses)
        self._add(frame)
        self._evict(frame.snapshot.step)

    def with_first_contacts(self, frame: CachedFrame) -> CachedFrame:
        """Return a frame with the contacts of its cached frame, if that shows the same poses."""
        old = self._frames.get(frame.snapshot.step)
        if old is None or old.contacts is None or not _same(old.snapshot, frame.snapshot):
            return frame
        return CachedFrame(frame.snapshot, old.contacts)

    def drop_from(self, step: int) -> list[CachedFrame]:
        """Drop the frames from a step on, and return them in the order of time."""
        self._segment = None
        return self._drop(bisect_left(self._steps, step), len(self._steps))

    def cached_frame(self, step: int) -> CachedFrame | None:
        """Return the cached frame of a step; None if it is not cached, or not in the history."""
        if self._history.oldest <= step <= self._history.head and self._is_cached(step):
            return self._frames[step].copy()
        return None

    def frame_at(self, step: int, is_overdue: Callable[[], bool]) -> CachedFrame | None:
        """
        Return the frame of a step, cached or replayed.

        :param is_overdue: whether its replay is to continue in another call
        :return: None until its replay is done
        """
        if not self._is_cached(step):
            _, end = self._history.segment(step)
            stride = self._frame_steps if step == end or step % self._frame_steps == 0 else 1
            self._replay_segment(step, stride, 1, is_overdue)
            self._evict(step)
        return self.cached_frame(step)

    def replay_ahead(
        self, step: int, steps: int, is_overdue: Callable[[], bool], *, fine: bool
    ) -> None:
        """
        Replay some of the steps that a rewind shows later, so that no frame has to wait.

        :param step: the step that is shown
        :param steps: from that to the step that is shown next
        :param is_overdue: whether the replay is to continue in another call
        :param fine: whether every step is shown
        """
        stride = 1 if fine else self._frame_steps
        # At whole speeds all frames but the first, which may be shorter, go by as many steps.
        apart = 1 if fine else -(-steps // stride) * stride
        before = self._begin_of_segments(step)
        missing = (at for at in range(step - apart, before, -apart) if not self._is_cached(at))
        gap = next(missing, None)
        if gap is not None:
            self._replay_segment(gap, stride, max(1, (step - gap) // max(1, steps)), is_overdue)
            self._evict(step)

    def _is_cached(self, step: int) -> bool:
        """Return whether the frame of a step is cached, with contacts if they are reported."""
        frame, with_contacts = self._frames.get(step), self._replay.world.reports_contacts
        return frame is not None and not (frame.contacts is None and with_contacts)

    def _begin_of_segments(self, step: int) -> int:
        """Return the first step of the segment before that of a step."""
        keyframe, _ = self._history.segment(step)
        before, _ = self._history.segment(keyframe.step)
        return before.step

    def _replay_segment(
        self, step: int, stride: int, calls: int, is_overdue: Callable[[], bool]
    ) -> None:
        """
        Replay the segment of a step; at its end its frames replace those that were cached.

        :param stride: steps from one frame to the next
        :param calls: number of calls in which the replay is to end
        :param is_overdue: whether it is to continue in another call
        """
        keyframe, end = self._history.segment(step)
        replay = self._segment
        if replay is None or not replay.suits(keyframe, end, stride):
            replay = self._segment = SegmentReplay(self._replay, keyframe, end, stride)
        replay.replay_steps(-(-replay.steps_left // calls), is_overdue)
        if replay.steps_left == 0:
            self._segment = None
            # The frame at its keyframe is the last one of the segment before, if there is one.
            begin = keyframe.step
            if begin == self._history.keyframes[0].step and not self._is_cached(begin):
                begin -= 1
            self._drop(bisect_right(self._steps, begin), bisect_right(self._steps, end))
            for frame in replay.frames:
                if frame.snapshot.step > begin:
                    self._add(frame)

    def _add(self, frame: CachedFrame) -> None:
        """Add a frame, in place of the one of the same step."""
        step, scene = frame.snapshot.step, frame.snapshot.scene
        place = bisect_left(self._steps, step)
        if step in self._frames:
            self._drop(place, place + 1)
        self._frames[step] = frame.copy()
        self._steps.insert(place, step)
        self._scenes[id(scene)] += 1
        self.size += frame_size(*frame)
        if self._scenes[id(scene)] == 1:
            self.size += scene_size(scene)

    def _drop(self, begin: int, end: int) -> list[CachedFrame]:
        """Drop and return the frames from one place to another in the order of time."""
        dropped = [self._frames.pop(step) for step in self._steps[begin:end]]
        del self._steps[begin:end]
        for frame in dropped:
            scene = frame.snapshot.scene
            self._scenes[id(scene)] -= 1
            self.size -= frame_size(*frame)
            if not self._scenes[id(scene)]:
                del self._scenes[id(scene)]
                self.size -= scene_size(scene)
        return dropped

    def _evict(self, step: int) -> None:
        """Drop the frames before the history, and more until all fit."""
        self._shown = step
        self._drop(0, bisect_left(self._steps, self._history.keyframes[0].step))
        poses = self._history.length // self._frame_steps * self._bodies
        budget = min(self._memory.frame_limit, poses * _BODY)
        while self.size > budget and self.drop_oldest():
            pass

    def drop_oldest(self) -> bool:
        """
        Drop a frame: the last one, if it lies after the segment that is shown, else the first.

        A rewind shows the frames before the step; playback adds those after it again. The frames
        of the segment that is shown, and of the one that a rewind shows next, are kept.

        :return: whether there was one
        """
        _, end = self._history.segment(self._shown)
        if self._steps and self._steps[-1] > end:
            self._drop(len(self._steps) - 1, len(self._steps))
        elif self._steps and self._steps[0] < self._begin_of_segments(self._shown):
            self._drop(0, 1)
        else:
            return False
        return True


def _same(one: Snapshot, other: Snapshot) -> bool:
    """Return whether two snapshots have the same bodies at the same poses."""
    return one.scene.names == other.scene.names and np.array_equal(one.poses, other.poses)


class SegmentReplay:
    """
    The replay of a segment, each step with the requests with which it was shown.

    :param replay: makes the steps
    :param keyframe: at which it begins
    :param end: its last step
    :param stride: steps from one frame to the next

    :ivar frames: that were made, in the order of time
    """

    def __init__(self, replay: Replay, keyframe: Keyframe, end: int, stride: int) -> None:
        self.frames: list[CachedFrame] = []
        self._replay = replay
        self._end = end
        self._stride = stride
        self._is_of = keyframe, replay.world.reports_contacts
        replay.resume(keyframe)
        replay.replay_shown(keyframe.step)
        # The step may have been shown without the requests before the keyframe.
        if replay.serial == replay.history.serial_shown_at(keyframe.step):
            self._add_frame()

    def suits(self, keyframe: Keyframe, end: int, stride: int) -> bool:
        """Return whether it has the frames of a stride from a keyframe to a step."""
        is_of = keyframe, self._replay.world.reports_contacts
        return self._is_of == is_of and self._end == end and self._stride <= stride

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
        self.frames.append(
            CachedFrame(snapshot, world.contacts(snapshot) if world.reports_contacts else None)
        )
