# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Files that ship with the package: where they are and what they are called, robots, drawings.

A file in `config/robots` is an entry of a world file without name and pose: shape, mass, colour
and robot. A body that names a robot inherits every key that it does not set.

A drawing is JSON with strokes of a pen, in the order in which they are drawn:
`{"about": "...", "strokes": [{"name": "rod", "points": [[8, 7.98], [10.6, 3.4]]}, ...]}`

Laws: each point of a drawing is a sample of its stroke. A drawing is read, or refused as
`BadDrawing`, whatever it holds.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import lru_cache
from itertools import takewhile
import json
import os
from pathlib import Path
import sys
from typing import Any

import numpy as np
from physsim_ros.files.regular_file import read_file
from physsim_ros.files.yaml12 import load_mapping
from physsim_ros.model.arrays import Floats
from physsim_ros.model.checks import FARTHEST, shown
from physsim_ros.model.errors import BadProperty, Refusal
from physsim_ros.model.settings import MOST_SAMPLES
from physsim_ros.model.shapes import SHAPES
from physsim_ros.model.texts import abbreviated, nearest_name

# Start of a file in which its title is looked for [bytes].
_TITLE_WITHIN = 400


def shipped(folder: str) -> Path:
    """
    Return a directory of files that ship with the package.

    :param folder: name of the directory below `config`
    """
    return _shipped(Path('config') / folder)


def _shipped(folder: Path) -> Path:
    source = Path(__file__).resolve().parents[2] / folder
    if source.is_dir():
        return source
    for prefix in (*os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep), sys.prefix):
        installed = Path(prefix) / 'share' / 'physsim_ros' / folder
        if prefix and installed.is_dir():
            return installed
    return source


def user_directory(variable: str, *default: str) -> Path:
    """
    Return the package's directory after the XDG Base Directory Specification.

    :param variable: environment variable of the base directory, as `XDG_DATA_HOME`
    :param default: parts of the base directory below the user's home, where that is not set
    """
    base = Path(os.environ.get(variable, ''))
    # A relative path there is invalid, and to be ignored.
    return (base if base.is_absolute() else Path.home().joinpath(*default)) / 'physsim_ros'


def is_plain(name: str) -> bool:
    """Return whether a name has neither directory nor suffix, like the names of shipped files."""
    return Path(name).name == name and not Path(name).suffix


def files_by_name(directory: Path, *suffixes: str) -> dict[str, Path]:
    """
    Return the files of a directory by their plain names, in order; empty where it cannot be read.

    Files whose names are not printable, or not UTF-8, are left out: no message can name them.

    :param suffixes: of the files, with the dot
    """
    try:
        return {
            path.stem: path
            for path in sorted(directory.iterdir())
            if path.suffix in suffixes
            and path.name.isprintable()
            and not path.name.startswith('.')
            and path.is_file()
        }
    except OSError:
        return {}


def title_of(path: Path) -> str:
    """Return the first sentence of the comment that a file begins with, else its plain name."""
    try:
        with path.open('rb') as file:
            start = file.read(_TITLE_WITHIN).decode(errors='ignore')
    except OSError:
        return path.stem
    comment = takewhile(lambda line: line.startswith('#'), start.splitlines())
    words = ' '.join(' '.join(line.lstrip('#') for line in comment).split())
    sentence, stop, _ = f'{words} '.partition('. ')
    # A sentence that goes on after the start is none.
    is_whole = stop or len(start) < _TITLE_WITHIN
    return sentence.strip() or path.stem if is_whole else path.stem


# Keys that exclude each other: one in an entry replaces all of the shipped robot.
_ONE_OF = (tuple(SHAPES), ('mass', 'density'))


def shipped_robots() -> tuple[str, ...]:
    """Return the names of the robots that ship with the package."""
    return tuple(files_by_name(shipped('robots'), '.yaml'))


@lru_cache
def shipped_robot(name: str) -> Mapping[Any, Any]:
    """
    Return the entry of a shipped robot: shape, mass, colour and robot.

    :raises BadProperty: there is no such robot; the nearest one is named
    """
    files = files_by_name(shipped('robots'), '.yaml')
    if name not in files:
        raise BadProperty(
            f'there is no robot {shown(name)}{nearest_name(name, files)}; there are '
            f'{", ".join(files)}',
            field='robot',
        )
    return load_mapping(files[name].read_text(encoding='utf-8'), field=files[name].name)


def with_shipped_robot(entry: Mapping[Any, Any], known: Iterable[str]) -> Mapping[Any, Any]:
    """
    Return the entry of a body with the mapping of its shipped robot in place of the name.

    `robot` is a name, or a mapping with the name as `from` and what is different: mappings in it
    are merged, and sensors, if they are a mapping by their names; all else replaces what the
    shipped robot says.

    :param entry: of a body; returned as it is where it names no shipped robot
    :param known: keys that the entry may have; others of the shipped robot are left out
    :raises BadProperty: there is no such robot; the nearest one is named
    """
    said = entry.get('robot')
    changes = {} if isinstance(said, str) else said
    name = said if isinstance(said, str) else said.get('from') if isinstance(said, dict) else None
    if not isinstance(changes, dict) or name is None:
        return entry
    if not isinstance(name, str):
        raise BadProperty(f'from must be a name of a robot, not {shown(name)}', field='from')
    file = shipped_robot(name)
    robot = _merged(file['robot'], {key: changes[key] for key in changes if key != 'from'})
    left_out = {key for keys in _ONE_OF if any(each in entry for each in keys) for key in keys}
    ours = {key: file[key] for key in known if key in file and key not in left_out}
    return {**ours, **entry, 'robot': robot}


