# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
World files: finding, loading and saving them.

Laws: a saved world loads to the same state, to the bit; a file is written whole or not at all, and
only below the world directory: a name that ends in .yaml, nothing hidden, nothing that is no world
file.
"""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
import re

from physsim_ros.files.foreign import advice_on, advice_on_xml
from physsim_ros.files.map_file import with_map_walls
from physsim_ros.files.regular_file import make_directory, read_file, write_file
from physsim_ros.files.resources import files_by_name, is_plain, shipped, user_directory
from physsim_ros.files.world_reader import state_from
from physsim_ros.files.world_schema import FORMAT, LIMITS
from physsim_ros.files.world_writer import text_of
from physsim_ros.files.yaml12 import load_entries
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import (
    BadProperty,
    BadWorldFile,
    Malformed,
    Refusal,
    UnknownProperty,
    WorldFull,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.texts import nearest_name
from physsim_ros.model.translation import Text
from physsim_ros.runtime.garbage_collection import suspended_collection

# Suffix of world files.
_SUFFIX = '.yaml'
# Directory beside world files, of those that were deleted or written over last.
_KEPT = '.kept'
# Greatest size of a world file [bytes]: 100,000 bodies have 30 MB.
MOST_BYTES = 64 * 2**20


def user_worlds() -> Path:
    """Return the directory of the user's worlds, after the XDG Base Directory Specification."""
    return user_directory('XDG_DATA_HOME', '.local', 'share') / 'worlds'


def shipped_worlds() -> Path:
    """Return the directory of the worlds that ship with the package."""
    return shipped('worlds')


def shipped_lessons() -> Path:
    """Return the directory of the lessons that ship with the package: worlds with a task."""
    return shipped('lessons')


def user_lessons(world_dir: Path) -> Path:
    """Return the directory of the user's lessons, below that of the worlds."""
    return world_dir / 'lessons'


def find_world(
    name: str,
    *,
    world_dir: Path | None = None,
    lesson_dir: Path | None = None,
    confined: bool = False,
) -> Path:
    """
    Return the file of a name or path.

    :param name: a path, absolute or below the world directory, or the plain name of a world or
        lesson
    :param world_dir: directory of the user's worlds; None is `user_worlds`
    :param lesson_dir: directory of the user's lessons; None is `user_lessons`
    :param confined: whether only these directories and shipped files may be read
    :raises BadWorldFile: there is no such file, or it lies elsewhere
    """
    if not name:
        raise BadWorldFile('parameter world_file names no file', field='world_file')
    world_dir = world_dir or user_worlds()
    file = f'{name}{_SUFFIX}' if is_plain(name) else name
    own = (world_dir, lesson_dir or user_lessons(world_dir))
    ours = (shipped_worlds(), shipped_lessons())
    paths = [world_dir / file]
    if Path(file).name == file:
        paths = [each / file for each in (*own, *ours)]
    if not confined and not is_plain(name):
        # Of the working directory, as on any command line.
        paths.insert(0, Path(file))
    for path in paths:
        try:
            found = path.is_file()
            other = path.exists() and not (found or path.is_dir())
        except OSError as error:
            # The name is too long, or a directory of the path may not be searched.
            raise _unreadable(name, error) from error
        if other:
            raise BadWorldFile('{name} is not a regular file', field='world_file', name=name)
        if found:
            if confined:
                _check_place(path.resolve(), name, (*own, *ours))
            return path
    known = sorted({plain for each in (*own, *ours) for plain in worlds_in(each)})
    # Peers on the graph are not told the directories of this machine.
    directories = (
        ('world_dir', 'config/worlds', 'config/lessons')
        if confined
        else {path.parent for path in paths}
    )
    looked = ', '.join(sorted(str(each) for each in directories))
    raise BadWorldFile(
        'there is no world {world!r}{near}; physsim --help lists the shipped ones; searched in '
        '{looked}',
        field='world_file',
        world=name,
        near=nearest_name(Path(name).stem, known),
        looked=looked,
    )


def worlds_in(directory: Path) -> dict[str, Path]:
    """Return the world files of a directory by their plain names."""
    return files_by_name(directory, _SUFFIX)


@suspended_collection()
def load_world(
    path: str | Path,
    *,
    settings: WorldSettings | None = None,
    physics_rate: float = 240.0,
    parameters: Collection[str] = LIMITS,
) -> WorldState:
    """
    Read a world.

    :param path: of the file
    :param settings: those that the file does not set; None is the default ones
    :param physics_rate: of the world that continues from it [Hz]
    :param parameters: names that a node has for what is no setting of a world
    :raises BadWorldFile: it cannot be read, or its content is refused; the message names the body
        or joint and the reason
    :raises WorldFull: it has too many bodies
    """
    path = Path(path)
    try:
        text = read_file(path, MOST_BYTES)
    except (OSError, UnicodeDecodeError) as error:
        raise _unreadable(path.name, error) from error
    try:
        settings = settings or WorldSettings()
        if advice := advice_on_xml(text):
            raise BadProperty(advice)
        content = load_entries(text, field=path.name)
        if advice := advice_on(content):
            raise BadProperty(advice)
        if 'map' in content:
            content = with_map_walls(content, path.parent, settings.max_bodies)
        return state_from(content, settings, physics_rate, parameters)
    except OSError as error:
        raise _unreadable(path.name, error) from error
    except Malformed as error:
        # Only `load_mapping` names the file itself.
        message = error.text if error.field == path.name else _of_file(path, error)
        raise _refused(path.name, text, error, message) from error
    except WorldFull:
        raise
    except Refusal as refusal:
        raise _refused(path.name, text, refusal, _of_file(path, refusal)) from refusal


