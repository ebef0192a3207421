# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The viewer: frames are shown in a window, on a web page or by another server, and recorded.

Laws: neither a viewer nor a disk that fails or is slow delays the world; a viewer is opened after
the one before has closed.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from enum import Enum
import math
from pathlib import Path
import sys

from physsim_ros.model.answer import Answer
from physsim_ros.model.snapshot import Frame
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.view.endpoint_thread import ANSWERS, EndpointThread
from physsim_ros.view.endpoints import (
    ClientEndpoint,
    DEFAULT_URL,
    Endpoint,
    has_display,
    ServerEndpoint,
)
from physsim_ros.view.file_endpoint import FileEndpoint
from physsim_ros.view.frame_context import FrameContext


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
    :param context: returns that of the frames that are logged, from any thread

    :ivar name: of the output
    """

    name = 'viewer'

    def __init__(
        self,
        boundary: ErrorBoundary | None = None,
        *,
        context: Callable[[], FrameContext] = FrameContext,
    ) -> None:
        self._boundary = boundary or ErrorBoundary()
        self._context = context
        self._answers: deque[Answer] = deque(maxlen=ANSWERS)
        self._file: EndpointThread | None = None
        self._file_path = Path()
        self._window: EndpointThread | None = None
        # Threads before, which had no time left to end.
        self._stuck: list[EndpointThread] = []
        # Mode and URL of the viewer to open next; None where it is open.
        self._wanted: tuple[ViewerMode, str] | None = None
        self._shown: Frame | None = None

    @property
    def state(self) -> str:
        """Return the states of viewer and file, as a sentence."""
        return '; '.join(thread.state for thread in self._threads) or 'none'

    @property
    def failure(self) -> str:
        """Return the reason why a viewer or file has no frames; '' where there is none."""
        return '; '.join(filter(None, (thread.failure for thread in self._threads)))

    @property
    def is_open(self) -> bool:
        """Whether there is a viewer or a file."""
        return any(thread.is_open for thread in self._threads)

    @property
    def is_read(self) -> bool:
        """Whether frames are logged now, or may be later by an output that failed."""
        return not all(thread.has_ended for thread in self._threads)

    @property
    def reads_contacts(self) -> bool:
        """Whether frames are logged, or will be, by one that is silent."""
        return any(thread.reads_contacts for thread in self._threads)

    @property
    def page_address(self) -> str:
        """Return the address of the viewer's web page, on this machine; '' where there is none."""
        return '' if self._window is None else self._window.page_address

    @property
    def _threads(self) -> list[EndpointThread]:
        return [thread for thread in (self._file, self._window) if thread is not None]

    def open_viewer(self, mode: ViewerMode, url: str = '') -> None:
        """
        Close the viewer and open another, which shows the last frame too.

        A recording that goes on is not affected; one that has failed is begun again, in a file of
        its own.

        :param mode: kind of viewer
        :param url: of the Rerun server for CONNECT; '' is the default one of this machine
        """
        if self._window is not None:
            self._window.end()
        self._wanted = mode, url
        self._open_wanted()

    def record(self, path: Path) -> None:
        """Record the frames from now on in another `.rrd` file; waits for the end of the last."""
        if self._file is not None:
            self._retire(self._file)
        self._file_path = path
        self._file = self._open(FileEndpoint(path, overwrite=True))

    def wait_for_file(self) -> str:
        """Wait until the recording is open or has failed; return why, '' where it is open."""
        return '' if self._file is None else self._file.wait_until_tried()

    def show(self, frame: Frame) -> None:
        """
        Queue a frame for viewer and file; never blocks.

        :param frame: its arrays are not changed any more
        """
        self._shown = frame
        for thread in self._threads:
            thread.put(frame)

    def poll(self) -> tuple[Answer, ...]:
        """
        Open the viewer that waits, and return the answers about viewers and files.

        Called every second, or more often.

        :return: the answers since the last call
        """
        self._open_wanted()
        for thread in self._threads:
            thread.poll()
        return tuple(self._answers.popleft() for _ in range(len(self._answers)))

    def close(self, within: float = math.inf) -> None:
        """
        Log the queued frames, and end viewer and file.

        :param within: time for that [s], of which a file has at most 9 s, and a viewer 2 s
        """
        self._wanted = None
        threads = [*self._threads, *self._stuck]
        for thread in threads:
            thread.end(within)
        ended = [thread.join() for thread in threads]
        unregister = getattr(sys.modules.get('rerun'), 'unregister_shutdown', None)
        if not all(ended) and unregister is not None:
            # At exit Rerun (0.41) waits for its recordings, without end where a viewer is frozen;
            # one that is still being imported has none.
            unregister()

    def _open_wanted(self) -> None:
        """Open the viewer that waits and the file that has failed, once the last has closed."""
        if self._wanted is None or (self._window is not None and self._window.is_closing):
            return
        (mode, url), self._wanted = self._wanted, None
        if self._window is not None:
            self._retire(self._window)
            self._window = None
        if self._file is not None and self._file.failure:
            self._file.end()
            self._stuck.append(self._file)
            self._file = self._open(FileEndpoint(self._file_path, overwrite=False))
        if mode is ViewerMode.AUTO:
            mode = ViewerMode.SPAWN if has_display() else ViewerMode.WEB
        if mode is ViewerMode.CONNECT:
            self._window = self._open(ClientEndpoint(url or DEFAULT_URL))
        elif mode is not ViewerMode.NONE:
            native = mode is ViewerMode.SPAWN
            self._window = self._open(ServerEndpoint(native=native, report=self._answers.append))

    def _open(self, endpoint: Endpoint) -> EndpointThread:
        """Return a thread that logs to an endpoint, with the last frame in its queue."""
        thread = EndpointThread(endpoint, self._boundary, self._answers.append, self._context)
        if self._shown is not None:
            thread.put(self._shown)
        return thread

    def _retire(self, thread: EndpointThread) -> None:
        """Wait for the end of an output, and keep those that are stuck."""
        if not thread.join():
            self._stuck.append(thread)
        self._stuck = [each for each in self._stuck if not each.has_ended]