def _merged(old: Mapping[Any, Any], new: Mapping[Any, Any]) -> dict[Any, Any]:
    """Return a mapping with changes: mappings are merged, but for those of another kind."""
    result = dict(old)
    for key, value in new.items():
        former = old.get(key)
        if key in _BY_NAME and isinstance(value, dict):
            result[key] = _changed_by_name(_BY_NAME[key], former or [], value)
        elif isinstance(value, dict) and isinstance(former, dict):
            same_kind = value.get('kind', former.get('kind')) == former.get('kind')
            result[key] = _merged(former, value) if same_kind else value
        else:
            result[key] = value
    return result


# Lists of a robot whose elements have names: what an element is.
_BY_NAME = {'sensors': 'sensor', 'links': 'link', 'joints': 'joint'}


def _changed_by_name(
    noun: str, entries: list[Mapping[Any, Any]], changes: Mapping[Any, Any]
) -> list[Mapping[Any, Any]]:
    """
    Return the sensors, links or joints of a shipped robot with changes by their names.

    :param noun: for one of them
    :raises BadProperty: there is none of a name, or its changes are no mapping
    """
    names = [entry['name'] for entry in entries]
    for name, change in changes.items():
        if name not in names:
            there = ', '.join(names) or 'none'
            raise BadProperty(
                f'there is no {noun} {shown(name)}{nearest_name(str(name), names)}; there are '
                f'{there}',
                field=f'{noun}s',
            )
        if not isinstance(change, dict):
            raise BadProperty(
                f'the changes of {noun} {name} must be a mapping, not {shown(change)}',
                field=f'{noun}s',
            )
    return [{**entry, **changes.get(entry['name'], {})} for entry in entries]


# Greatest size of a drawing file [bytes]: 200 times that of the largest shipped one.
_MOST_BYTES = 2**20
# Greatest number of strokes of a drawing [1]: the largest shipped one has 14.
MOST_STROKES = 1_000


class BadDrawing(Refusal):
    """A drawing file that cannot be read, or whose content is no drawing."""

    code = 'bad_drawing'


def drawings() -> tuple[str, ...]:
    """Return the plain names of the shipped drawings."""
    return tuple(files_by_name(shipped('drawings'), '.json'))


def load_drawing(drawing: str) -> list[tuple[str, Floats]]:
    """
    Return the strokes of a drawing in order, each with its name.

    :param drawing: path of a JSON file, or the plain name of a shipped drawing
    :return: name, '' if it has none, and (n, 3) float64: x, y [m], time [s], which is 0
    :raises BadDrawing: the file cannot be read, or its content is no drawing
    """
    plain = is_plain(drawing)
    path = shipped('drawings') / f'{drawing}.json' if plain else Path(drawing)
    try:
        content = json.loads(read_file(path, _MOST_BYTES))
    except (OSError, ValueError, RecursionError) as error:
        near = nearest_name(drawing, drawings()) if plain else ''
        raise BadDrawing(f'cannot read {path}: {error}{near}') from error
    strokes = content.get('strokes') if isinstance(content, dict) else None
    if not isinstance(strokes, list) or not 1 <= len(strokes) <= MOST_STROKES:
        message = f'strokes must be a list of 1 to {MOST_STROKES:,} strokes'
        raise BadDrawing(message, field='strokes')
    return [_stroke(entry, f'strokes[{number}]') for number, entry in enumerate(strokes)]


def _stroke(entry: Any, field: str) -> tuple[str, Floats]:
    if not isinstance(entry, dict):
        raise BadDrawing(f'{field} must be a mapping with points', field=field)
    name, points = entry.get('name', ''), entry.get('points')
    if not isinstance(name, str):
        raise BadDrawing(f'{field}.name must be a text', field=f'{field}.name')
    if not isinstance(points, list) or not 2 <= len(points) <= MOST_SAMPLES:
        message = f'{field}.points must be a list of 2 to {MOST_SAMPLES:,} points'
        raise BadDrawing(message, field=f'{field}.points')
    for number, point in enumerate(points):
        if not _is_point(point):
            each = f'{field}.points[{number}]'
            raise BadDrawing(f'{each} must be [x, y], each within {FARTHEST:g} m', field=each)
    return abbreviated(name), np.array([(x, y, 0.0) for x, y in points], dtype=np.float64)


def _is_point(point: Any) -> bool:
    # NaN is not less than anything, and a boolean is no number here.
    return (
        isinstance(point, list)
        and len(point) == 2
        and all(type(number) in {int, float} and abs(number) <= FARTHEST for number in point)
    )
