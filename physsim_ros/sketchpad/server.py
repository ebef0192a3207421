# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The server of the page: HTTP and web sockets, on a thread of its own.

Laws: the world's thread never waits for a page; answers are not dropped.
"""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
import threading

from physsim_ros.files import OwnWorlds, shipped_pictures
from physsim_ros.model.errors import Busy
from physsim_ros.model.snapshot import Answer, Frame, Snapshot
from physsim_ros.sketchpad.access import Access, Role
from physsim_ros.sketchpad.answers import asker_of
from physsim_ros.sketchpad.autosave import Autosave
from physsim_ros.sketchpad.frame_feed import FrameFeed
from physsim_ros.sketchpad.gallery import gallery_content
from physsim_ros.sketchpad.handlers import CookieCheck, Files, Login, Missing, Page
from physsim_ros.sketchpad.inbox import Inbox, Incoming, SERVER
from physsim_ros.sketchpad.listening import BoundedServer, listening_sockets, reachable_host
from physsim_ros.sketchpad.messages import Upload
from physsim_ros.sketchpad.open_pages import OpenPages
from physsim_ros.sketchpad.page_requests import Content
from physsim_ros.sketchpad.page_socket import PageSocket
from physsim_ros.sketchpad.recording_handlers import recording_routes, Recordings
from physsim_ros.sketchpad.scene_codec import compact
from physsim_ros.sketchpad.world_handlers import Download, Picture, Unsaved, UploadWorld
from tornado.web import Application

# Of a message of a page, and of an uploaded world [bytes].
MOST_BYTES = 2**20
# From one ping to the next, and until a page without an answer is closed [s].
PING_PERIOD = 10.0
# For the thread to end [s].
_CLOSING = 2.0

PAGE = Path(__file__).with_name('page')


class Server:
    """
    The server of one world.

    :param address: to listen on
    :param port: to listen on; where it is taken, one of the next; 0 is any
    :param world_dir: directory of the user's worlds
    :param autosave: of the world
    :param recordings: the viewer
    :param inbox: takes the messages of the pages
    :param wake: called on the server's thread after a message has come
    :raises PhysSimError: it cannot listen there

    :ivar access: its tokens
    :ivar port: that it listens on
    :ivar pages: that are open
    :ivar feed: frames on their way to the pages
    """

    def __init__(
        self,
        *,
        address: str,
        port: int,
        world_dir: Path,
        autosave: Autosave,
        recordings: Recordings,
        inbox: Inbox,
        wake: Callable[[], None],
    ) -> None:
        self.page_directory = PAGE
        self.world_dir = world_dir
        self.own_worlds = OwnWorlds(world_dir)
        self.autosave = autosave
        self._recordings = recordings
        self._address = address
        self._inbox = inbox
        self._wake = wake
        self._sockets = listening_sockets(address, port)
        self.port: int = self._sockets[0].getsockname()[1]
        self.access = Access(address, self.port)
        self.pages = OpenPages()
        # Number of the last upload.
        self._uploads = 0
        self._replies: dict[str, asyncio.Future[Answer]] = {}
        # Written by the world's thread.
        self._outbox: deque[tuple[int | None, Content] | tuple[Answer, ...]] = deque()
        self._scheduled = False
        self._loop = asyncio.new_event_loop()
        self.feed = FrameFeed(self.pages, self._loop)
        self._ended = asyncio.Event()
        self._thread = threading.Thread(target=self._run, name='sketchpad', daemon=True)
        self._thread.start()

    # The world's thread

    def url(self, role: Role) -> str:
        """Return the address of a page with its token."""
        host = reachable_host(self._address)
        return f'http://{host}:{self.port}/login?token={self.access.tokens[role]}'

    def show(self, frame: Frame, ghost: Snapshot | None = None) -> None:
        """
        Send a frame, and its answers, to all pages.

        :param ghost: of a course that was left, at the same time; None where there is none
        """
        self.feed.newest = frame, ghost
        if frame.answers:
            self._outbox.append(frame.answers)
        self._schedule()

    def keep(self, frame: Frame) -> None:
        """Keep a frame for the first page to come."""
        self.feed.newest = frame, None

    @property
    def has_pages(self) -> bool:
        """Whether a page is open, or an upload waits for its answer."""
        return bool(self.pages or self._replies)

    def send(self, content: Content, page: int | None = None) -> None:
        """
        Send a message.

        :param content: becomes JSON on the server's thread, and must not change until then
        :param page: number of the page; None is all of them
        """
        self._outbox.append((page, content))
        self._schedule()

    def answer(self, answers: tuple[Answer, ...]) -> None:
        """Send answers outside of a frame."""
        self._outbox.append(answers)
        self._schedule()

    def call_soon(self, callback: Callable[[], None]) -> None:
        """Have the server's thread call something; it does not where it has ended."""
        with suppress(RuntimeError):
            self._loop.call_soon_threadsafe(callback)

    def list_worlds(self) -> None:
        """Have all pages told which worlds there are now."""
        self.call_soon(self._send_worlds)

    def close(self) -> None:
        """Close all pages, and end the thread."""
        try:
            self._loop.call_soon_threadsafe(self._ended.set)
        except RuntimeError:
            # The loop has ended by itself.
            return
        self._thread.join(_CLOSING)

    def _schedule(self) -> None:
        """Have the server's thread send the newest frame and all messages of the outbox, once."""
        if self._scheduled or not self._thread.is_alive():
            return
        self._scheduled = True
        self._loop.call_soon_threadsafe(self._flush)

    # The server's thread

    def add_page(self, page: PageSocket) -> int:
        """Begin to send frames to a page; return its number."""
        number = self.pages.add(page)
        page.send(compact(gallery_content(self.world_dir, self.own_worlds)))
        self.feed.send_frame()
        self.feed.update_page(page)
        return number

    def inbox_put(self, incoming: Incoming) -> bool:
        """Hand a message to the world's thread; return whether there was room for it."""
        if not self._inbox.put(incoming):
            return False
        self._wake()
        return True

    async def upload(self, upload: Upload, patience: float) -> Answer:
        """
        Have the world's thread replace the world by that of a file, and return the answer.

        :param patience: until it has begun [s]
        :raises Busy: it has not; nothing is done
        """
        self._uploads += 1
        request_id = str(self._uploads)
        reply: asyncio.Future[Answer] = self._loop.create_future()
        self._replies[request_id] = reply
        try:
            if self.inbox_put(Incoming(SERVER, request_id, upload)):
                await asyncio.wait([reply], timeout=patience)
            if not reply.done() and upload.take() is not None:
                raise Busy('the world is too busy; nothing was done')
            return await reply
        finally:
            del self._replies[request_id]

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        try:
            self._loop.run_until_complete(self._serve())
        finally:
            self._loop.close()

    async def _serve(self) -> None:
        server = BoundedServer(
            self._application(),
            max_body_size=MOST_BYTES,
            max_buffer_size=2 * MOST_BYTES,
            max_header_size=2**16,
            idle_connection_timeout=10.0,
            body_timeout=10.0,
        )
        server.add_sockets(self._sockets)
        await self._ended.wait()
        server.stop()
        for page in self.pages:
            page.close(1001, 'the world has ended')
        await server.close_all_connections()

    def _application(self) -> Application:
        own = {'server': self}
        return Application(
            [
                ('/', Page, own),
                ('/login', Login, own),
                ('/session', CookieCheck, own),
                *recording_routes(self, self._recordings),
                ('/ws', PageSocket, own),
                ('/page/(.*)', Files, own | {'path': self.page_directory}),
                ('/gallery/(.*)', Files, own | {'path': shipped_pictures()}),
                ('/world', UploadWorld, own),
                (r'/world/([^/]+)\.yaml', Download, own),
                ('/unsaved', Unsaved, own),
                (r'/picture/([^/]+)', Picture, own),
            ],
            server=self,
            compress_response=True,
            default_handler_class=Missing,
            default_handler_args=own,
            websocket_max_message_size=MOST_BYTES,
            websocket_ping_interval=PING_PERIOD,
            websocket_ping_timeout=PING_PERIOD,
            # Answers with an error are the business of those who asked.
            log_function=lambda _: None,
        )

    def _flush(self) -> None:
        """Send what the world's thread has left here."""
        self._scheduled = False
        while self._outbox:
            item = self._outbox.popleft()
            if isinstance(item[0], Answer):
                self._resolve_replies(item)
                self.pages.send_answers(item)
            else:
                page, content = item
                self.pages.send(compact(content() if callable(content) else content), page=page)
        self.feed.send_frame()

    def _send_worlds(self) -> None:
        self.pages.send(compact(gallery_content(self.world_dir, self.own_worlds)))

    def _resolve_replies(self, answers: tuple[Answer, ...]) -> None:
        """Give the answers to those who wait for an upload."""
        for answer in answers:
            page, id_ = asker_of(answer.asker)
            if page == SERVER and id_ in self._replies:
                self._replies[id_].set_result(answer)
