# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The open pages of a server, and the messages that go to one of them, or to all.

Law: a page gets every answer to its own messages; of those to others, the first of each frame.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from physsim_ros.model.snapshot import Answer
from physsim_ros.sketchpad.answers import answer_content, asker_of
from physsim_ros.sketchpad.frame_codec import Show
from physsim_ros.sketchpad.scene_codec import compact

if TYPE_CHECKING:
    from physsim_ros.sketchpad.page_socket import PageSocket

# Pages at once.
MOST_PAGES = 64
# Answers of a frame, from its first on, that go to pages which did not ask; the rest is counted.
MOST_ANSWERS_TO_OTHERS = 20


class OpenPages:
    """
    The open pages, by their numbers, on the server's thread.

    :ivar wants_contacts: whether a page asks for contacts
    """

    def __init__(self) -> None:
        self.wants_contacts = False
        self._pages: dict[int, PageSocket] = {}
        self._last_number = 0

    def __len__(self) -> int:
        return len(self._pages)

    def __iter__(self) -> Iterator[PageSocket]:
        # A page that does not read is closed, and removed, when it is sent something.
        return iter(list(self._pages.values()))

    @property
    def is_full(self) -> bool:
        """Whether there are as many pages as there may be."""
        return len(self._pages) >= MOST_PAGES

    def add(self, page: PageSocket) -> int:
        """Add a page, and return its number."""
        self._last_number += 1
        self._pages[self._last_number] = page
        return self._last_number

    def remove(self, page: PageSocket) -> None:
        """Send nothing more to a page."""
        self._pages.pop(page.number, None)
        self.note_parts()

    def note_parts(self) -> None:
        """Note which parts of a frame the pages ask for."""
        self.wants_contacts = any(Show.CONTACTS in page.show for page in self._pages.values())

    def send(self, text: str, *, page: int | None = None) -> None:
        """
        Send a message.

        :param page: number of the page, which may be closed; None is all of them
        """
        receivers = self if page is None else filter(None, [self._pages.get(page)])
        for each in receivers:
            each.send(text)

    def send_answers(self, answers: Sequence[Answer]) -> None:
        """Send each answer of a frame to the page that asked, and the first ones to all others."""
        # Of the answers after the first ones, by the page that asked.
        own: Counter[int] = Counter()
        for index, answer in enumerate(answers):
            asker, id_ = asker_of(answer.asker)
            self.send(compact(answer_content(answer, id_)), page=asker)
            if index >= MOST_ANSWERS_TO_OTHERS:
                own[asker] += 1
                continue
            text = compact(answer_content(answer, ''))
            for page in self:
                if page.number != asker:
                    page.send(text)
        for page in self:
            rest = len(answers) - MOST_ANSWERS_TO_OTHERS - own[page.number]
            if rest > 0:
                more = Answer(topic='events', message=f'and {rest} more answers')
                page.send(compact(answer_content(more, '')))
