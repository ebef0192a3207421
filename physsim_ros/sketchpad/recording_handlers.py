# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The recording beside the page: the web viewer of Rerun, and the stream that it shows.

Laws: a browser calls no other origin: the viewer's files come through this server, from the
program that serves them on loopback, and the policy of the page forbids all other hosts. A page is
sent the next batch of its stream when it shows the last one.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from importlib.metadata import version
import time
from typing import Any, Protocol
from urllib.parse import urlsplit

from physsim_ros.sketchpad.access import headers_for
from physsim_ros.sketchpad.guarded import Guarded, GuardedSocket, POLICY_VIOLATION, TYPES
from physsim_ros.sketchpad.page_handlers import PAGE
from physsim_ros.sketchpad.scene_codec import compact
from tornado.httpclient import AsyncHTTPClient, HTTPClientError
from tornado.iostream import StreamClosedError
from tornado.websocket import WebSocketClosedError

# Recordings that are watched at once: each has a thread, and logs every frame.
MOST_RECORDINGS = 4
# Time to pass on a file of the viewer, of some 40 MB [s].
_FILE_TIMEOUT = 60.0
# Time for the program to start; at its first use 290 MB are read from disk [s].
_START_TIMEOUT = 30.0
# Time from one try to reach it to the next [s].
_RETRY_PERIOD = 0.1


class Recordings(Protocol):
    """The viewer, as this server uses it; `open_page` returns a page."""

    @property
    def is_opening(self) -> bool:
        """Whether the viewer is being opened, so that it may have a web page soon."""

    @property
    def page_address(self) -> str:
        """Return the address of the viewer's own web page on loopback; '' without one."""

    def open_page(self, send: Callable[[bytes, int], None]) -> Any:
        """
        Begin a recording for a page.

        :param send: takes a batch, and the time of its last frame [ns]; called on any thread
        :return: the page; its `note_shown` takes the time that the page shows [ns]
        """

    def close_page(self, page: Any) -> None:
        """End the recording of a page."""


def recording_routes(recordings: Recordings) -> list[tuple[str, type, Any]]:
    """Return the routes below `/rerun/`."""
    own = {'recordings': recordings}
    return [
        ('/rerun/', RecordingPage, own),
        # No other file of the viewer's own server is passed on.
        (r'/rerun/(re_viewer\.js|re_viewer_bg\.wasm)', ViewerFile, own),
        ('/rerun/ws', RecordingSocket, own | {'sockets': set()}),
    ]


class _OfRecording(Guarded):
    """A handler that needs the viewer's web page."""

    def initialize(self, recordings: Recordings) -> None:
        """Set the viewer."""
        super().initialize()
        self.recordings = recordings

    async def prepare(self) -> None:
        """Refuse a request where the viewer does not serve browsers, once it is open."""
        await super().prepare()
        until = time.monotonic() + _START_TIMEOUT
        # On a thread of the viewer, which knows no event loop.
        while self.recordings.is_opening and time.monotonic() < until:  # noqa: ASYNC110
            await asyncio.sleep(_RETRY_PERIOD)
        if not self.recordings.page_address:
            self.refuse(404, 'there is no recording in a browser: set viewer to web')


class RecordingPage(_OfRecording):
    """The page that the viewer runs in."""

    async def get(self) -> None:
        """Answer with the page, which may compile the viewer's WebAssembly."""
        policy = headers_for(self.request.host)['Content-Security-Policy']
        policy = policy.replace("script-src 'self'", "script-src 'self' 'wasm-unsafe-eval'")
        self.set_header('Content-Security-Policy', policy)
        self.set_header('Content-Type', TYPES['.html'])
        self.finish((PAGE / 'recording.html').read_bytes())


class ViewerFile(_OfRecording):
    """A file of the web viewer, from the program that serves it on this machine."""

    async def get(self, name: str) -> None:
        """Pass it on, as fast as the browser reads, as soon as the program is up."""
        self.set_header('Content-Type', TYPES[f'.{name.rpartition(".")[2]}'])
        # A browser that has this version loads no 43 MB, and keeps its compiled code.
        self.set_header('Etag', f'"{version("rerun-sdk")}"')
        if self.check_etag_header():
            self.set_status(304)
            self.finish()
            return
        until = time.monotonic() + _START_TIMEOUT
        while not await self._passed_on(name):
            if time.monotonic() > until:
                self.refuse(502, 'the viewer does not answer; it may be starting')
            await asyncio.sleep(_RETRY_PERIOD)

    async def _passed_on(self, name: str) -> bool:
        """Pass the file on; return False where the program does not listen yet."""
        port = urlsplit(self.recordings.page_address).port
        self._found = False
        try:
            await AsyncHTTPClient().fetch(
                f'http://127.0.0.1:{port}/{name}',
                header_callback=self._note_status,
                streaming_callback=self._pass_on,
                request_timeout=_FILE_TIMEOUT,
            )
        except ConnectionRefusedError:
            return False
        except StreamClosedError:
            # The browser has left.
            return True
        except (HTTPClientError, OSError):
            self.refuse(502, 'the viewer does not have it')
        self.finish()
        return True

    def _note_status(self, line: str) -> None:
        if line.startswith('HTTP/'):
            self._found = line.split()[1] == '200'

    async def _pass_on(self, chunk: bytes) -> None:
        if self._found:
            self.write(chunk)
            await self.flush()


class RecordingSocket(_OfRecording, GuardedSocket):
    """The stream of a recording to one page, and the time that the page shows."""

    def initialize(  # type: ignore[override]
        self, recordings: Recordings, sockets: set[RecordingSocket]
    ) -> None:
        """Set the viewer and the open sockets."""
        super().initialize(recordings)
        self._sockets = sockets
        self._loop = asyncio.get_running_loop()
        self._page: Any = None

    @property
    def too_many(self) -> str:
        """Return why one more is refused; '' where there is room for it."""
        room = len(self._sockets) < MOST_RECORDINGS
        return '' if room else 'there are as many recordings open as there may be'

    def open(self) -> None:  # noqa: A003 - tornado's name
        """Begin the recording."""
        self.set_nodelay(True)
        self._sockets.add(self)
        self._page = self.recordings.open_page(self._send_soon)

    def on_message(self, message: str | bytes) -> None:
        """Note which frame the page shows: its time [ns], as digits."""
        if not self.take_token():
            return
        try:
            self._page.note_shown(int(message[:20]))
        except ValueError:
            self.close(POLICY_VIOLATION, 'not a time')

    def on_close(self) -> None:
        """End the recording."""
        if self._page is not None:
            self._sockets.discard(self)
            self.recordings.close_page(self._page)

    def _send_soon(self, batch: bytes, recorded: int) -> None:
        """Send a batch; called on the thread of the recording."""
        # The loop has ended where the server is closed.
        with suppress(RuntimeError):
            self._loop.call_soon_threadsafe(self._send, batch, recorded)

    def _send(self, batch: bytes, recorded: int) -> None:
        try:
            self.write_message(compact({'recorded': recorded}))
            self.write_message(batch, binary=True)
        except WebSocketClosedError:
            return
