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
World files: finding, loading and saving them.

Laws: a saved world loads to the same state, to the bit; a file is written whole or not at all, and
only below the world directory.
"""

from __future__ import annotations

import os
from pathlib import Path
import tempfile
import textwrap

from physsim_ros.files.resources import is_plain, shipped
from physsim_ros.files.world_reader import state_from
from physsim_ros.files.world_writer import text_of
from physsim_ros.files.yaml12 import load_mapping
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import BadWorldFile, Malformed, Refusal
from physsim_ros.model.settings import WorldSettings

# Length of a list of names in a message [characters].
_LONGEST_LIST = 500


def shipped_worlds() -> Path:
    """Return the directory of the worlds that ship with the package."""
    return shipped('worlds')


def find_world(name: str, *, world_dir: Path, confined: bool) -> Path:
    """
    Return the file of a name or path.

    :param name: a path, absolute or below the world directory, or a world's plain name
    :param world_dir: directory of the user's worlds
    :param confined: whether only that directory and the shipped worlds may be read
    :raises BadWorldFile: there is no such file, or it lies elsewhere
    """
    if not name:
        raise BadWorldFile('parameter world_file names no file', field='world_file')
    file = f'{name}.yaml' if is_plain(name) else name
    paths = [world_dir / file]
    if Path(file).name == file:
        paths.append(shipped_worlds() / file)
    for path in paths:
        try:
            found = path.is_file()
        except OSError as error:
            # The name is too long, or a directory of the path may not be searched.
            raise BadWorldFile(f'cannot read {name[:99]}: {error}', field='world_file') from error
        if found:
            if confined and not _below(path, world_dir) and not _below(path, shipped_worlds()):
                raise BadWorldFile(f'{name} lies outside world_dir', field='world_file')
            return path
    known = sorted({each.stem for each in _worlds(world_dir) + _worlds(shipped_worlds())})
    there = textwrap.shorten(', '.join(known), _LONGEST_LIST, placeholder=' …')
    raise BadWorldFile(f'there is no world {name!r}; there are {there}', field='world_file')


def _worlds(directory: Path) -> list[Path]:
    return [path for path in directory.glob('*.yaml') if not path.name.startswith('.')]


def load_world(path: Path, *, settings: WorldSettings, physics_rate: float) -> WorldState:
    """
    Read a world.

    :param path: of the file
    :param settings: those that the file does not set
    :param physics_rate: of the world that continues from it [Hz]
    :raises BadWorldFile: it cannot be read, or its content is refused; the message names the body
        or joint and the reason
    """
    try:
        content = load_mapping(path.read_text(encoding='utf-8'), field=path.name)
    except (OSError, UnicodeDecodeError) as error:
        raise BadWorldFile(f'cannot read {path.name}: {error}', field='world_file') from error
    except Malformed as error:
        raise BadWorldFile(str(error), field='world_file') from error
    try:
        return state_from(content, settings, physics_rate)
    except Refusal as refusal:
        raise BadWorldFile(f'{path.name}: {refusal}', field=refusal.field) from refusal


def save_world(state: WorldState, name: str, *, world_dir: Path, physics_rate: float) -> Path:
    """
    Write a world, whole or not at all.

    :param state: of the world
    :param name: a path below the world directory, or a world's plain name
    :param world_dir: directory below which files may be written
    :param physics_rate: of the world [Hz]
    :return: path of the file
    :raises BadWorldFile: it cannot be written, or lies elsewhere
    """
    if not name:
        raise BadWorldFile('parameter world_file names no file', field='world_file')
    try:
        path = (world_dir / (f'{name}.yaml' if is_plain(name) else name)).resolve()
    except (OSError, RuntimeError, ValueError) as error:
        # A loop of symbolic links, or a NUL character.
        raise BadWorldFile(f'{name!r} is no path: {error}', field='world_file') from error
    # The directory itself is not below itself.
    if not _below(path.parent, world_dir):
        raise BadWorldFile(f'{name} lies outside world_dir', field='world_file')
    text = text_of(state, physics_rate)
    temporary = None
    try:
        with tempfile.NamedTemporaryFile(
            'w', encoding='utf-8', dir=path.parent, prefix=f'.{path.name}.', delete=False
        ) as file:
            temporary = Path(file.name)
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        temporary.chmod(0o644)
        temporary.replace(path)
    except OSError as error:
        if temporary is not None:
            temporary.unlink(missing_ok=True)
        raise BadWorldFile(f'cannot write {name}: {error}', field='world_file') from error
    return path


def hides_shipped(path: Path, *, world_dir: Path) -> bool:
    """
    Tell whether the plain name of a shipped world now finds this file instead.

    :param path: of a saved world
    :param world_dir: directory of the user's worlds
    """
    worlds = shipped_worlds().resolve()
    # Plain names are searched for in the directory itself, not below it.
    return path.parent == world_dir.resolve() != worlds and (worlds / path.name).is_file()


def _below(path: Path, directory: Path) -> bool:
    return path.resolve().is_relative_to(directory.resolve())
