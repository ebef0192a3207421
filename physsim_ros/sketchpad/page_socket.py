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
The socket of one page, on the server's thread.

Laws: a page that does not read is skipped, never waited for; what it sends is limited in size,
rate and depth, and checked before anything else sees it.
"""

from __future__ import annotations

from asyncio import Future
import time
from typing import TYPE_CHECKING

from physsim_ros.model.errors import Refusal
from physsim_ros.model.snapshot import Answer
from physsim_ros.sketchpad.access import Role
from physsim_ros.sketchpad.answers import answer_content
from physsim_ros.sketchpad.frame_codec import Show
from physsim_ros.sketchpad.handlers import Guarded
from physsim_ros.sketchpad.inbox import Closed, Incoming, Opened
from physsim_ros.sketchpad.messages import message_from, OF_VIEWERS, read_envelope, ShowParts
from physsim_ros.sketchpad.scene_codec import compact
from tornado.websocket import WebSocketClosedError, WebSocketHandler

if TYPE_CHECKING:
    from physsim_ros.sketchpad.server import Server

# Messages of a page: a second's worth in the long run, and at once. A pen and a hand send one each
# frame of the page, at 60 to 144 Hz.
RATE, BURST = 200.0, 400.0
# Bytes that a page leaves unread before it is closed: the scene of 20,000 bodies, and some more.
MOST_UNSENT = 16 * 2**20
# Codes of closing, RFC 6455, section 7.4.1.
_POLICY_VIOLATION, _TOO_BIG = 1008, 1009


class PageSocket(Guarded, WebSocketHandler):
    """
    The socket of a page.

    :ivar number: of the page, never used again
    :ivar show: the parts of a frame that it gets
    :ivar epoch: of the scene that was sent last; 0 before the first
    :ivar ghost_epoch: of the ghost's scene that was sent last; 0 where there is none
    :ivar frame: number of the frame that was sent last; 0 before the first
    """

    def initialize(self, server: Server) -> None:
        """Set the server, and begin without number."""
        super().initialize(server)
        self.number = 0
        self.show = Show.POSES
        self.epoch = self.ghost_epoch = self.frame = 0
        self.view_only = True
        self._unsent = 0
        self._tokens, self._refilled = BURST, time.monotonic()

    def check_origin(self, origin: str) -> bool:
        """Accept the pages of this server."""
        return self.server.access.allows_origin(origin, self.request.host)

    async def prepare(self) -> None:
        """Refuse a page without the right to be here, or one too many."""
        await super().prepare()
        # Browsers always send it; tornado asks only where it is there.
        self.require_origin()
        if self.server.is_full:
            self.refuse(503, 'there are as many pages open as there may be')

    def open(self) -> None:  # noqa: A003 - tornado's name
        """Welcome the page."""
        self.view_only = self.role is not Role.DRAW or 'view' in self.request.arguments
        self.set_nodelay(True)
        self.number = self.server.add_page(self)
        role = Role.VIEW if self.view_only else Role.DRAW
        self.server.inbox_put(Incoming(self.number, '', Opened(role=role)))

    def on_message(self, message: str | bytes) -> None:
        """Check a message and hand it to the world's thread."""
        if not self._take_token():
            return
        id_ = ''
        try:
            # Binary messages are no JSON either.
            envelope = read_envelope(message if isinstance(message, str) else '')
            id_ = envelope.request
            checked = message_from(envelope)
        except Refusal as refusal:
            self.answer(id_, Answer.refused(refusal, topic=''))
            return
        if isinstance(checked, ShowParts):
            self.show = checked.show
            self.server.note_parts()
            # Sent once more, with other parts.
            self.frame = 0
            self.server.feed.update_page(self)
        elif self.view_only and not isinstance(checked, OF_VIEWERS):
            message = 'this page only shows the world'
            self.answer(id_, Answer(topic='', code='view_only', message=message))
        elif not self.server.inbox_put(Incoming(self.number, id_, checked)):
            message = 'the world is too busy; nothing was done'
            self.answer(id_, Answer(topic='', code='busy', message=message))

    def on_ping(self, data: bytes) -> None:  # noqa: ARG002 - tornado's name
        """Count a ping, which tornado has answered, among the messages; no browser sends any."""
        self._take_token()

    def on_pong(self, data: bytes) -> None:  # noqa: ARG002 - tornado's name
        """Count a pong among the messages; a browser sends one for each ping of the server."""
        self._take_token()

    def on_close(self) -> None:
        """Forget the page."""
        if self.number:
            self.server.remove_page(self)
            self.server.inbox_put(Incoming(self.number, '', Closed()))

    def answer(self, id_: str, answer: Answer) -> None:
        """Answer a message of this page that did not reach the world, by no topic."""
        self.send(compact(answer_content(answer, id_)))

    @property
    def is_busy(self) -> bool:
        """Whether bytes are on their way to it."""
        return self._unsent > 0

    def send(self, message: str | bytes) -> None:
        """Send a message; a page that has left too much unread is closed instead."""
        size = len(message)
        if self._unsent + size > MOST_UNSENT:
            self.close(_TOO_BIG, 'too much left unread')
            return
        try:
            sent = self.write_message(message, binary=isinstance(message, bytes))
        except WebSocketClosedError:
            return
        self._unsent += size

        def done(future: Future[None]) -> None:
            self._unsent -= size
            if future.cancelled() or future.exception() is not None:
                # It is being closed.
                return
            if not self._unsent:
                self.server.feed.update_page(self)

        sent.add_done_callback(done)

    def _take_token(self) -> bool:
        """
        Take a token of the bucket that limits the rate of messages.

        :return: whether there was one; without one the page is closed
        """
        now = time.monotonic()
        self._tokens = min(BURST, self._tokens + RATE * (now - self._refilled))
        self._refilled = now
        if self._tokens < 1.0:
            self.close(_POLICY_VIOLATION, 'too many messages')
            return False
        self._tokens -= 1.0
        return True
