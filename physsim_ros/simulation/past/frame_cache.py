# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Frame cache: snapshots and contacts of the past, kept within a budget, replayed beyond it.

Law: a step of the past is shown as it was the first time, to the bit; its contacts to a rounding,
since the engine lists them by address, and they are summed in that order.

A rewind through cached frames, or a seek to one, costs nothing. Beyond them, the segment between
two checkpoints is replayed forward while the segment after it is shown backward.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from physsim_ros.model.snapshot import Answer, Snapshot
from physsim_ros.simulation.past.frame_segment import CachedFrame, FrameSegment, SegmentReplay
from physsim_ros.simulation.past.history import History
from physsim_ros.simulation.past.replay import Replay
from physsim_ros.simulation.past.tree import Keyframe
from physsim_ros.simulation.world import World

# Segments that are kept whatever their memory: the one that is shown, and the one that is shown
# next.
_LEAST_SEGMENTS = 2
# Greatest memory of a body in a frame, on average of all frames [bytes]: a pose.
_BODY = 24


class FrameCache:
    """
    The cached frames of a history.

    :param history: with the keyframes between which frames are replayed
    :param physics_rate: of its world [Hz]
    :param frame_steps: steps from one frame to the next at whole speeds
    :param budget: greatest memory [bytes]; for few bodies it is less: a pose of each body in each
        frame of the history

    :ivar size: memory that the frames take [bytes]
    """

    def __init__(
        self, history: History, *, physics_rate: float, frame_steps: int, budget: int
    ) -> None:
        self._history = history
        self._frame_steps = frame_steps
        self.budget = budget
        self.size = 0
        self._segments: dict[Keyframe, FrameSegment] = {}
        # The first keyframe of the history when segments before it were dropped last.
        self._first = history.keyframes[0].moment
        # The step that is shown.
        self._shown = 0
        # Number of bodies in the last frame.
        self._bodies = 0
        # The world that replays the segment which is shown next in a rewind.
        self._replay = Replay(World(physics_rate=physics_rate, frame_steps=frame_steps), history)
        self._segment_replay: SegmentReplay | None = None

    def take_answers(self) -> list[Answer]:
        """Return the reports of replays since the last call."""
        return self._replay.take_answers()

    def snapshots(self, end: int, count: int) -> list[Snapshot]:
        """
        Return the last cached snapshots up to a step, in the order of time.

        :param end: the step
        :param count: greatest number of snapshots
        """
        frames: dict[int, CachedFrame] = {}
        for keyframe in sorted(self._segments, key=lambda keyframe: keyframe.moment, reverse=True):
            for step, frame in self._segments[keyframe].frames.items():
                if step <= end:
                    # The step between two segments is in both.
                    frames.setdefault(step, frame)
            if len(frames) >= count:
                break
        return [frames[step].snapshot for step in sorted(frames)[-count:]]

    def add_frame(self, frame: CachedFrame) -> None:
        """Add a frame that has just been shown."""
        self._bodies = len(frame.snapshot.poses)
        keyframe, _ = self._history.segment(frame.snapshot.step)
        segment = self._segments.setdefault(keyframe, FrameSegment())
        before = segment.size
        segment.add(frame)
        self.size += segment.size - before
        self._evict(frame.snapshot.step)

    def with_first_contacts(self, frame: CachedFrame) -> CachedFrame:
        """Return a frame with the contacts of its cached frame, if that shows the same poses."""
        step = frame.snapshot.step
        keyframe, _ = self._history.segment(step)
        old = self._segments[keyframe].frames.get(step) if keyframe in self._segments else None
        if old is None or old.contacts is None or not _same(old.snapshot, frame.snapshot):
            return frame
        return CachedFrame(frame.snapshot, old.contacts)

    def drop_from(self, step: int) -> list[CachedFrame]:
        """Drop the frames from a step on, and return them."""
        self._segment_replay = None
        dropped: list[CachedFrame] = []
        for keyframe in [keyframe for keyframe in self._segments if keyframe.step >= step]:
            dropped += self._segments.pop(keyframe).frames.values()
        for segment in self._segments.values():
            dropped += segment.pop_from(step)
        self._count_size()
        return dropped

    @property
    def reports_contacts(self) -> bool:
        """Return whether frames without contacts are replayed, to have them."""
        return self._replay.world.reports_contacts

    @reports_contacts.setter
    def reports_contacts(self, reports_contacts: bool) -> None:
        if reports_contacts != self.reports_contacts:
            self._replay.world.reports_contacts = reports_contacts
            self._segment_replay = None

    def cached_frame(self, step: int) -> CachedFrame | None:
        """Return the cached frame of a step; None if it is not cached, or not in the history."""
        if not self._history.oldest <= step <= self._history.head:
            return None
        keyframe, _ = self._history.segment(step)
        frame = self._cached(keyframe, step)
        return None if frame is None else frame.copy()

    def frame_at(self, step: int, is_overdue: Callable[[], bool]) -> CachedFrame | None:
        """
        Return the frame of a step, cached or replayed.

        :param is_overdue: whether its replay is to continue in another call
        :return: None until its replay is done
        """
        cached = self.cached_frame(step)
        if cached is not None:
            return cached
        keyframe, end = self._history.segment(step)
        stride = self._frame_steps if step == end or step % self._frame_steps == 0 else 1
        replay = self._begin_segment(keyframe, end, stride)
        replay.replay_steps(end - keyframe.step, is_overdue)
        if replay.steps_left:
            return None
        self._keep_replayed(keyframe, replay.segment)
        self._evict(step)
        return replay.segment.frames[step].copy()

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
        gap = self._missing_step(step, apart)
        if gap is None:
            return
        keyframe, end = self._history.segment(gap)
        replay = self._begin_segment(keyframe, end, stride)
        frames_left = max(1, (step - gap) // max(1, steps))
        replay.replay_steps(-(-replay.steps_left // frames_left), is_overdue)
        if replay.steps_left == 0:
            self._keep_replayed(keyframe, replay.segment)
            self._evict(step)

    def _cached(self, keyframe: Keyframe, step: int) -> CachedFrame | None:
        """Return the frame of a step of a segment, if it is cached, with contacts if need be."""
        segment = self._segments.get(keyframe)
        frame = None if segment is None else segment.frames.get(step)
        lacks_contacts = frame is not None and frame.contacts is None and self.reports_contacts
        return None if lacks_contacts else frame

    def _missing_step(self, step: int, apart: int) -> int | None:
        """
        Return the last step before another that is not cached, in its segment and the one before.

        :param step: the other step
        :param apart: from one step that is shown to the next
        :return: None if all are cached
        """
        keyframe, _ = self._history.segment(step)
        before, _ = self._history.segment(keyframe.step)
        for number in range(step - apart, before.step, -apart):
            if self._cached(keyframe if number > keyframe.step else before, number) is None:
                return number
        return None

    def _begin_segment(self, keyframe: Keyframe, end: int, stride: int) -> SegmentReplay:
        """Begin the replay of a segment, or return the one under way if it is suitable."""
        replay = self._segment_replay
        if replay is None or not replay.suits(keyframe, end, stride):
            replay = self._segment_replay = SegmentReplay(self._replay, keyframe, end, stride)
        return replay

    def _keep_replayed(self, keyframe: Keyframe, segment: FrameSegment) -> None:
        """Keep the frames of a replay that is done."""
        self._segments[keyframe] = segment
        self._segment_replay = None
        self._count_size()

    def _count_size(self) -> None:
        self.size = sum(segment.size for segment in self._segments.values())

    def _evict(self, step: int) -> None:
        """Drop the segments before the history, and the oldest ones until all fit."""
        self._shown = step
        first = self._history.keyframes[0].moment
        if first != self._first:
            self._first = first
            for keyframe in [keyframe for keyframe in self._segments if keyframe.moment < first]:
                del self._segments[keyframe]
            self._count_size()
        poses = self._history.length // self._frame_steps * self._bodies
        budget = min(self.budget, poses * _BODY)
        while self.size > budget and self.drop_oldest():
            pass

    def drop_oldest(self) -> int:
        """
        Drop a segment: the last one, if it lies after the step that is shown, else the first.

        A rewind shows the frames before the step; playback adds those after it again.

        :return: its memory [bytes]; 0 if only the segments that are always kept are left
        """
        if len(self._segments) <= _LEAST_SEGMENTS:
            return 0
        keyframes = sorted(self._segments, key=lambda keyframe: keyframe.moment)
        last = self._segments.pop(
            keyframes[-1] if keyframes[-1].step > self._shown else keyframes[0]
        )
        self.size -= last.size
        return last.size


def _same(one: Snapshot, other: Snapshot) -> bool:
    """Return whether two snapshots have the same bodies at the same poses."""
    return one.scene.names == other.scene.names and np.array_equal(one.poses, other.poses)
