# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The user's own worlds by plain names: whether one is there, renaming, deleting, putting back.

Law: the last world of each name that was deleted or written over is kept, and can be put back.
"""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path

from physsim_ros.files.regular_file import make_directory, move_and_keep
from physsim_ros.files.resources import is_plain
from physsim_ros.files.world_file import is_shipped, kept_path, user_lessons
from physsim_ros.model.errors import BadWorldFile, Exists
from physsim_ros.model.translation import Text

# Length of a name [characters], and in UTF-8 [bytes]: below the 255 of the name of a file, which
# has a suffix.
LONGEST_NAME, LONGEST_FILE = 64, 240
# Directory of pictures, below that of the worlds.
_PICTURES = '.pictures'


def check_world_name(name: str) -> str:
    """
    Return the name of an own world.

    :raises BadWorldFile: it is empty, too long, hidden, or has a directory or a suffix
    """
    if not name.strip():
        raise BadWorldFile('a world needs a name', field='name')
    if len(name) > LONGEST_NAME:
        raise BadWorldFile('a name has at most {most} characters', field='name', most=LONGEST_NAME)
    if not is_plain(name) or '.' in name or '\\' in name or not name.isprintable():
        raise BadWorldFile(
            '{name!r} cannot be a name: it has no "/" and no "."', field='name', name=name
        )
    if len(name.encode()) > LONGEST_FILE:
        raise BadWorldFile(
            'a name has at most {most} bytes in UTF-8', field='name', most=LONGEST_FILE
        )
    return name


class OwnWorlds:
    """
    The worlds in the user's directory.

    :param directory: of the worlds
    :param lessons: directory of the lessons; None is `user_lessons`

    :ivar directory: of the worlds
    :ivar lessons: directory of the lessons
    """

    def __init__(self, directory: Path, lessons: Path | None = None) -> None:
        self.directory = directory
        self.lessons = lessons or user_lessons(directory)

    def check_free(self, name: str, *, replace: bool = False) -> None:
        """
        Refuse a name that is taken.

        :param replace: whether an own world may have it
        :raises BadWorldFile: it cannot be one
        :raises Exists: an own world has it, or a shipped one
        """
        path = self._path(name)
        if is_shipped(name):
            raise Exists(
                '{name} is the name of a world that ships with physsim', field='name', name=name
            )
        if not replace and path.exists():
            raise Exists('there is a world {name} already', field='name', name=name)

    def rename(self, name: str, to: str) -> Text:
        """
        Give a world another name, and return a message about it.

        :raises Refusal: there is no such world, or the name is taken
        """
        check_world_name(to)
        self.check_free(to)
        self._existing(name).rename(self._path(to))
        # One that stays behind is drawn anew.
        with suppress(OSError):
            # That of a world which had the name before.
            self.picture(to).unlink(missing_ok=True)
            self.picture(name).rename(self.picture(to))
        return Text('renamed {world} to {to}', world=name, to=to)

    def delete(self, name: str) -> Text:
        """
        Delete a world, and return a message about it.

        :raises BadWorldFile: there is no such world
        """
        path, kept = self._existing(name), self._kept(name)
        make_directory(kept.parent)
        path.replace(kept)
        return Text('deleted the world {world}', world=name)

    def put_back(self, name: str) -> Text:
        """
        Put back the file that was deleted or written over last, and return a message about it.

        A world that has the name now is kept in place of it.

        :raises BadWorldFile: none is kept
        """
        kept = self._kept(name)
        if not kept.is_file():
            raise BadWorldFile('nothing of {world} is kept', field='name', world=name)
        move_and_keep(kept, self._path(name), kept)
        return Text('put back the world {world}', world=name)

    def picture(self, name: str) -> Path:
        """Return the path of a world's picture, which may not be there."""
        return self.directory / _PICTURES / f'{check_world_name(name)}.png'

    def _existing(self, name: str) -> Path:
        path = self._path(name)
        if not path.is_file():
            raise BadWorldFile('there is no world {world} of your own', field='name', world=name)
        return path

    def _path(self, name: str) -> Path:
        return self.directory / f'{check_world_name(name)}.yaml'

    def _kept(self, name: str) -> Path:
        return kept_path(self._path(name))
