# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
A way out for frames: they wait in a bounded queue, and a thread of its own draws them.

Law: whoever hands a frame in never waits. What cannot be drawn in time is dropped, oldest first,
and counted; its answers are drawn with the next frame.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Callable, Sequence
from dataclasses import replace
import threading
import time
from typing import ClassVar, Protocol

from physsim_ros.model.snapshot import Answer, Frame

# Most frames that are drawn at once, and the memory that waiting ones may take [bytes].
BATCH, WAITING_BYTES = 60, 256e6
# Answers that may wait when their frames have been dropped.
ANSWERS = 50_000
# How often to see whether what has been drawn arrives, and how long that may take [s].
LOOK, PATIENCE = 1.0, 0.5
# For so long it may be slow without an event [s].
SLOW = 3.0

Tell = Callable[[Answer], None]


class Canvas(Protocol):
    """What frames are drawn on."""

    def draw(self, frames: Sequence[Frame], *, real_time_factor: float) -> None:
        """Draw frames in their order."""

    def flush(self, patience: float) -> None:
        """
        Wait until what has been drawn has arrived.

        :param patience: at most so long [s]
        :raises TimeoutError: it has not yet
        :raises ConnectionError: it never will
        """

    def close(self) -> None:
        """Draw no more; only after all has arrived."""


class Way(ABC):
    """
    Where an outlet leads.

    `kind` and `where` tell it to people; `code` is that of the event when it is lost. Frames are
    gathered for `period` [s], `waiting` of them may wait, and the last ones may take `closing`
    [s]. `again` tells whether it may be opened anew after it was lost.
    """

    kind = ''
    where = ''
    code: ClassVar[str] = 'viewer_lost'
    period: ClassVar[float] = 0.1
    waiting: ClassVar[int] = 60
    closing: ClassVar[float] = 2.0
    again: ClassVar[bool] = True

    @abstractmethod
    def begin(self) -> Canvas | None:
        """
        Return a fresh canvas there; None where there is nobody yet.

        :raises ConnectionError: there never can be one
        """

    def look(self) -> None:  # noqa: B027  most have nothing to look to
        """See to what was started; called every second."""

    def close(self) -> None:  # noqa: B027  the same
        """
        End what was started, if anything was, and start nothing any more.

        Called more than once, and from another thread while `begin` or `look` may still be at it.
        """

    def found(self) -> Answer:
        """Return the answer that says that it is there."""
        return Answer(topic='viewer', message=f'{self.kind}: {self.where}')

    def lost(self, why: str) -> Answer:
        """Return the answer that says that it is not, or not as it was asked for."""
        return Answer(topic='viewer', message=f'{self.kind}: {self.where}: {why}', code=self.code)


