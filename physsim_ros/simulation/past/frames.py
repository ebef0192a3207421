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

from bisect import bisect_left, bisect_right, insort
from collections.abc import Iterator
from itertools import chain, islice
from typing import NamedTuple

import numpy as np
from physsim_ros.model.sizes import frame_size
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.runtime.slices import finish
from physsim_ros.simulation.past.cursor import Replay
from physsim_ros.simulation.past.line import CachedFrame, Keyframe, LineInForce
from physsim_ros.simulation.past.tree import Budget
from physsim_ros.simulation.world import World

# Share of the budget for frames [1]: 64 MB of 256, three minutes of 100 bodies. More saves little,
# since a rewind replays ahead of the frame that is shown.
_SHARE = 1 / 4
# Greatest memory of a body in a frame, on average of all frames [bytes]: a pose.
_BODY = 24
# Share of its limit that the cache has after it has dropped frames [1], which it does seldom so.
_KEPT = 15 / 16


class _Segment(NamedTuple):
    """
    The replay of a segment that is under way.

    :ivar of: its first checkpoint, its last step, and whether contacts are reported
    :ivar stride: steps from one frame to the next
    :ivar beginning: slices of the way to that checkpoint
    :ivar slices: of the replay, a frame each
    """

    of: tuple[Keyframe, int, bool]
    stride: int
    beginning: Iterator[None]
    slices: Iterator[None]


