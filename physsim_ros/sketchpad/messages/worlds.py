# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Messages about time and whole worlds: what services do, speed, seeking, courses, files."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from physsim_ros.model.checks import flag, LONGEST, number, shown, Whole, Within
from physsim_ros.model.errors import BadProperty
from physsim_ros.sketchpad.messages.fields import Fields, Readers, text_of

# Actions that need nothing but a name: those of the services.
ACTIONS = (
    'play',
    'pause',
    'rewind',
    'fast_forward',
    'fast_rewind',
    'step',
    'undo',
    'redo',
    'reset',
    'clear',
    'save_world',
    'load_world',
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Perform:
    """
    Perform what a service does.

    :param action: one of `ACTIONS`
    :param world: name of the world to save or load; '' is the one of parameter `world_file`
    :param checks_name: whether a name that is taken is refused when it is saved
    :param replace: whether an own world of that name may be written over then
    """

    action: str
    world: str = ''
    checks_name: bool = False
    replace: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class ManageWorld:
    """
    Rename, delete or put back an own world, or forget the unsaved one.

    :param action: `rename`, `remove`, `put_back` or `forget`
    :param name: of the world; '' of the unsaved one
    :param to: its new name
    """

    action: str
    name: str = ''
    to: str = ''


@dataclass(frozen=True, slots=True, kw_only=True)
class SetSpeed:
    """Set the speed of time [simulation seconds a second]."""

    speed: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Seek:
    """Go to a simulation time [ns]."""

    stamp: int


@dataclass(frozen=True, slots=True, kw_only=True)
class ReturnToCourse:
    """Return to a course of events that was left, by its number."""

    course: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Share:
    """Ask for the world as the text of a world file."""


class Upload:
    """
    Replace the world by that of a file.

    The content is taken once: by the world's thread, or by the server's, which waits no longer.

    :param content: of the world file
    """

    def __init__(self, content: Mapping[Any, Any]) -> None:
        # A deque's `pop` is atomic.
        self._content = deque((content,))

    def take(self) -> Mapping[Any, Any] | None:
        """Return the content to whoever is the first to take it, else None."""
        try:
            return self._content.pop()
        except IndexError:
            return None


def _perform(fields: Fields) -> Perform:
    action = fields.get('name')
    if action not in ACTIONS:
        raise BadProperty(f'there is no service {shown(action)}', field='name')
    return Perform(action=action, world=text_of(fields.get('world', ''), 'world'))


def _seek(fields: Fields) -> Seek:
    return Seek(stamp=round(Within(0.0, LONGEST, 's')(fields.get('time'), 'time') * 1e9))


def _course(fields: Fields) -> ReturnToCourse:
    return ReturnToCourse(course=Whole(0, 2**31)(fields.get('course'), 'course'))


def _save(fields: Fields) -> Perform:
    replace = flag(fields.get('replace', False), 'replace')
    name = _world_name(fields)
    return Perform(action='save_world', world=name, checks_name=True, replace=replace)


def _open(fields: Fields) -> Perform:
    return Perform(action='load_world', world=_world_name(fields))


def _world_name(fields: Fields) -> str:
    name = text_of(fields.get('name'), 'name')
    if not name:
        raise BadProperty('a world has a name', field='name')
    return name


READERS: Readers = {
    'service': (['name', 'world'], _perform),
    'speed': (['speed'], lambda fields: SetSpeed(speed=number(fields.get('speed'), 'speed'))),
    'seek': (['time'], _seek),
    'course': (['course'], _course),
    'save': (['name', 'replace'], _save),
    'open': (['name'], _open),
    'rename': (
        ['name', 'to'],
        lambda fields: ManageWorld(
            action='rename', name=_world_name(fields), to=text_of(fields.get('to'), 'to')
        ),
    ),
    'remove': (
        ['name'],
        lambda fields: ManageWorld(action='remove', name=_world_name(fields)),
    ),
    'put_back': (
        ['name'],
        lambda fields: ManageWorld(action='put_back', name=_world_name(fields)),
    ),
    'forget': ([], lambda _: ManageWorld(action='forget')),
    'share': ([], lambda _: Share()),
}
