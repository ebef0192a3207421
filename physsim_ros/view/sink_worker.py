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
Sinks of frames, each with a bounded queue and a worker thread.

Law: the producer of a frame never blocks. Frames that the worker cannot log in time are dropped,
oldest first, and counted; their answers are logged with the next frame.
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
from physsim_ros.view.frame_context import FrameContext

# The greatest number of frames in a batch, and the greatest memory of the queue [bytes].
BATCH, WAITING_BYTES = 60, 256e6
# The greatest number of waiting answers of dropped frames.
ANSWERS = 50_000
# Period of flushing a sink and checking its endpoint, and timeout of the flush [s].
CHECK_PERIOD, FLUSH_TIMEOUT = 1.0, 0.5
# Time after the first flush that timed out at which an event reports it [s].
STALLED_AFTER = 3.0
# Time without progress of a worker at which an event reports it [s]: ten times what an import of
# Rerun takes. A file on a share that does not answer blocks it without limit.
SILENT_AFTER = 10.0

Report = Callable[[Answer], None]


class Sink(Protocol):
    """A stream that frames are logged to."""

    def draw(self, frames: Sequence[Frame], *, context: FrameContext) -> None:
        """Log frames in order."""

    def flush(self, timeout: float) -> None:
        """
        Wait until all logged frames have been sent.

        :param timeout: longest wait [s]
        :raises TimeoutError: they have not been sent yet
        :raises ConnectionError: they cannot be sent any more
        """

    def close(self) -> None:
        """Close the stream; called once, whatever happened to it."""


class Endpoint(ABC):
    """
    The receiver of a sink: a file, a server, or a program on this machine.

    :cvar kind: name of it, for messages
    :cvar where: address of it, for messages
    :cvar code: of the event when it is lost
    :cvar period: time for which frames are gathered into a batch [s]
    :cvar capacity: greatest number of frames in the queue
    :cvar closing: longest time for the last frames [s]
    :cvar reopens: whether it may be opened again after it was lost
    """

    kind = ''
    where = ''
    code: ClassVar[str] = 'viewer_lost'
    period: ClassVar[float] = 0.1
    capacity: ClassVar[int] = 60
    closing: ClassVar[float] = 2.0
    reopens: ClassVar[bool] = True

    @abstractmethod
    def open_sink(self) -> Sink | None:
        """
        Return a new sink; None where the receiver is not there yet.

        :raises ConnectionError: it cannot be opened at all
        """

    def check(self) -> None:  # noqa: B027  most have nothing to check
        """
        Restart or report a program that has ended; called every `CHECK_PERIOD`.

        :raises ConnectionError: the receiver is lost
        """

    def close(self) -> None:  # noqa: B027  the same
        """
        End the program, if there is one, and start none any more.

        Called more than once, and from another thread while `open_sink` or `check_program` runs.
        """

    def opened_answer(self) -> Answer:
        """Return the answer that reports that it was opened."""
        return Answer(topic='viewer', message=f'{self.kind}: {self.where}')

    def lost_answer(self, reason: str) -> Answer:
        """Return the answer that reports that it was lost, or is another than was asked for."""
        message = f'{self.kind}: {self.where}: {reason}'
        return Answer(topic='viewer', message=message, code=self.code)


