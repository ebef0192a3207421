# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The socket of one page, on the server's thread.

Law: messages of a page are limited in size, rate and depth, and checked before the world's thread
receives them.
"""

from __future__ import annotations

from physsim_ros.model.answer import Answer
from physsim_ros.model.checks import flag
from physsim_ros.model.errors import Busy, Refusal
from physsim_ros.model.transform import Point
from physsim_ros.sketchpad.inbox import Closed, Inbox, Opened
from physsim_ros.sketchpad.message import answer_content, Optional, server_message
from physsim_ros.sketchpad.messages import fields, read_message
from physsim_ros.sketchpad.rights import Right, Role
from physsim_ros.sketchpad.server.frame_codec import Show
from physsim_ros.sketchpad.server.frame_feed import FrameFeed
from physsim_ros.sketchpad.server.gallery import Gallery
from physsim_ros.sketchpad.server.guarded import GuardedSocket
from physsim_ros.sketchpad.server.open_pages import LEAVE, MOST_PAGES, OpenPage
from physsim_ros.sketchpad.server.scene_codec import compact

# Time from one frame to the next of a teacher's page that watches a class [s].
WATCH_PERIOD = 0.25


class PageSocket(GuardedSocket):
    """The socket of a page."""

    def initialize(  # type: ignore[override]
        self, feed: FrameFeed, inbox: Inbox, gallery: Gallery
    ) -> None:
        """
        Set the receivers of its messages.

        :param feed: of frames to the open pages
        :param inbox: of the world's thread
        :param gallery: sends the list of worlds and lessons
        """
        super().initialize()
        self.feed = feed
        self.gallery = gallery
        self._inbox = inbox
        self._page: OpenPage | None = None

    @property
    def too_many(self) -> str:
        """Return why one more page is refused; '' where there is room for it."""
        full = len(self.feed.pages) >= MOST_PAGES
        return 'there are as many pages open as there may be' if full else ''

    def open(self) -> None:  # noqa: A003 - tornado's name
        """Begin to send frames to the page, and tell the world's thread."""
        self.set_nodelay(True)
        if self.role is None or 'view' in self.request.arguments:
            self.role = Role.VIEW
        # One that connects again sends the key of its person.
        key = self.request.arguments.get('person', [b''])[-1]
        before = self.access.person_of(key)
        if self.role is Role.DRAW and self.feed.pages.has_left(before):
            # Nothing that was drawn meanwhile comes into the world of the next pupil.
            self.write_message(LEAVE)
            self.close()
            return
        self._page = self.feed.add_page(self, before)
        person = self._page.person
        watches = self.role is Role.TEACH and 'watch' in self.request.arguments
        self._page.period = WATCH_PERIOD if watches else 0.0
        opened = Opened(
            role=self.role,
            person=person,
            key=self.access.person_key(person),
            received=self.feed.pages.received.get(person, ''),
            goes_on='again' in self.request.arguments,
            watches=watches,
        )
        self._inbox.put(self._page.number, opened)

    def receive(self, message: str | bytes) -> None:
        """Check a message and hand it to the world's thread."""
        if self._page is None or self.role is None:
            return
        # A binary message is no JSON.
        text = message if isinstance(message, str) else ''
        request, checked = read_message(text, self.role, self.boundary)
        self.feed.pages.note_received(self._page, request)
        if isinstance(checked, Refusal):
            self._refuse(request, checked)
        elif not checked.kind.for_world:
            checked.kind.handle(self, self._page, **checked.arguments)
        elif not self._inbox.put(self._page.number, checked):
            self._refuse(request, Busy('the world is too busy; nothing was done'))

    def on_close(self) -> None:
        """Forget the page; it may be forgotten already."""
        if self._page is not None:
            page, self._page = self._page, None
            self.feed.pages.remove(page)
            # Nothing comes after it, even where tornado has buffered messages.
            self._inbox.put(page.number, Closed())

    def _refuse(self, request: str, refusal: Refusal) -> None:
        """Refuse a message, which does not reach the world."""
        if self._page is not None:
            answer = Answer.refused(refusal, topic='')
            self._page.send(compact(answer_content(answer, request)))


@server_message(
    'show',
    Right.LOOK,
    velocities=Optional(flag),
    contacts=Optional(flag),
    forces=Optional(flag),
    laser=Optional(fields.text),
)
def _show(
    socket: PageSocket,
    page: OpenPage,
    *,
    velocities: bool = False,
    contacts: bool = False,
    forces: bool = False,
    laser: str = '',
) -> None:
    """Choose what the frames of this page have: by default poses, and no robot's laser."""
    parts = (
        (Show.VELOCITIES if velocities else Show.POSES)
        | (Show.CONTACTS if contacts else Show.POSES)
        | (Show.FORCES if forces else Show.POSES)
    )
    socket.feed.show_parts(page, parts, laser)


@server_message('ping', Right.LOOK)
def _ping(socket: PageSocket, page: OpenPage) -> None:  # noqa: ARG001 - as the others
    """Answer `pong`, by which the page knows that its socket lives."""
    page.send(compact({'type': 'pong'}))


@server_message('here', Right.DRAW, point=fields.point)
def _here(socket: PageSocket, page: OpenPage, *, point: Point) -> None:
    """Show all pages where the cursor of this one is [m]."""
    socket.feed.pages.move_cursor(page.number, point)


@server_message('list', Right.LOOK)
def _list(socket: PageSocket, page: OpenPage) -> None:
    """Send this page the list of worlds and lessons as their files are now."""
    socket.gallery.send_to(page.number)
