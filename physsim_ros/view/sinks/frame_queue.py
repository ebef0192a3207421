# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The bounded queue of frames between the world's thread and that of a worker.

Law: a full queue drops its oldest frames, and counts them; their answers are in the next frame.
"""

from __future__ import annotations

from collections import deque
from dataclasses import replace
import threading

from physsim_ros.model.snapshot import Answer, Frame
from physsim_ros.view.frame_context import FrameContext

# The greatest number of frames in a batch, and the greatest memory of the queue [bytes].
BATCH, WAITING_BYTES = 60, 256e6
# The greatest number of waiting answers of dropped frames.
ANSWERS = 50_000


class FrameQueue:
    """
    A queue of frames.

    :param capacity: greatest number of frames

    :ivar dropped: number of frames that were dropped
    """

    def __init__(self, capacity: int) -> None:
        self._capacity = capacity
        self._lock = threading.Lock()
        self._frames: deque[Frame] = deque()
        self._answers: deque[Answer] = deque(maxlen=ANSWERS)
        self._bytes = 0
        self._context = FrameContext()
        self.dropped = 0

    def __len__(self) -> int:
        return len(self._frames)

    @property
    def has_batch(self) -> bool:
        """Whether there are frames for a batch, or half of all that there is room for."""
        return len(self) >= min(BATCH, self._capacity // 2)

    def put(self, frame: Frame, context: FrameContext) -> None:
        """Append a frame."""
        with self._lock:
            self._context = context
            self._frames.append(frame)
            self._bytes += _size(frame)
            while len(self._frames) > self._capacity or self._bytes > WAITING_BYTES:
                oldest = self._frames.popleft()
                self._bytes -= _size(oldest)
                self._answers += oldest.answers
                self.dropped += 1

    def take_batch(self) -> tuple[list[Frame], FrameContext]:
        """Return the next frames, with the answers of those that were dropped, and the context."""
        with self._lock:
            frames = [self._frames.popleft() for _ in range(min(BATCH, len(self._frames)))]
            self._bytes -= sum(map(_size, frames))
            if frames and self._answers:
                first = frames[0]
                frames[0] = replace(first, answers=(*self._answers, *first.answers))
                self._answers.clear()
            return frames, self._context

    def drop_all(self) -> None:
        """Drop all frames and answers."""
        with self._lock:
            self.dropped += len(self._frames)
            self._frames.clear()
            self._answers.clear()
            self._bytes = 0


def _size(frame: Frame) -> int:
    """Return the approximate size of a frame in the queue [bytes]."""
    contacts = 0 if frame.contacts is None else frame.contacts.nbytes
    return frame.snapshot.nbytes + contacts + 1000
