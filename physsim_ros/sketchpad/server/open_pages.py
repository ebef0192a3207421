# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The open pages on the server's thread, and the messages to one page or to all.

Laws: a page that does not read is skipped, never waited for; a page gets every answer to its own
messages, and of those to others the first ones of each frame.
"""

from __future__ import annotations

from asyncio import AbstractEventLoop, Future
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any

from physsim_ros.model.answer import Answer
from physsim_ros.model.transform import Point
from physsim_ros.model.translation import Text
from physsim_ros.sketchpad.message import answer_content, asker_of
from physsim_ros.sketchpad.server.frame_codec import Show
from physsim_ros.sketchpad.server.guarded import REPLACED, TOO_BIG
from physsim_ros.sketchpad.server.scene_codec import compact
from tornado.websocket import WebSocketClosedError, WebSocketHandler

# Pages at once.
MOST_PAGES = 64
# People whose last messages are known, at least all of those who may come back.
MOST_PEOPLE = 4 * MOST_PAGES
# Time in which moves of cursors are collected [s].
CURSOR_PERIOD = 0.1
# Answers of a frame, from its first on, that go to pages which did not ask; the rest is counted.
MOST_ANSWERS_TO_OTHERS = 20
# Unread messages of a page that is not closed yet [bytes]: tens of thousands of answers. The
# newest frame and its scenes, which have the size of the world, do not count.
MOST_UNREAD = 16 * 2**20

# Message that asks the pages of pupils to leave this world.
LEAVE = compact({'type': 'leave'})


class OpenPage:
    """
    An open page, as the server sends to it.

    :param socket: of the page
    :param number: of the page, never used again
    :param person: number of the person at it: that of the first page of this person
    :param on_read: called with the page when it has read all that it was sent

    :ivar show: the parts of a frame that it gets
    :ivar robot: name of the robot whose laser it shows; '' is none
    :ivar epoch: of the scene that was sent last; 0 before the first
    :ivar battery: message of the charge of that robot that was sent last
    :ivar ghost_epoch: of the ghost's scene that was sent last; 0 where there is no ghost
    :ivar frame: number of the frame that was sent last; 0 before the first
    :ivar period: least time from one frame to the next [s]
    :ivar due: steady time of the next frame [s]
    """

    def __init__(
        self,
        socket: WebSocketHandler,
        number: int,
        person: int,
        on_read: Callable[[OpenPage], None],
    ) -> None:
        self.number = number
        self.person = person
        self.show = Show.POSES
        self.robot = ''
        self.battery: Mapping[str, Any] = {}
        self.epoch = self.ghost_epoch = self.frame = 0
        self.period = self.due = 0.0
        self._socket = socket
        self._on_read = on_read
        # Messages on their way to the page, and the size of those that count [bytes].
        self._under_way = self._unread = 0

    @property
    def is_busy(self) -> bool:
        """Whether messages are on their way to the page."""
        return self._under_way > 0

    def send(self, text: str) -> None:
        """Send a message; a page that has left too much unread is closed instead."""
        size = len(text)
        if self._unread + size > MOST_UNREAD:
            self.close(TOO_BIG, 'too much left unread')
        else:
            self._write(text, counting=size)

    def send_part(self, part: str | bytes) -> None:
        """Send a frame or a scene, of any size, to a page that is not busy."""
        self._write(part, counting=0)

    def close(self, code: int, reason: str) -> None:
        """Close the page, which is forgotten at once: it may be out of reach."""
        self._socket.close(code, reason)
        self._socket.on_close()

    def _write(self, message: str | bytes, *, counting: int) -> None:
        try:
            sent = self._socket.write_message(message, binary=isinstance(message, bytes))
        except WebSocketClosedError:
            return
        self._under_way += 1
        self._unread += counting

        def done(future: Future[None]) -> None:
            self._under_way -= 1
            self._unread -= counting
            if future.cancelled() or future.exception() is not None:
                # The page is being closed.
                return
            if not self.is_busy:
                self._on_read(self)

        sent.add_done_callback(done)


class OpenPages:
    """
    The open pages by their numbers.

    :param loop: of the server's thread

    :ivar wants_contacts: whether a page shows contacts; read by the world's thread
    :ivar received: identifiers of the last messages of people, by their numbers
    """

    def __init__(self, loop: AbstractEventLoop) -> None:
        self.wants_contacts = False
        self.received: dict[int, str] = {}
        self._loop = loop
        self._pages: dict[int, OpenPage] = {}
        self._last_number = 0
        # Greatest number of the people who were asked to leave; 0 before.
        self._left = 0
        # Points of cursors that moved and were not sent yet [m], by page.
        self._cursors: dict[int, Point] = {}

    def __len__(self) -> int:
        return len(self._pages)

    def __iter__(self) -> Iterator[OpenPage]:
        # A page that does not read is closed, and removed, while it is sent something.
        return iter(list(self._pages.values()))

    def add(
        self,
        socket: WebSocketHandler,
        person: int | None,
        on_read: Callable[[OpenPage], None],
    ) -> OpenPage:
        """
        Add the page of a socket, in place of the one of its person.

        :param person: number of the person at it; None for a new one
        """
        for page in self:
            if page.person == person:
                page.close(REPLACED, 'this page is open again')
        self._last_number += 1
        page = OpenPage(socket, self._last_number, person or self._last_number, on_read)
        self._pages[page.number] = page
        return page

    def ask_to_leave(self) -> None:
        """Ask the pupils who have come until now to leave, also those whose pages are asleep."""
        self._left = self._last_number
        self.send(LEAVE)

    def has_left(self, person: int | None) -> bool:
        """Return whether a person was asked to leave; None is one who has not been here."""
        return person is not None and person <= self._left

    def remove(self, page: OpenPage) -> None:
        """Remove a page that is closed."""
        self._pages.pop(page.number, None)
        self.note_parts()

    def note_received(self, page: OpenPage, request: str) -> None:
        """
        Note the last message of a page: the person sends those after it again from a next page.

        :param request: identifier of the message
        """
        # The last one of the mapping is the one that came last.
        self.received.pop(page.person, None)
        self.received[page.person] = request
        if len(self.received) > MOST_PEOPLE:
            del self.received[next(iter(self.received))]

    def note_parts(self) -> None:
        """Note which parts of a frame the pages get."""
        self.wants_contacts = any(Show.CONTACTS in page.show for page in self)

    def send(self, text: str, number: int | None = None) -> None:
        """
        Send a message.

        :param number: of the page, which may be closed; None is all pages
        """
        for page in self if number is None else filter(None, [self._pages.get(number)]):
            page.send(text)

    def move_cursor(self, number: int, point: Point) -> None:
        """
        Note where the cursor of a page is, and send it to all after a while; no world knows of it.

        :param point: of the world [m]
        """
        if not self._cursors:
            self._loop.call_later(CURSOR_PERIOD, self._send_cursors)
        self._cursors[number] = point

    def _send_cursors(self) -> None:
        """Send one message with all cursors that have moved, however many."""
        moved, self._cursors = self._cursors, {}
        cursors = [[number, *point] for number, point in moved.items()]
        self.send(compact({'type': 'cursors', 'cursors': cursors}))

    def send_answers(self, answers: Sequence[Answer]) -> None:
        """Send each answer of a frame to the page that asked, and the first ones to all others."""
        if not self._pages:
            return
        # Answers after the first ones, by the page that asked.
        own: Counter[int] = Counter()
        for index, answer in enumerate(answers):
            asker, request = asker_of(answer.asker)
            self.send(compact(answer_content(answer, request)), asker)
            if index >= MOST_ANSWERS_TO_OTHERS:
                own[asker] += 1
                continue
            text = compact(answer_content(answer, '') | {'page': asker})
            for page in self:
                if page.number != asker:
                    page.send(text)
        for page in self:
            rest = len(answers) - MOST_ANSWERS_TO_OTHERS - own[page.number]
            if rest > 0:
                more = Answer(topic='events', message=Text('and {count} more answers', count=rest))
                page.send(compact(answer_content(more, '')))
