# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The gallery: the worlds and lessons that pages offer, those of the package and the user's own.

Laws: an own world or lesson comes before the shipped one of its name. The files are read on a
thread, one time after the other, however many pages ask.
"""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache
from itertools import islice
from pathlib import Path
from typing import Any
from urllib.parse import quote

from physsim_ros.files import (
    load_world,
    OwnWorlds,
    shipped_lessons,
    shipped_worlds,
    title_of,
    worlds_in,
)
from physsim_ros.model.errors import PhysSimError, Refusal
from physsim_ros.runtime.error_boundary import ErrorBoundary

# Worlds and lessons of the user that are listed, at most.
MOST_WORLDS, MOST_LESSONS = 500, 100
# Shipped worlds, the simplest first; the others come after these.
BY_DIFFICULTY = (
    'demo',
    'dominoes',
    'pendulums',
    'incline',
    'newtons_cradle',
    'galton',
    'car',
    'catapult',
    'gear_train',
    'crane',
    'sorting',
    'bridge',
)


class Gallery:
    """
    The message of all worlds and lessons, for pages that ask; on the server's thread.

    :param read: returns it, as the files are then; called on a thread of its own
    :param send: sends a message to the page of a number, or to all for None
    :param boundary: of the server
    """

    def __init__(
        self,
        read: Callable[[], dict[str, Any]],
        send: Callable[[dict[str, Any], int | None], None],
        boundary: ErrorBoundary,
    ) -> None:
        self._read = read
        self._send = send
        self._boundary = boundary
        # Numbers of the pages that have asked since the files began to be read.
        self._asking = dict[int | None, None]()
        self._reading: asyncio.Task[None] | None = None

    def send_to(self, page: int | None) -> None:
        """Send the message to the page of a number, or to all for None, once it is read."""
        self._asking[page] = None
        if self._reading is None:
            self._reading = asyncio.create_task(self._answer())

    def close(self) -> None:
        """Send nothing any more."""
        if self._reading is not None:
            self._reading.cancel()

    async def _answer(self) -> None:
        while self._asking:
            asking, self._asking = self._asking, {}
            with self._boundary.containing('page'):
                content = await asyncio.to_thread(self._read)
                for page in asking:
                    self._send(content, page)
        self._reading = None


def gallery_content(own_worlds: OwnWorlds, boundary: ErrorBoundary) -> dict[str, Any]:
    """Return the message of all worlds and lessons, the shipped ones and the user's own."""
    known = worlds_in(shipped_worlds())
    names = sorted(known, key=lambda name: (*BY_DIFFICULTY, name).index(name))
    shipped = [_shipped(known[name]) for name in names]
    files = islice(worlds_in(own_worlds.directory).values(), MOST_WORLDS)
    own = [_own(path, own_worlds) for path in files]
    # A world of the user comes before the shipped one of its name.
    worlds = {entry['name']: entry for entry in shipped + own}
    return {
        'type': 'worlds',
        'worlds': list(worlds.values()),
        'lessons': _lessons(own_worlds.lessons, boundary),
    }


def _shipped(path: Path) -> dict[str, Any]:
    return {
        'name': path.stem,
        'title': title_of(path),
        'picture': f'/gallery/{path.stem}.svg',
        'shipped': True,
    }


def _own(path: Path, own_worlds: OwnWorlds) -> dict[str, Any]:
    # The title is the name: a comment of the user's file is private.
    name = path.stem
    picture = f'/gallery/{quote(name)}.svg'
    # A script may have chosen a name that a page refuses.
    with suppress(Refusal, OSError):
        changed = own_worlds.picture(name).stat().st_mtime_ns
        picture = f'/picture/{quote(name)}?{changed}'
    return {'name': name, 'title': name, 'picture': picture, 'shipped': False}


def _lessons(lesson_dir: Path, boundary: ErrorBoundary) -> list[dict[str, Any]]:
    """
    Return name, number, title and question of each lesson, by their numbers.

    The title of a file that is no lesson is its name; who opens it is told why.

    :param lesson_dir: directory of the user's lessons
    :param boundary: of the files
    """
    own = islice(worlds_in(lesson_dir).items(), MOST_LESSONS)
    # A lesson of the user comes before the shipped one of its name.
    files = worlds_in(shipped_lessons()) | dict(own)
    lessons = [
        {'name': name} | _read(path, _version(path), boundary) for name, path in files.items()
    ]
    return sorted(lessons, key=lambda each: (each['number'], each['name']))


def _version(path: Path) -> tuple[int, int]:
    """Return time of change [ns] and size [bytes] of a file; zeros where it is gone."""
    try:
        status = path.stat()
    except OSError:
        return 0, 0
    return status.st_mtime_ns, status.st_size


@lru_cache(maxsize=2 * MOST_LESSONS)
def _read(
    path: Path,
    version: tuple[int, int],  # noqa: ARG001 - a key
    boundary: ErrorBoundary,
) -> dict[str, Any]:
    """Return number, title and question of a lesson."""
    try:
        with boundary.refusing('lesson'):
            lesson = load_world(path).lesson
    except PhysSimError:
        lesson = None
    if lesson is None:
        return {'number': 0, 'title': path.stem, 'question': ''}
    return {'number': lesson.number, 'title': lesson.title, 'question': lesson.question}
