# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The server of the page: HTTP and web sockets, on a thread of its own.

Laws: the world's thread never waits for a page; answers are not dropped.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from functools import partial
from pathlib import Path
import threading
from typing import Any

from physsim_ros.files import OwnWorlds
from physsim_ros.model.answer import Answer
from physsim_ros.model.snapshot import Frame, Snapshot
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.sketchpad.autosave import Autosave
from physsim_ros.sketchpad.inbox import Inbox
from physsim_ros.sketchpad.message import Content
from physsim_ros.sketchpad.rights import Role
from physsim_ros.sketchpad.server.frame_feed import FrameFeed
from physsim_ros.sketchpad.server.gallery import Gallery, gallery_content
from physsim_ros.sketchpad.server.guarded import LEFT
from physsim_ros.sketchpad.server.page_handlers import ResultList
from physsim_ros.sketchpad.server.page_socket import PageSocket
from physsim_ros.sketchpad.server.scene_codec import compact
from physsim_ros.sketchpad.server.website import BoundedServer, Site
from physsim_ros.sketchpad.server.world_handlers import (
    Download,
    MOST_UPLOADS,
    Picture,
    Unsaved,
    UploadWorld,
    WorldPicture,
)

# Size of a message of a page, and of a request that is no upload [bytes].
MOST_BYTES = 2**20
# Time from one ping to the next, and until a page without an answer is closed [s].
PING_PERIOD = 10.0
# Time for the thread to end [s].
_CLOSING = 2.0


class Server:
    """
    The server of one world; its methods are those of the world's thread.

    :param address: to listen on
    :param port: to listen on; where it is taken, one of the next; 0 is any
    :param own_worlds: of the user
    :param autosave: of the world
    :param results: file of the results of lessons in the world
    :param inbox: receives the messages of the pages
    :param boundary: of the node
    :raises PhysSimError: it cannot listen there
    """

    def __init__(
        self,
        *,
        address: str,
        port: int,
        own_worlds: OwnWorlds,
        autosave: Autosave,
        results: Path,
        inbox: Inbox,
        boundary: ErrorBoundary,
    ) -> None:
        self._boundary = boundary
        read = partial(gallery_content, own_worlds, boundary)
        self._gallery = Gallery(read, self._send, boundary)
        self._site = Site(address, port)
        self._loop = asyncio.new_event_loop()
        self._feed = FrameFeed(self._loop)
        turns = asyncio.Semaphore(MOST_UPLOADS)
        self._application = self._site.application(
            'index.html',
            [
                (
                    '/ws',
                    PageSocket,
                    {'feed': self._feed, 'inbox': inbox, 'gallery': self._gallery},
                ),
                (r'/gallery/([^/]+)\.svg', WorldPicture, {'own_worlds': own_worlds}),
                ('/world', UploadWorld, {'inbox': inbox, 'turns': turns}),
                (r'/world/([^/]+)\.yaml', Download, {'own_worlds': own_worlds}),
                ('/results', ResultList, {'files': [results]}),
                ('/unsaved', Unsaved, {'autosave': autosave}),
                (
                    r'/picture/([^/]+)',
                    Picture,
                    {'own_worlds': own_worlds, 'on_change': self.list_worlds},
                ),
            ],
            boundary,
            websocket_max_message_size=MOST_BYTES,
            websocket_ping_interval=PING_PERIOD,
            websocket_ping_timeout=PING_PERIOD,
        )
        self._ended = asyncio.Event()
        self._thread = threading.Thread(target=self._run, name='sketchpad', daemon=True)
        self._thread.start()

    @property
    def wants_contacts(self) -> bool:
        """Whether a page shows contacts."""
        return self._feed.pages.wants_contacts

    def url(self, role: Role) -> str:
        """Return the address of a page with its token."""
        return self._site.url(role)

    def show(self, frame: Frame, ghost: Snapshot | None, timeline: Content | None = None) -> None:
        """
        Send the answers of a frame, the timeline that goes with it, and the frame to all pages.

        :param ghost: of a course that was left, at the same time; None where there is no such
        :param timeline: where it has changed
        """
        self._post(partial(self._show, frame, ghost, timeline))

    def answer(self, answers: tuple[Answer, ...]) -> None:
        """Send answers that no frame carries."""
        if answers:
            self._post(partial(self._feed.pages.send_answers, answers))

    def send(self, content: Content, page: int | None = None) -> None:
        """
        Send a message.

        :param content: becomes JSON on the server's thread, and must not change until then
        :param page: number of the page; None is all pages
        """
        self._post(partial(self._send, content, page))

    def list_worlds(self, page: int | None = None) -> None:
        """Send the list of worlds to a page, or to all."""
        self._post(partial(self._gallery.send_to, page))

    def ask_to_leave(self) -> None:
        """Ask the pupils who have come until now to leave, also those whose pages are asleep."""
        self._post(self._feed.pages.ask_to_leave)

    def close(self) -> None:
        """Close all pages, and end the thread."""
        try:
            self._loop.call_soon_threadsafe(self._ended.set)
        except RuntimeError:
            # The loop has ended by itself.
            return
        self._thread.join(_CLOSING)

    def _post(self, call: Callable[[], None]) -> None:
        """Queue a call for the server's thread."""
        if self._thread.is_alive():
            self._loop.call_soon_threadsafe(self._carry_out, call)

    # The server's thread

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        self._loop.set_exception_handler(self._note_error)
        try:
            self._loop.run_until_complete(self._serve())
        finally:
            self._loop.close()

    def _note_error(self, loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
        """Note an unexpected error of a callback of the loop; a page that has left is none."""
        match context.get('exception'):
            case None:
                loop.default_exception_handler(context)
            case error if not isinstance(error, LEFT):
                self._boundary.failed('page', error)

    async def _serve(self) -> None:
        server = BoundedServer(
            self._application,
            max_body_size=MOST_BYTES,
            max_buffer_size=2 * MOST_BYTES,
        )
        server.add_sockets(self._site.sockets)
        await self._ended.wait()
        server.stop()
        self._gallery.close()
        for page in self._feed.pages:
            page.close(1001, 'the world has ended')
        await server.close_all_connections()

    def _carry_out(self, call: Callable[[], None]) -> None:
        with self._boundary.containing('page'):
            call()

    def _show(self, frame: Frame, ghost: Snapshot | None, timeline: Content | None) -> None:
        """Send what belongs to a frame, and then the frame, if no newer one has come."""
        self._feed.pages.send_answers(frame.answers)
        if timeline is not None:
            self._send(timeline)
        self._feed.newest = frame, ghost
        # Behind the calls that have come meanwhile.
        self._loop.call_soon(self._feed.send_frame)

    def _send(self, content: Content, page: int | None = None) -> None:
        text = compact(content() if callable(content) else content)
        self._feed.pages.send(text, page)
