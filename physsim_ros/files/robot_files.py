# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The robots that ship with the package.

A file in `config/robots` is an entry of a world file without name and pose: shape, mass, colour
and robot. A body that names a robot inherits every key that it does not set.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import Any

from physsim_ros.files.resources import files_by_name, shipped
from physsim_ros.files.yaml12 import load_mapping
from physsim_ros.model.checks import must_be, shown
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.shapes import SHAPES
from physsim_ros.model.texts import nearest_name
from physsim_ros.model.translation import Text

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
            'there is no robot {value}{near}; there are {known}',
            field='robot',
            value=shown(name),
            near=nearest_name(name, files),
            known=', '.join(files),
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
        raise must_be('a name of a robot', name, 'from')
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
            there = ', '.join(names) or Text('none')
            raise BadProperty(
                'there is no {noun} {value}{near}; there are {there}',
                field=f'{noun}s',
                noun=noun,
                value=shown(name),
                near=nearest_name(str(name), names),
                there=there,
            )
        if not isinstance(change, dict):
            raise BadProperty(
                'the changes of {noun} {name} must be a mapping, not {value}',
                field=f'{noun}s',
                noun=noun,
                name=name,
                value=shown(change),
            )
    return [{**entry, **changes.get(entry['name'], {})} for entry in entries]