class FrameCache:
    """
    The cached frames of the line in force.

    :param replay: that replays segments
    :param world: of that replay
    :param line: in force
    :param budget: of the past; for few bodies frames take less of it: a pose of each body in each
        frame

    :ivar size: memory that the frames take [bytes]
    :ivar line_number: of the line in force: each that is put in force gets the next one
    :ivar differs_from: the first step at which that line may differ from the one before
    """

    def __init__(self, replay: Replay, world: World, line: LineInForce, budget: Budget) -> None:
        self.size = 0
        self.line_number = self.differs_from = 0
        self._replay = replay
        self._world = world
        self._line = line
        self._budget = budget
        # The frames by step, and their steps in the order of time.
        self._frames: dict[int, CachedFrame] = {}
        self._steps: list[int] = []
        # The step that is shown.
        self._shown = 0
        # Number of bodies in the last frame.
        self._bodies = 0
        self._segment: _Segment | None = None

    def snapshots(self, end: int, count: int) -> list[Snapshot]:
        """
        Return the last cached snapshots up to a step, in the order of time.

        :param end: the step
        :param count: greatest number of snapshots
        """
        steps = self._steps[: bisect_right(self._steps, end)]
        return [self._frames[step].snapshot for step in steps[-count:]]

    def frames_after(self, step: int, end: int) -> list[CachedFrame]:
        """Return the cached frames after a step, up to another one, in the order of time."""
        first, last = bisect_right(self._steps, step), bisect_right(self._steps, end)
        return [self._frames[each].copy() for each in self._steps[first:last]]

    def add_frame(self, frame: CachedFrame) -> None:
        """Add a frame that has just been shown; a past without length has none."""
        if not self._line.length:
            self._drop(0, len(self._steps))
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
        """Drop the frames from a step on, where a line parts; return them in the order of time."""
        self._segment = None
        self.line_number, self.differs_from = self.line_number + 1, step
        return self._drop(bisect_left(self._steps, step), len(self._steps))

    def cached_frame(self, step: int) -> CachedFrame | None:
        """Return the cached frame of a step; None if it is not cached, or not in the past."""
        if self._line.oldest <= step <= self._line.head and self._is_cached(step):
            return self._frames[step].copy()
        return None

    def replay_to_frame(self, step: int) -> CachedFrame | None:
        """Return the frame of a step if it is cached; else replay the next frame on its way."""
        if not self._is_cached(step):
            _, end = self._line.segment(step)
            frame = self._world.frame_steps
            stride = frame if step == end or step % frame == 0 else 1
            segment = self._segment_of(step, stride)
            next(chain(segment.beginning, segment.slices), None)
            self._evict(step)
        return self.cached_frame(step)

    def replay_ahead(self, step: int, steps: int, *, fine: bool) -> Iterator[None]:
        """
        Replay some of the frames that a rewind shows later, so that no frame has to wait.

        Yield after each of them.

        :param step: the step that is shown
        :param steps: from that to the step that is shown next
        :param fine: whether every step is shown
        """
        stride = 1 if fine else self._world.frame_steps
        # At whole speeds all frames but the first, which may be shorter, go by as many steps.
        apart = 1 if fine else -(-steps // stride) * stride
        before = self._begin_of_segments(step)
        missing = (at for at in range(step - apart, before, -apart) if not self._is_cached(at))
        gap = next(missing, None)
        if gap is not None:
            segment = self._segment_of(gap, stride)
            # Not `yield from`, which would end it where this work is dropped.
            for _ in segment.beginning:
                yield
            _, end = self._line.segment(gap)
            left, calls = end - self._world.step_count, max(1, (step - gap) // max(1, steps))
            yield from islice(segment.slices, -(-left // (calls * stride)))
            self._evict(step)

    def _is_cached(self, step: int) -> bool:
        """Return whether the frame of a step is cached, with contacts if they are reported."""
        frame, with_contacts = self._frames.get(step), self._world.reports_contacts
        return frame is not None and not (frame.contacts is None and with_contacts)

    def _begin_of_segments(self, step: int) -> int:
        """Return the first step of the segment before that of a step."""
        keyframe, _ = self._line.segment(step)
        before, _ = self._line.segment(keyframe.step)
        return before.step

    def _segment_of(self, step: int, stride: int) -> _Segment:
        """
        Return the replay of the segment of a step, that under way if it suits.

        :param stride: steps from one frame to the next
        """
        keyframe, end = self._line.segment(step)
        of, segment = (keyframe, end, self._world.reports_contacts), self._segment
        if segment is None or segment.of != of or segment.stride > stride:
            slices = self._slices_of_segment(keyframe, end, stride)
            segment = _Segment(of, stride, self._slices_to(keyframe), slices)
            self._segment = segment
        return segment

    def _slices_to(self, keyframe: Keyframe) -> Iterator[None]:
        """Go to a keyframe, as its step was shown; yield after each slice."""
        yield from self._replay.slices_of_resumption(keyframe)
        yield from self._replay.slices_to_shown(keyframe.step)

    def _slices_of_segment(self, keyframe: Keyframe, end: int, stride: int) -> Iterator[None]:
        """Replay a segment from its keyframe; at its end its frames replace those cached."""
        replay, world, frames = self._replay, self._world, []
        # The step may have been shown without the requests before the keyframe.
        if replay.serial == self._line.serial_shown_at(keyframe.step):
            frames.append(self._frame())
        while (at := world.step_count) < end:
            finish(replay.slices_to_shown(min(end, at - at % stride + stride)))
            frames.append(self._frame())
            if world.step_count < end:
                yield
        replay.check_digest()
        self._segment = None
        # The frame at its keyframe is the last one of the segment before, if there is one.
        begin = keyframe.step
        if begin == self._line.keyframes[0].step and not self._is_cached(begin):
            begin -= 1
        self._drop(bisect_right(self._steps, begin), bisect_right(self._steps, end))
        for frame in frames:
            if frame.snapshot.step > begin:
                self._add(frame)

    def _frame(self) -> CachedFrame:
        snapshot, world = self._world.snapshot(), self._world
        return CachedFrame(snapshot, world.contacts(snapshot) if world.reports_contacts else None)

    def _add(self, frame: CachedFrame) -> None:
        """Add a frame, in place of the one of the same step."""
        step = frame.snapshot.step
        if step in self._frames:
            self.size -= frame_size(*self._frames[step])
        else:
            insort(self._steps, step)
        self._frames[step] = frame.copy()
        self.size += frame_size(*frame)

    def _drop(self, begin: int, end: int) -> list[CachedFrame]:
        """Drop and return the frames from one place to another in the order of time."""
        if begin == end:
            return []
        dropped = [self._frames.pop(step) for step in self._steps[begin:end]]
        del self._steps[begin:end]
        self.size -= sum(frame_size(*frame) for frame in dropped)
        return dropped

    def _evict(self, step: int) -> None:
        """Drop the frames that are no longer kept, and more until all fit."""
        self._shown = step
        line, frame = self._line, self._world.frame_steps
        self._drop(0, bisect_left(self._steps, line.keyframes[0].step))
        poses = line.length // frame * self._bodies
        limit = min(self._budget.size * _SHARE, poses * _BODY)
        if self.size > limit:
            self.shrink(limit * _KEPT)

    def shrink(self, size: float) -> None:
        """
        Drop frames: the last ones that lie after the segment that is shown, then the first ones.

        A rewind shows the frames before the step; playback adds those after it again. The frames
        of the segment that is shown, and of the one that a rewind shows next, are kept.

        :param size: memory that the others may take [bytes]
        """
        begin, (_, end) = self._begin_of_segments(self._shown), self._line.segment(self._shown)
        while self.size > size and self._steps:
            if self._steps[-1] > end:
                self._drop(len(self._steps) - 1, len(self._steps))
            elif self._steps[0] < begin:
                self._drop(0, 1)
            else:
                return


def _same(one: Snapshot, other: Snapshot) -> bool:
    """Return whether two snapshots have the same bodies at the same poses."""
    return one.scene.names == other.scene.names and np.array_equal(one.poses, other.poses)