def _of_file(path: Path, refusal: Refusal) -> Text:
    """Return the message about the content of a file."""
    return Text('{file}: {wrong}', file=path.name, wrong=refusal.text)


def _refused(name: str, text: str, refusal: Refusal, message: Text) -> BadWorldFile:
    """
    Return the refusal of a file's content, and in brief: file, line, field and code.

    :param name: of the file
    :param text: of the file
    :param message: about it
    """
    code, field = getattr(refusal, 'cause', refusal.code), refusal.field
    line: int | None = getattr(refusal, 'line', None)
    if line is None and field:
        # A setting stands at the beginning of a line.
        found = re.search(f'^ *{re.escape(field)} *:', text, re.MULTILINE)
        line = None if found is None else text.count('\n', 0, found.start()) + 1
    # The field of an unknown property is what the file says.
    known = code not in (UnknownProperty.code, '') and field not in ('', name)
    brief = Text(
        '{file}{place}{key}: {code}',
        file=name,
        place='' if line is None else Text(', line {line}', line=line),
        key=f', {field}' if known else '',
        code=code,
    )
    field = 'world_file' if field == name else field
    return BadWorldFile(message, field=field, brief=brief, line=line, cause=code)


def save_world(
    state: WorldState, name: str, *, world_dir: str | Path, physics_rate: float
) -> Path:
    """
    Write a world, whole or not at all; the file that is there is kept.

    :param state: of the world
    :param name: a path below the world directory, or a world's plain name
    :param world_dir: directory below which files may be written
    :param physics_rate: of the world [Hz]
    :return: path of the file
    :raises BadWorldFile: it cannot be written, lies elsewhere, is hidden, or is no world file
    """
    world_dir = Path(world_dir)
    if not name:
        raise BadWorldFile('parameter world_file names no file', field='world_file')
    try:
        path = (world_dir / (f'{name}{_SUFFIX}' if is_plain(name) else name)).resolve()
        _check_place(path, name, (world_dir,))
        if path.exists() and not _is_world_file(path):
            raise BadWorldFile(
                '{name} exists and is not a world file; it is not overwritten',
                field='world_file',
                name=name,
            )
        text = text_of(state, physics_rate)
        make_directory(world_dir)
        write_file(path, text.encode(), kept=kept_path(path))
    except OSError as error:
        template, reason = 'cannot write {name}: {reason}', error.strerror or str(error)
        raise BadWorldFile(template, field='world_file', name=name, reason=reason) from error
    except (RuntimeError, ValueError) as error:
        # A loop of symbolic links, or a NUL character.
        template = '{name!r} is not a path: {reason}'
        raise BadWorldFile(template, field='world_file', name=name, reason=str(error)) from error
    return path


def kept_path(path: Path) -> Path:
    """Return the path at which the file of a world is kept that was deleted or written over."""
    return path.parent / _KEPT / path.name


def hides_shipped(path: Path, *, world_dir: Path) -> bool:
    """
    Return whether a saved world hides a shipped one: their plain names are the same.

    :param path: of a saved world
    :param world_dir: directory of the user's worlds
    """
    worlds = shipped_worlds().resolve()
    # Plain names are searched for in the directory itself, not below it.
    own = path.parent == world_dir.resolve() != worlds
    return own and is_shipped(path.stem)


def is_shipped(name: str) -> bool:
    """Return whether a shipped world or lesson has this plain name."""
    directories = (shipped_worlds(), shipped_lessons())
    return any((each / f'{name}{_SUFFIX}').is_file() for each in directories)


def _check_place(path: Path, name: str, directories: tuple[Path, ...]) -> None:
    """
    Refuse a file that peers on the graph may neither read nor write.

    :param path: of the file, without symbolic links
    :param name: by which it was asked for
    :param directories: below one of which it may lie
    """
    roots = [each.resolve() for each in directories]
    below = [path.relative_to(root) for root in roots if path.is_relative_to(root)]
    # A directory is not below itself.
    if not any(each.parts for each in below):
        raise BadWorldFile('{name} lies outside world_dir', field='world_file', name=name)
    if all(any(part.startswith('.') for part in each.parts) for each in below):
        raise BadWorldFile('{name} is hidden', field='world_file', name=name)
    if not name.isprintable():
        raise BadWorldFile('the name of a world file is not printable', field='world_file')
    if path.suffix != _SUFFIX:
        template = '{name!r} is not the name of a world: give a plain name, or a path to a .yaml'
        raise BadWorldFile(template, field='world_file', name=name)


def _is_world_file(path: Path) -> bool:
    """Return whether a file can be read, and its format is that of world files."""
    try:
        content = load_entries(read_file(path, MOST_BYTES), field=path.name)
    except (OSError, UnicodeDecodeError, Malformed):
        return False
    return str(content.get('format')) == str(FORMAT)


def _unreadable(name: str, error: OSError | UnicodeDecodeError) -> BadWorldFile:
    # The text of an OSError ends with the path, that of a UnicodeDecodeError has a byte.
    reason = error.strerror if isinstance(error, OSError) else Text('it is no text in UTF-8')
    return BadWorldFile(
        'cannot read {name}: {reason}', field='world_file', name=name, reason=reason
    )
