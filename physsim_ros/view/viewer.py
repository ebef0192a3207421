# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The viewer: frames are shown in a window, on a web page or by another server, and recorded.

Laws: neither a viewer nor a disk that fails or is slow delays the world; at most one viewer is
opened in a `CHANGE_PERIOD`, after the one before has closed.
"""

from __future__ import annotations

from collections import deque
from enum import Enum
from pathlib import Path
import sys
import threading
import time

from physsim_ros.model.error_boundary import ErrorBoundary
from physsim_ros.model.snapshot import Answer, Frame
from physsim_ros.view.frame_context import FrameContext
from physsim_ros.view.sinks.endpoints import (
    ClientEndpoint,
    DEFAULT_URL,
    has_display,
    ServerEndpoint,
)
from physsim_ros.view.sinks.file_endpoint import FileEndpoint
from physsim_ros.view.sinks.frame_queue import ANSWERS
from physsim_ros.view.sinks.page_endpoint import PageEndpoint, Send
from physsim_ros.view.sinks.sink import Endpoint
from physsim_ros.view.sinks.sink_worker import SinkWorker

# Least time between two openings [s]: each may start a program.
CHANGE_PERIOD = 1.0


class ViewerMode(Enum):
    """The kinds of viewer: the values of parameter `viewer`."""

    NONE = 'none'
    SPAWN = 'spawn'
    WEB = 'web'
    CONNECT = 'connect'
    AUTO = 'auto'


class Viewer:
    """
    Shows frames in at most one viewer, and records them in at most one file.

    :param boundary: of the threads of viewers and files; None lets unexpected errors pass
    """

    def __init__(self, boundary: ErrorBoundary | None = None) -> None:
        self._boundary = boundary or ErrorBoundary()
        self._events: deque[Answer] = deque(maxlen=ANSWERS)
        self._file: SinkWorker | None = None
        self._file_path = Path()
        self._window: SinkWorker | None = None
        # Viewers before, which are closing; a frozen one never ends.
        self._closing: list[SinkWorker] = []
        # Replaced whole, since pages come and go on another thread than frames.
        self._pages: dict[PageEndpoint, SinkWorker] = {}
        self._pages_lock = threading.Lock()
        # Mode and URL of the viewer to open next; None where it is open.
        self._wanted: tuple[ViewerMode, str] | None = None
        # Steady time before which nothing is opened [s].
        self._next_opening = 0.0
        self._shown: tuple[Frame, FrameContext] | None = None

    @property
    def state(self) -> str:
        """Return the states of viewer and file, as a sentence."""
        return '; '.join(worker.state for worker in self._workers) or 'none'

    @property
    def failure(self) -> str:
        """Return the reason why a viewer or file has no frames; '' where there is none."""
        return '; '.join(filter(None, (worker.failure for worker in self._workers)))

    @property
    def is_open(self) -> bool:
        """Whether there is a viewer, a page or a file."""
        return any(worker.is_open for worker in self._workers)

    @property
    def is_opening(self) -> bool:
        """Whether a viewer is being opened, or will be soon."""
        window = self._window
        return self._wanted is not None or (window is not None and window.is_opening)

    @property
    def page_address(self) -> str:
        """Return the address of the viewer's web page, on this machine; '' where there is none."""
        return '' if self._window is None else self._window.page_address

    @property
    def _workers(self) -> list[SinkWorker]:
        known = (self._file, self._window, *self._pages.values())
        return [worker for worker in known if worker is not None]

    def open_viewer(self, mode: ViewerMode, url: str = '') -> None:
        """
        Close the viewer and open another, which shows the last frame too.

        The last of several calls within a `CHANGE_PERIOD` counts. A recording that goes on is not
        affected; one that has failed is begun again, in a file of its own.

        :param mode: kind of viewer
        :param url: of the Rerun server for CONNECT; '' is the default one of this machine
        """
        if self._window is not None:
            self._window.end()
            self._closing.append(self._window)
            self._window = None
        self._wanted = mode, url
        self._open_wanted()

    def record(self, path: Path) -> None:
        """Record the frames from now on in another `.rrd` file."""
        if self._file is not None:
            self._file.end()
        self._file_path = path
        self._file = self._open_sink(FileEndpoint(path, overwrite=True), after=self._file)

    def open_page(self, send: Send) -> PageEndpoint:
        """
        Begin a recording for a page in a browser; called on any thread.

        :param send: takes a batch as bytes of an `.rrd` file and the time of its last frame [ns]
        :return: the page: its `note_shown` asks for the next batch
        """
        page = PageEndpoint(send)
        with self._pages_lock:
            self._pages = {**self._pages, page: self._open_sink(page)}
        return page

    def close_page(self, page: PageEndpoint) -> None:
        """End the recording of a page; called on any thread."""
        with self._pages_lock:
            self._pages[page].end()
            self._pages = {key: each for key, each in self._pages.items() if key is not page}

    def show(self, frame: Frame, *, context: FrameContext) -> None:
        """
        Queue a frame for viewer and file; never blocks.

        :param frame: its arrays are not changed any more
        :param context: of the frame
        """
        self._shown = frame, context
        for worker in self._workers:
            worker.put_frame(frame, context=context)

    def poll(self) -> tuple[Answer, ...]:
        """
        Open the viewer that waits, and return the answers about viewers and files.

        Called at least every `CHANGE_PERIOD`.

        :return: the answers since the last call
        """
        self._open_wanted()
        for worker in self._workers:
            worker.report_silence()
        return tuple(self._events.popleft() for _ in range(len(self._events)))

    def close(self) -> None:
        """Log the queued frames, as far as the time for closing allows, and end."""
        self._wanted = None
        workers = [*self._workers, *self._closing]
        for worker in workers:
            worker.end()
        ended = [worker.join() for worker in workers]
        if not all(ended) and 'rerun' in sys.modules:
            # At exit Rerun (0.41) waits for its recordings, without end where a viewer is frozen.
            sys.modules['rerun'].unregister_shutdown()

    def _open_wanted(self) -> None:
        """Open the viewer that waits and the file that has failed, if it is time."""
        now = time.monotonic()
        if self._wanted is None or now < self._next_opening:
            return
        if any(worker.is_closing for worker in self._closing):
            return
        self._closing = [worker for worker in self._closing if not worker.join()]
        (mode, url), self._wanted = self._wanted, None
        if self._file is not None and not self._file.is_open:
            self._next_opening = now + CHANGE_PERIOD
            self._file = self._open_sink(FileEndpoint(self._file_path, overwrite=False))
        if mode is ViewerMode.AUTO:
            mode = ViewerMode.SPAWN if has_display() else ViewerMode.WEB
        if mode is ViewerMode.NONE:
            return
        self._next_opening = now + CHANGE_PERIOD
        self._window = self._open_sink(
            ClientEndpoint(url or DEFAULT_URL)
            if mode is ViewerMode.CONNECT
            else ServerEndpoint(native=mode is ViewerMode.SPAWN, report=self._events.append)
        )

    def _open_sink(self, endpoint: Endpoint, *, after: SinkWorker | None = None) -> SinkWorker:
        """
        Return a worker for an endpoint, with the last frame in its queue.

        :param after: a worker that has to end first
        """
        worker = SinkWorker(endpoint, self._boundary, report=self._events.append, after=after)
        if self._shown is not None:
            frame, context = self._shown
            worker.put_frame(frame, context=context)
        return worker