class SinkWorker:
    """
    A thread that logs frames to the sinks of an endpoint.

    :param endpoint: to log to
    :param report: takes answers about the endpoint, from any thread
    :param after: a worker that has to end before this one begins
    """

    def __init__(
        self, endpoint: Endpoint, *, report: Report, after: SinkWorker | None = None
    ) -> None:
        self._endpoint = endpoint
        self._report = report
        self._before = after
        self._lock = threading.Lock()
        self._frames: deque[Frame] = deque()
        self._answers: deque[Answer] = deque(maxlen=ANSWERS)
        self._bytes = 0
        self._context = FrameContext()
        self._logged = self._dropped = 0
        self._status = 'starting'
        # Steady time of the first flush that timed out; None while flushes succeed [s].
        self._stalled_since: float | None = None
        self._stall_reported = self._drops_reported = False
        # Steady time of the last progress [s], and whether its age was reported.
        self._progress, self._silence_reported = time.monotonic(), False
        self._closing = threading.Event()
        # Steady time until which the last frames are waited for [s].
        self._end_by = 0.0
        # Set to end the wait for the period.
        self._wake = threading.Event()
        self._thread = threading.Thread(
            target=self._run, name=f'viewer {endpoint.kind}', daemon=True
        )
        self._thread.start()

    @property
    def state(self) -> str:
        """Return address, status and counts of frames, as a sentence."""
        counts = f'{self._logged} frames, {self._dropped} dropped'
        return f'{self._endpoint.kind}: {self._endpoint.where}, {self._status}, {counts}'

    @property
    def is_open(self) -> bool:
        """Whether the worker runs."""
        return self._thread.is_alive()

    @property
    def page_address(self) -> str:
        """Return the address of the endpoint where that is a web page; else ''."""
        endpoint = self._endpoint
        served = self.is_open and endpoint.kind == 'web' and endpoint.where.startswith('http:')
        return endpoint.where if served else ''

    @property
    def is_closing(self) -> bool:
        """Whether the worker was told to end, and has time left for it."""
        return self._closing.is_set() and self.is_open and time.monotonic() < self._end_by

    def put_frame(self, frame: Frame, *, context: FrameContext) -> None:
        """Queue a frame; a full queue drops its oldest frame, but not the answers of that."""
        capacity = self._endpoint.capacity
        if not self.is_open:
            self._dropped += 1
            return
        with self._lock:
            self._context = context
            self._frames.append(frame)
            self._bytes += _size(frame)
            while len(self._frames) > capacity or self._bytes > WAITING_BYTES:
                oldest = self._frames.popleft()
                self._bytes -= _size(oldest)
                self._answers += oldest.answers
                self._dropped += 1
            due = len(self._frames) >= min(BATCH, capacity // 2)
        if due:
            self._wake.set()

    def end(self) -> None:
        """Log the frames of the queue, then end the thread."""
        if not self._closing.is_set():
            self._end_by = time.monotonic() + self._endpoint.closing
        self._closing.set()
        self._wake.set()

    def join(self) -> bool:
        """
        Wait for the thread; return whether it has ended.

        :return: False where the endpoint's time for `closing` was too short
        """
        self.end()
        self._thread.join(max(0.0, self._end_by - time.monotonic()))
        self._endpoint.close()
        return not self.is_open

    def report_silence(self) -> None:
        """Report a worker that makes no progress any more: opening or writing blocks."""
        silent = self.is_open and time.monotonic() - self._progress > SILENT_AFTER
        if silent and not self._silence_reported:
            self._silence_reported, self._status = True, 'blocked'
            self._report(self._endpoint.lost_answer(f'no answer for {SILENT_AFTER:g} s'))

    def _run(self) -> None:
        try:
            if self._before is not None:
                self._before.join()
                self._before = None
            while not self._closing.is_set():
                self._note_progress()
                sink = self._endpoint.open_sink()
                if sink is None:
                    self._status = 'nobody there'
                    self._closing.wait(CHECK_PERIOD)
                else:
                    self._silence_reported = False
                    self._report(self._endpoint.opened_answer())
                    try:
                        self._log_to(sink)
                    finally:
                        sink.close()
            self._status = 'ended'
        except (ConnectionError, ImportError) as error:
            # Rerun may be missing, or be of another version.
            self._status = f'failed ({error})'
            self._report(self._endpoint.lost_answer(str(error)))
        except BaseException as error:
            self._status = 'broken'
            self._report(self._endpoint.lost_answer(f'{type(error).__name__}: {error}'))
            raise
        finally:
            self._endpoint.close()
            self._drop_queue()

    def _log_to(self, sink: Sink) -> None:
        """
        Log frames until the worker ends, or the endpoint is lost and may be opened again.

        :raises ConnectionError: it is lost for good
        """
        self._stalled_since, self._stall_reported, self._drops_reported = None, False, False
        self._status, dropped, due = 'open', self._dropped, time.monotonic() + CHECK_PERIOD
        while True:
            self._note_progress()
            self._wake.wait(self._endpoint.period)
            self._wake.clear()
            closing = self._closing.is_set()
            if self._stalled_since is None:
                self._drain(sink, everything=closing)
            if closing or self._stalled_since is not None or time.monotonic() >= due:
                due = time.monotonic() + CHECK_PERIOD
                if self._dropped > dropped and not self._drops_reported:
                    self._drops_reported = True
                    endpoint = self._endpoint
                    message = f'{endpoint.kind}: {endpoint.where}: too slow, frames are missing'
                    self._report(Answer(topic='viewer', message=message, code='frames_dropped'))
                try:
                    self._endpoint.check()
                    self._flush(sink, self._endpoint.closing / 2 if closing else FLUSH_TIMEOUT)
                except ConnectionError as error:
                    if not self._endpoint.reopens:
                        raise
                    self._status = 'lost'
                    self._report(self._endpoint.lost_answer(str(error)))
                    return
            if closing:
                return

    def _drain(self, sink: Sink, *, everything: bool) -> None:
        """Log one batch of the queue, or all of it."""
        while True:
            with self._lock:
                frames = [self._frames.popleft() for _ in range(min(BATCH, len(self._frames)))]
                self._bytes -= sum(map(_size, frames))
                if frames and self._answers:
                    first = frames[0]
                    frames[0] = replace(first, answers=(*self._answers, *first.answers))
                    self._answers.clear()
                remaining, context = len(self._frames), self._context
            if frames:
                sink.draw(frames, context=context)
                self._logged += len(frames)
            if not remaining:
                return
            if not everything:
                self._wake.set()
                return

    def _note_progress(self) -> None:
        """Note that the endpoint has answered, and report it where its silence was reported."""
        self._progress = time.monotonic()
        if self._silence_reported:
            self._silence_reported, self._status = False, 'open'
            self._report(self._endpoint.opened_answer())

    def _drop_queue(self) -> None:
        """Drop the frames of the queue."""
        with self._lock:
            self._dropped += len(self._frames)
            self._frames.clear()
            self._answers.clear()
            self._bytes = 0

    def _flush(self, sink: Sink, timeout: float) -> None:
        """
        Flush a sink; while that times out, no more frames are logged.

        :raises ConnectionError: logged frames cannot be sent any more
        """
        try:
            sink.flush(timeout)
        except TimeoutError:
            now = time.monotonic()
            self._status = 'takes nothing'
            self._stalled_since = now if self._stalled_since is None else self._stalled_since
            if now - self._stalled_since >= STALLED_AFTER and not self._stall_reported:
                self._stall_reported = True
                self._report(self._endpoint.lost_answer('it takes nothing any more'))
        else:
            self._status, self._stalled_since = 'open', None
            if self._stall_reported:
                self._stall_reported = False
                self._report(self._endpoint.opened_answer())


def _size(frame: Frame) -> int:
    """Return the approximate size of a frame in the queue [bytes]."""
    contacts = 0 if frame.contacts is None else frame.contacts.nbytes
    return frame.snapshot.nbytes + contacts + 1000
