# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A thread that logs frames to an endpoint, from a queue of its own.

Law: the producer of a frame never blocks. The thread blocks where its receiver takes nothing; the
queue then drops its oldest frames, and `poll` reports that there is no answer.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from dataclasses import replace
from enum import Enum
import math
import threading
import time

from physsim_ros.model.answer import Answer
from physsim_ros.model.sizes import frame_size
from physsim_ros.model.snapshot import Frame
from physsim_ros.model.translation import Text
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.view.endpoints import Endpoint
from physsim_ros.view.frame_context import FrameContext

# Greatest memory of the frames that wait [bytes], and the greatest number of answers of dropped
# frames.
WAITING_BYTES, ANSWERS = 100e6, 50_000
# Greatest number of frames that are logged at once.
BATCH = 60
# Time from one try to reach a receiver to the next [s].
RETRY_PERIOD = 1.0
# Time without progress of the thread at which that is reported [s]: ten times what an import of
# Rerun takes, and more than a busy disk blocks.
SILENT_AFTER = 10.0


class _State(Enum):
    """Whether frames are logged; the values are the words for messages."""

    STARTING = 'starting'
    OPEN = 'open'
    FAILED = 'failed'


class EndpointThread:
    """
    An endpoint with the thread that logs to it.

    :param endpoint: to log to
    :param boundary: of the thread
    :param report: takes answers about the endpoint, from any thread
    :param context: returns that of the frames that are logged, from any thread
    """

    def __init__(
        self,
        endpoint: Endpoint,
        boundary: ErrorBoundary,
        report: Callable[[Answer], None],
        context: Callable[[], FrameContext] = FrameContext,
    ) -> None:
        self._state = _State.STARTING
        # The reason why it has failed; '' in other states.
        self._reason = ''
        self._endpoint = endpoint
        self._boundary = boundary
        self._report = report
        self._context = context
        self._lock = threading.Lock()
        self._frames: deque[Frame] = deque()
        self._bytes = 0
        # Answers of dropped frames: the next frame that is logged has them.
        self._answers: deque[Answer] = deque(maxlen=ANSWERS)
        self._logged = self._dropped = 0
        # Frames that were dropped before the endpoint was opened, and whether it has been reported
        # that more were.
        self._earlier_drops, self._has_told_drops = 0, False
        self._is_silent = False
        # Steady times of the last progress, and until which the last frames are waited for [s].
        self._progress, self._end_by = time.monotonic(), math.inf
        self._ending = threading.Event()
        # Set once the endpoint is open, or could not be opened.
        self._tried = threading.Event()
        name = f'viewer {endpoint.kind}'
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    @property
    def state(self) -> str:
        """Return address, state and counts of frames, as a sentence."""
        ended = self.has_ended and not self.failure
        state = 'ended' if ended else self._reason or self._state.value
        counts = f'{self._logged} frames, {self._dropped} dropped'
        return f'{self._endpoint.kind}: {self._endpoint.where}, {state}, {counts}'

    @property
    def failure(self) -> str:
        """Return the reason why nothing is logged; '' where there is none."""
        failed = self._state is _State.FAILED
        return f'{self._endpoint.kind}: {self._reason}' if failed else ''

    def wait_until_tried(self) -> str:
        """Wait until the endpoint is open or has failed; return why, '' where it is open."""
        self._tried.wait(SILENT_AFTER)
        return self._reason

    @property
    def is_open(self) -> bool:
        """Whether frames are logged, or will be in a moment."""
        return not (self.failure or self.has_ended)

    @property
    def reads_contacts(self) -> bool:
        """Whether frames have to have contacts: it is open, or silent, and may go on."""
        return self.is_open or (self._is_silent and not self.has_ended)

    @property
    def has_ended(self) -> bool:
        """Whether the thread has ended."""
        return not self._thread.is_alive()

    @property
    def is_closing(self) -> bool:
        """Whether it was told to end, and has time left for it."""
        return self._ending.is_set() and not self.has_ended and time.monotonic() < self._end_by

    @property
    def page_address(self) -> str:
        """Return the address of the endpoint where that is a web page; else ''."""
        return self._endpoint.page_address if self.is_open else ''

    def put(self, frame: Frame) -> None:
        """Queue a frame; a full queue drops its oldest frame, but not the answers of that."""
        with self._lock:
            self._frames.append(frame)
            self._bytes += frame_size(frame.snapshot, frame.contacts)
            while self._bytes > WAITING_BYTES or (self.has_ended and self._frames):
                self._answers += self._take().answers
                self._dropped += 1

    def poll(self) -> None:
        """Report a receiver that does not answer, and frames that were dropped."""
        if self.is_open and time.monotonic() - self._progress > SILENT_AFTER:
            self._is_silent = True
            self._fail(f'no answer for {SILENT_AFTER:g} s')
        if self.is_open and not self._has_told_drops and self._dropped > self._earlier_drops:
            self._has_told_drops = True
            address = self._endpoint.address
            message = Text('{receiver}: too slow, frames are missing', receiver=address)
            self._report(Answer(topic='viewer', message=message, code='frames_dropped'))

    def end(self, within: float = math.inf) -> None:
        """
        Log the frames of the queue, then end the thread.

        :param within: time for that [s], at most `closing` of the endpoint
        """
        if not self._ending.is_set():
            self._end_by = time.monotonic() + min(within, self._endpoint.closing)
            self._ending.set()

    def join(self) -> bool:
        """Wait for the end, as long as there is time for it; return whether it came."""
        self.end()
        self._thread.join(max(0.0, self._end_by - time.monotonic()))
        return self.has_ended

    def _run(self) -> None:
        try:
            while True:
                try:
                    self._log()
                    self._endpoint.complete(self._end_by)
                except ConnectionError as error:
                    self._fail(str(error))
                except ImportError as error:
                    self._fail(_lacking(error))
                if not self._endpoint.reopens or self._ending.wait(RETRY_PERIOD):
                    break
        except BaseException as error:  # noqa: BLE001 - a panic of Rerun (0.41) is no Exception
            failed = self._boundary.failed(f'viewer {self._endpoint.kind}', error)
            self._fail(str(failed))
        finally:
            self._endpoint.close()
            with self._lock:
                self._dropped += len(self._frames)
                self._frames.clear()
                self._answers.clear()

    def _log(self) -> None:
        """
        Open the endpoint, and log frames to it until the end.

        :raises ConnectionError: it cannot be opened, or is lost
        """
        if self._ending.is_set() and self._endpoint.reopens:
            # Nobody waits for a viewer; the frames of a file are still to be written.
            return
        # The first import of Rerun takes a second, so it happens in this thread.
        from physsim_ros.view.recording import FrameRecorder

        stream = self._endpoint.open_stream()
        recorder = FrameRecorder(stream.recording)
        try:
            self._earlier_drops, self._has_told_drops = self._dropped, False
            self._note_progress()
            ending = False
            while not ending:
                ending = self._ending.wait(self._endpoint.period)
                while frames := self._take_batch():
                    recorder.log(frames, context=self._context())
                    self._logged += len(frames)
                    self._note_progress()
                stream.flush()
                self._note_progress()
                self._endpoint.check()
        finally:
            del recorder
            stream.close()

    def _take_batch(self) -> list[Frame]:
        """Return the next frames, with the answers of those that were dropped."""
        with self._lock:
            frames = [self._take() for _ in range(min(BATCH, len(self._frames)))]
            if frames and self._answers:
                answers = (*self._answers, *frames[0].answers)
                frames[0] = replace(frames[0], answers=answers)
                self._answers.clear()
            return frames

    def _take(self) -> Frame:
        """Return the oldest frame; the caller holds the lock."""
        frame = self._frames.popleft()
        self._bytes -= frame_size(frame.snapshot, frame.contacts)
        return frame

    def _note_progress(self) -> None:
        """Note that the receiver has answered, and report it where there was none before."""
        self._progress, self._is_silent = time.monotonic(), False
        if self._state is not _State.OPEN and not self._ending.is_set():
            self._state, self._reason = _State.OPEN, ''
            self._report(
                Answer(topic='viewer', message=Text('{receiver}', receiver=self._endpoint.address))
            )
        self._tried.set()

    def _fail(self, reason: str) -> None:
        """Note the reason why nothing is logged, and report the first one."""
        before, self._state, self._reason = self._state, _State.FAILED, reason
        if before is not _State.FAILED:
            self._report(self._endpoint.lost_answer(reason))
        self._tried.set()


def _lacking(error: ImportError) -> str:
    """Return the reason why Rerun is not imported: it is missing, or of another version."""
    if not isinstance(error, ModuleNotFoundError):
        return str(error)
    return f'{error.name} is not installed: install physsim_ros with its extra [viewer]'
