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
from typing import Any

from physsim_ros.files import shipped_pictures
from physsim_ros.model.snapshot import Answer, Frame, Snapshot
from physsim_ros.sketchpad.access import Access, Role
from physsim_ros.sketchpad.answers import answer_content, asker_of
from physsim_ros.sketchpad.frame_codec import Show
from physsim_ros.sketchpad.frame_feed import FrameFeed
from physsim_ros.sketchpad.gallery import gallery_content
from physsim_ros.sketchpad.handlers import CookieCheck, Files, Login, Missing, Page
from physsim_ros.sketchpad.inbox import Inbox, Incoming, SERVER
from physsim_ros.sketchpad.listening import BoundedServer, listening_sockets, reachable_host
from physsim_ros.sketchpad.messages import Message
from physsim_ros.sketchpad.page_socket import PageSocket
from physsim_ros.sketchpad.recording_handlers import recording_routes, Recordings
from physsim_ros.sketchpad.scene_codec import compact
from physsim_ros.sketchpad.world_handlers import Download, UploadWorld
from tornado.web import Application

# Pages at once.
MOST_PAGES = 64
# Of a message of a page, and of an uploaded world [bytes].
MOST_BYTES = 2**20
# From one ping to the next, and until a page without an answer is closed [s].
PING_PERIOD = 10.0
# For the thread to end [s].
_CLOSING = 2.0
# Answers to others that are passed on, of one frame; the rest is counted.
MOST_QUIET = 20

PAGE = Path(__file__).with_name('page')


class Server:
    """
    The server of one world.

    :param address: to listen on
    :param port: to listen on; where it is taken, one of the next; 0 is any
    :param world_dir: directory of the user's worlds
    :param recordings: the viewer
    :param inbox: takes the messages of the pages
    :param wake: called on the server's thread after a message has come
    :raises PhysSimError: it cannot listen there

    :ivar access: its tokens
    :ivar port: that it listens on
    :ivar feed: frames on their way to the pages
    :ivar wants_contacts: whether a page asks for contacts
    """

    def __init__(
        self,
        *,
        address: str,
        port: int,
        world_dir: Path,
        recordings: Recordings,
        inbox: Inbox,
        wake: Callable[[], None],
    ) -> None:
        self.page_directory = PAGE
        self.world_dir = world_dir
        self._recordings = recordings
        self._address = address
        self._inbox = inbox
        self._wake = wake
        self._sockets = listening_sockets(address, port)
        self.port: int = self._sockets[0].getsockname()[1]
        self.access = Access(address, self.port)
        self._pages: dict[int, PageSocket] = {}
        self.wants_contacts = False
        self._last_number = 0
        # Of the questions of the server itself.
        self._asked = 0
        self._replies: dict[str, asyncio.Future[Answer]] = {}
        # Written by the world's thread.
        self._outbox: deque[tuple[int | None, str] | tuple[Answer, ...]] = deque()
        self._scheduled = False
        self._loop = asyncio.new_event_loop()
        self.feed = FrameFeed(self._pages.values(), self._loop)
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
        return bool(self._pages or self._replies)

    def send(self, content: dict[str, Any], *, page: int | None = None) -> None:
        """
        Send a message.

        :param content: becomes JSON
        :param page: number of the page; None is all of them
        """
        self._outbox.append((page, compact(content)))
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

    @property
    def is_full(self) -> bool:
        """Whether there are as many pages as there may be."""
        return len(self._pages) >= MOST_PAGES

    def add_page(self, page: PageSocket) -> int:
        """Begin to send frames to a page; return its number."""
        self._last_number += 1
        self._pages[self._last_number] = page
        page.send(compact(gallery_content(self.world_dir)))
        self.feed.send_frame()
        self.feed.update_page(page)
        return self._last_number

    def remove_page(self, page: PageSocket) -> None:
        """Send nothing more to a page."""
        self._pages.pop(page.number, None)
        self.note_parts()

    def note_parts(self) -> None:
        """Note which parts of a frame the pages ask for."""
        self.wants_contacts = any(Show.CONTACTS in page.show for page in self._pages.values())

    def inbox_put(self, incoming: Incoming) -> bool:
        """Hand a message to the world's thread; return whether there was room for it."""
        if not self._inbox.put(incoming):
            return False
        self._wake()
        return True

    async def ask(self, message: Message) -> Answer:
        """Have the world's thread handle a message of the server itself; return the answer."""
        self._asked += 1
        request_id = str(self._asked)
        reply: asyncio.Future[Answer] = self._loop.create_future()
        self._replies[request_id] = reply
        try:
            self.inbox_put(Incoming(SERVER, request_id, message))
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
        for page in list(self._pages.values()):
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
                self._send_answers(item)
            else:
                number, text = item
                pages = self._pages.values() if number is None else [self._pages.get(number)]
                for page in list(pages):
                    if page is not None:
                        page.send(text)
        self.feed.send_frame()

    def _send_worlds(self) -> None:
        text = compact(gallery_content(self.world_dir))
        for page in list(self._pages.values()):
            page.send(text)

    def _send_answers(self, answers: tuple[Answer, ...]) -> None:
        quiet: list[str] = []
        others = 0
        for answer in answers:
            number, id_ = asker_of(answer.asker)
            page = self._pages.get(number)
            if page is not None:
                page.send(compact(answer_content(answer, id_)))
            elif number == SERVER and id_ in self._replies:
                self._replies[id_].set_result(answer)
            others += 1
            if others <= MOST_QUIET:
                quiet.append(compact(answer_content(answer, '')))
                for each in list(self._pages.values()):
                    if each is not page:
                        each.send(quiet[-1])
        if others > MOST_QUIET:
            more = Answer(topic='events', message=f'and {others - MOST_QUIET} more answers')
            text = compact(answer_content(more, ''))
            for each in list(self._pages.values()):
                each.send(text)
