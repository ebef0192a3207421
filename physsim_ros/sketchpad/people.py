# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The people at the pages of a world: the list that all pages get, and who comes again."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from physsim_ros.sketchpad.inbox import Opened
from physsim_ros.sketchpad.page_session import PageSession
from physsim_ros.sketchpad.person import Person
from physsim_ros.sketchpad.rights import Role
from physsim_ros.sketchpad.server.open_pages import MOST_PAGES
from physsim_ros.sketchpad.world_control import WorldControl


class People:
    """
    The people at the open pages, and those who came last.

    :param control: of the world
    :param sessions: of the open pages, by number, always up to date
    """

    def __init__(self, control: WorldControl, sessions: Mapping[int, PageSession]) -> None:
        self._control = control
        self._sessions = sessions
        # Those who came last, by number and role: their pages may connect again.
        self._last: dict[tuple[int, Role], Person] = {}
        # Numbers of their colours, by name.
        self._colors: dict[str, int] = {}
        self._taken: dict[str, Any] = {}

    def person_at(self, opened: Opened) -> Person:
        """Return the person at a page: the same as before, if the page goes on with that."""
        key = opened.person, opened.role
        person = self._last.pop(key, None)
        if person is None or not opened.goes_on:
            person = Person(*key, self._control.drawing_settings)
        # The page has dropped what it does not send again.
        person.drawing.drop()
        self._last[key] = person
        if len(self._last) > MOST_PAGES:
            del self._last[next(iter(self._last))]
        return person

    def chosen_names(self) -> list[str]:
        """Return the names that people who draw have chosen."""
        drawing = [each.person for each in self._drawing.values()]
        return sorted({each.name for each in drawing if each.name != each.unnamed})

    def take_list(self) -> dict[str, Any] | None:
        """
        Return the message about who is there, and what a teacher has frozen and locked.

        :return: None where it is the one that was taken last
        """
        self._choose_colors()
        people = [
            {
                'page': number,
                'name': session.person.name,
                'color': self._colors[session.person.name],
                'role': session.role.value,
                'answered': session.person.answered or None,
                'raised': session.person.raised,
            }
            for number, session in self._drawing.items()
        ]
        content = {
            'type': 'class',
            'frozen': self._control.values['sketchpad_frozen'],
            'locked': self._control.locked_bodies,
            'people': people,
            'watched': any(session.watches for session in self._sessions.values()),
        }
        if not self._sessions or content == self._taken:
            return None
        self._taken = content
        return content

    def forget_taken(self) -> None:
        """Have the next list be sent even if it has not changed, since a new page has none."""
        self._taken = {}

    @property
    def _drawing(self) -> dict[int, PageSession]:
        """Return the sessions of people who draw, by number."""
        sessions = self._sessions.items()
        return {page: each for page, each in sessions if each.role.draws and not each.watches}

    def _choose_colors(self) -> None:
        """Choose a number for the colour of each person, the least that no other one has."""
        present = {session.person.name for session in self._sessions.values()}
        colors = {name: color for name, color in self._colors.items() if name in present}
        for name in present - colors.keys():
            colors[name] = min(set(range(len(present))) - set(colors.values()))
        self._colors = colors