class Outlet:
    """
    Draws frames somewhere.

    :param way: where
    :param tell: takes what happens, from any thread
    :param after: one that ends, and whose place it takes
    """

    def __init__(self, way: Way, *, tell: Tell, after: Outlet | None = None) -> None:
        self._way = way
        self._tell = tell
        self._before = after
        self._lock = threading.Lock()
        self._frames: deque[Frame] = deque()
        self._answers: deque[Answer] = deque(maxlen=ANSWERS)
        self._bytes = 0
        self._factor = 0.0
        self._drawn = self._dropped = 0
        self._status = 'starting'
        # Since when nothing arrives any more.
        self._stuck: float | None = None
        self._told_stuck = self._told_dropping = False
        self._closing = threading.Event()
        # Set when there is something to do before the period is over.
        self._wake = threading.Event()
        self._thread = threading.Thread(target=self._run, name=f'viewer {way.kind}', daemon=True)
        self._thread.start()

    @property
    def state(self) -> str:
        """Tell where it leads, how it is, and what came through."""
        counts = f'{self._drawn} frames, {self._dropped} dropped'
        return f'{self._way.kind}: {self._way.where}, {self._status}, {counts}'

    @property
    def is_open(self) -> bool:
        """Whether it draws, or will when somebody is there."""
        return self._thread.is_alive()

    def put(self, frame: Frame, *, real_time_factor: float) -> None:
        """Take a frame; where too many wait, the oldest goes, but for its answers."""
        most = self._way.waiting
        if not self.is_open:
            self._dropped += 1
            return
        with self._lock:
            self._factor = real_time_factor
            self._frames.append(frame)
            self._bytes += _size(frame)
            while len(self._frames) > most or self._bytes > WAITING_BYTES:
                oldest = self._frames.popleft()
                self._bytes -= _size(oldest)
                self._answers += oldest.answers
                self._dropped += 1
            hurry = len(self._frames) >= min(BATCH, most // 2)
        if hurry:
            self._wake.set()

    def end(self) -> None:
        """Draw what waits, then no more."""
        self._closing.set()
        self._wake.set()

    def join(self) -> bool:
        """Wait until it has ended, at most as long as its way is worth; tell whether it has."""
        self._thread.join(self._way.closing)
        self._way.close()
        return not self._thread.is_alive()

    def _run(self) -> None:
        try:
            if self._before is not None:
                self._before.join()
                self._before = None
            while not self._closing.is_set():
                canvas = self._way.begin()
                if canvas is None:
                    self._status = 'nobody there'
                    self._closing.wait(LOOK)
                else:
                    self._tell(self._way.found())
                    self._draw_on(canvas)
            self._status = 'ended'
        except (ConnectionError, ImportError) as error:
            # Rerun may not be there, or not as it should be.
            self._status = 'failed'
            self._tell(self._way.lost(str(error)))
        except BaseException as error:
            self._status = 'broken'
            self._tell(self._way.lost(f'{type(error).__name__}: {error}'))
            raise
        finally:
            self._way.close()
            self._let_go()

    def _draw_on(self, canvas: Canvas) -> None:
        """
        Draw until the outlet is closed, or its way is lost and may be found again.

        :raises ConnectionError: it is lost for good
        """
        self._stuck, self._told_stuck, self._told_dropping = None, False, False
        self._status, dropped, due = 'open', self._dropped, time.monotonic() + LOOK
        while True:
            self._wake.wait(self._way.period)
            self._wake.clear()
            closing = self._closing.is_set()
            if self._stuck is None:
                self._drain(canvas, everything=closing)
            if closing or self._stuck is not None or time.monotonic() >= due:
                due = time.monotonic() + LOOK
                self._way.look()
                if self._dropped > dropped and not self._told_dropping:
                    self._told_dropping = True
                    message = f'{self._way.kind}: {self._way.where}: too slow, frames are missing'
                    self._tell(Answer(topic='viewer', message=message, code='frames_dropped'))
                try:
                    self._flush(canvas, self._way.closing / 2 if closing else PATIENCE)
                except ConnectionError as error:
                    if not self._way.again:
                        raise
                    self._status = 'lost'
                    self._tell(self._way.lost(str(error)))
                    return
            if closing:
                if self._stuck is None:
                    canvas.close()
                return

    def _drain(self, canvas: Canvas, *, everything: bool) -> None:
        """Draw a batch of what waits, or all of it."""
        while True:
            with self._lock:
                frames = [self._frames.popleft() for _ in range(min(BATCH, len(self._frames)))]
                self._bytes -= sum(map(_size, frames))
                if frames and self._answers:
                    first = frames[0]
                    frames[0] = replace(first, answers=(*self._answers, *first.answers))
                    self._answers.clear()
                left, factor = len(self._frames), self._factor
            if frames:
                canvas.draw(frames, real_time_factor=factor)
                self._drawn += len(frames)
            if not left:
                return
            if not everything:
                self._wake.set()
                return

    def _let_go(self) -> None:
        """Drop what waits: nobody will draw it."""
        with self._lock:
            self._dropped += len(self._frames)
            self._frames.clear()
            self._answers.clear()
            self._bytes = 0

    def _flush(self, canvas: Canvas, patience: float) -> None:
        """
        See whether what has been drawn arrives; until it does, no more is drawn.

        :raises ConnectionError: it never will
        """
        try:
            canvas.flush(patience)
        except TimeoutError:
            now = time.monotonic()
            self._status = 'takes nothing'
            self._stuck = now if self._stuck is None else self._stuck
            if now - self._stuck >= SLOW and not self._told_stuck:
                self._told_stuck = True
                self._tell(self._way.lost('it takes nothing any more'))
        else:
            self._status, self._stuck = 'open', None
            if self._told_stuck:
                self._told_stuck = False
                self._tell(self._way.found())


def _size(frame: Frame) -> int:
    """Return what a waiting frame holds, about [bytes]."""
    contacts = 0 if frame.contacts is None else frame.contacts.nbytes
    return frame.snapshot.nbytes + contacts + 1000
