# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The socket of one page, on the server's thread.

Laws: a page that does not read is skipped, never waited for; what it sends is limited in size,
rate and depth, and checked before anything else sees it.
"""

from __future__ import annotations

from asyncio import Future
from typing import TYPE_CHECKING

from physsim_ros.model.errors import Busy, Refusal
from physsim_ros.model.snapshot import Answer
from physsim_ros.sketchpad.access import Role
from physsim_ros.sketchpad.answers import answer_content
from physsim_ros.sketchpad.frame_codec import Show
from physsim_ros.sketchpad.guarded_socket import GuardedSocket, TOO_BIG
from physsim_ros.sketchpad.inbox import Closed, Incoming, Opened
from physsim_ros.sketchpad.messages import message_from, OF_VIEWERS, read_envelope, ShowParts
from physsim_ros.sketchpad.scene_codec import compact
from tornado.websocket import WebSocketClosedError

if TYPE_CHECKING:
    from physsim_ros.sketchpad.server import Server

# Size of the messages that a page leaves unread before it is closed [bytes]: tens of thousands of
# answers. The newest frame and its scenes, which have the size of the world, do not count.
MOST_UNREAD = 16 * 2**20


class PageSocket(GuardedSocket):
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
        # Messages on their way to it, and the size of those that count [bytes].
        self._under_way = self._unread = 0

    @property
    def too_many(self) -> str:
        """Return why one more is refused; '' where there is room for it."""
        return 'there are as many pages open as there may be' if self.server.pages.is_full else ''

    def open(self) -> None:  # noqa: A003 - tornado's name
        """Welcome the page."""
        self.view_only = self.role is not Role.DRAW or 'view' in self.request.arguments
        self.set_nodelay(True)
        self.number = self.server.add_page(self)
        role = Role.VIEW if self.view_only else Role.DRAW
        self.server.inbox_put(Incoming(self.number, '', Opened(role=role)))

    def receive(self, message: str | bytes) -> None:
        """Check a message and hand it to the world's thread."""
        id_ = ''
        try:
            # Binary messages are no JSON either.
            envelope = read_envelope(message if isinstance(message, str) else '')
            id_ = envelope.request
            checked = message_from(envelope)
        except Refusal as refusal:
            self._answer(id_, Answer.refused(refusal, topic=''))
            return
        if isinstance(checked, ShowParts):
            self.show = checked.show
            self.server.pages.note_parts()
            # Sent once more, with other parts.
            self.frame = 0
            self.server.feed.update_page(self)
        elif self.view_only and not isinstance(checked, OF_VIEWERS):
            self._refuse(id_, 'view_only', 'this page only shows the world')
        elif not self.server.inbox_put(Incoming(self.number, id_, checked)):
            self._refuse(id_, Busy.code, 'the world is too busy; nothing was done')

    def on_close(self) -> None:
        """Forget the page."""
        if self.number:
            self.server.pages.remove(self)
            self.server.inbox_put(Incoming(self.number, '', Closed()))

    @property
    def is_busy(self) -> bool:
        """Whether messages are on their way to it."""
        return self._under_way > 0

    def send(self, message: str) -> None:
        """Send a message; a page that has left too much unread is closed instead."""
        size = len(message)
        if self._unread + size > MOST_UNREAD:
            self.close(TOO_BIG, 'too much left unread')
        else:
            self._write(message, counting=size)

    def send_part(self, part: str | bytes) -> None:
        """Send a frame or a scene, of any size; the feed has none for a page that is busy."""
        self._write(part, counting=0)

    def _write(self, message: str | bytes, *, counting: int) -> None:
        try:
            sent = self.write_message(message, binary=isinstance(message, bytes))
        except WebSocketClosedError:
            return
        self._under_way += 1
        self._unread += counting

        def done(future: Future[None]) -> None:
            self._under_way -= 1
            self._unread -= counting
            if future.cancelled() or future.exception() is not None:
                # It is being closed.
                return
            if not self.is_busy:
                self.server.feed.update_page(self)

        sent.add_done_callback(done)

    def _refuse(self, id_: str, code: str, message: str) -> None:
        """Refuse a message of this page, which does not reach the world."""
        self._answer(id_, Answer(topic='', message=message, code=code))

    def _answer(self, id_: str, answer: Answer) -> None:
        """Answer a message of this page."""
        self.send(compact(answer_content(answer, id_)))
