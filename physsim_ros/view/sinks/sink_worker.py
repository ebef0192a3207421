# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Workers: threads that log frames to the sink of an endpoint, each from a queue of its own.

Law: the producer of a frame never blocks.
"""

from __future__ import annotations

import threading
import time

from physsim_ros.model.error_boundary import ErrorBoundary
from physsim_ros.model.snapshot import Answer, Frame
from physsim_ros.view.frame_context import FrameContext
from physsim_ros.view.sinks.frame_queue import FrameQueue
from physsim_ros.view.sinks.sink import Endpoint, Report, Sink

# Period of flushing a sink and checking its endpoint, and timeout of the flush [s].
CHECK_PERIOD, FLUSH_TIMEOUT = 1.0, 0.5
# Time without progress of a worker at which an event reports it [s]: ten times what an import of
# Rerun takes. A file on a share that does not answer blocks it without limit.
SILENT_AFTER = 10.0
# Longest wait for a sink to close [s].
CLOSING = 2.0


class SinkWorker:
    """
    A thread that logs frames to the sinks of an endpoint.

    :param endpoint: to log to
    :param boundary: of the thread
    :param report: takes answers about the endpoint, from any thread
    :param after: a worker that has to end before this one begins
    """

    def __init__(
        self,
        endpoint: Endpoint,
        boundary: ErrorBoundary,
        *,
        report: Report,
        after: SinkWorker | None = None,
    ) -> None:
        self._endpoint = endpoint
        self._boundary = boundary
        self._report = report
        self._before = after
        self._queue = FrameQueue(endpoint.capacity)
        self._logged = 0
        self._status = 'starting'
        # Steady time of the first flush that timed out; None while flushes succeed [s].
        self._stalled_since: float | None = None
        self._stall_reported = self._drops_reported = False
        # Steady time of the last progress [s], and whether its age was reported.
        self._progress, self._silence_reported = time.monotonic(), False
        # Closes the sink; Rerun (0.41) may wait for ever, as for a full disk or a frozen viewer.
        self._closer: threading.Thread | None = None
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
        counts = f'{self._logged} frames, {self._queue.dropped} dropped'
        return f'{self._endpoint.kind}: {self._endpoint.where}, {self._status}, {counts}'

    @property
    def failure(self) -> str:
        """Return the reason why no frames are shown or recorded; '' where there is none."""
        failed = self._status not in ('starting', 'nobody there', 'open', 'ended')
        return f'{self._endpoint.kind}: {self._status}' if failed else ''

    @property
    def is_opening(self) -> bool:
        """Whether the endpoint is being opened for the first time."""
        return self._status == 'starting' and self.is_open

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
        self._queue.put(frame, context)
        if not self.is_open:
            self._queue.drop_all()
        elif self._queue.has_batch:
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

        :return: False where the endpoint's time for `closing` was too short, or its sink is open
        """
        self.end()
        self._thread.join(max(0.0, self._end_by - time.monotonic()))
        self._endpoint.close()
        return not self.is_open and not (self._closer and self._closer.is_alive())

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
                        self._close(sink)
            self._status = 'ended'
        except (ConnectionError, ImportError) as error:
            # Rerun may be missing, or be of another version.
            self._status = f'failed ({error})'
            self._report(self._endpoint.lost_answer(str(error)))
        except BaseException as error:  # noqa: BLE001 - a panic of Rerun (0.41) is no Exception
            self._status = 'broken'
            failed = self._boundary.failed(f'viewer {self._endpoint.kind}', error)
            self._report(self._endpoint.lost_answer(str(failed)))
        finally:
            self._endpoint.close()
            self._queue.drop_all()

    def _log_to(self, sink: Sink) -> None:
        """
        Log frames until the worker ends, or the endpoint is lost and may be opened again.

        :raises ConnectionError: it is lost for good
        """
        self._stalled_since, self._stall_reported, self._drops_reported = None, False, False
        self._status, dropped, due = 'open', self._queue.dropped, time.monotonic() + CHECK_PERIOD
        while True:
            self._note_progress()
            self._wake.wait(self._endpoint.period)
            self._wake.clear()
            closing = self._closing.is_set()
            if self._stalled_since is None and (closing or self._endpoint.is_ready):
                self._drain(sink, everything=closing)
            if closing or self._stalled_since is not None or time.monotonic() >= due:
                due = time.monotonic() + CHECK_PERIOD
                if self._queue.dropped > dropped and not self._drops_reported:
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
        while len(self._queue):
            frames, context = self._queue.take_batch()
            sink.draw(frames, context=context)
            self._logged += len(frames)
            if not everything:
                break
        if len(self._queue):
            self._wake.set()

    def _close(self, sink: Sink) -> None:
        """Close a sink; one that takes longer than `CLOSING` is left behind, with its thread."""
        self._closer = threading.Thread(target=sink.close, name='close viewer', daemon=True)
        self._closer.start()
        self._closer.join(CLOSING)

    def _note_progress(self) -> None:
        """Note that the endpoint has answered, and report it where its silence was reported."""
        self._progress = time.monotonic()
        if self._silence_reported:
            self._silence_reported, self._status = False, 'open'
            self._report(self._endpoint.opened_answer())

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
            if now - self._stalled_since >= self._endpoint.patience and not self._stall_reported:
                reason = 'it takes nothing any more'
                if not self._endpoint.reopens:
                    raise ConnectionError(reason) from None
                self._stall_reported = True
                self._report(self._endpoint.lost_answer(reason))
        else:
            self._status, self._stalled_since = 'open', None
            if self._stall_reported:
                self._stall_reported = False
                self._report(self._endpoint.opened_answer())
