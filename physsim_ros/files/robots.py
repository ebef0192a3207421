# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Shipped robots: the mapping that a name below the key `robot` of a body stands for.

A file in `config/robots` is an entry of a world file without name and pose: shape, mass, colour
and robot. A body that names a robot inherits every key that it does not set.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import Any

from physsim_ros.files.resources import files_by_name, shipped
from physsim_ros.files.yaml12 import load_mapping
from physsim_ros.model.checks import shown
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.shapes import SHAPES
from physsim_ros.model.texts import nearest_name

# Keys of which an entry has one: where it has any, the shipped robot's does not count.
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
        if key == 'sensors' and isinstance(value, dict):
            result[key] = _with_changed_sensors(former or [], value)
        elif isinstance(value, dict) and isinstance(former, dict):
            same_kind = value.get('kind', former.get('kind')) == former.get('kind')
            result[key] = _merged(former, value) if same_kind else value
        else:
            result[key] = value
    return result


def _with_changed_sensors(
    sensors: list[Mapping[Any, Any]], changes: Mapping[Any, Any]
) -> list[Mapping[Any, Any]]:
    """
    Return the sensors of a shipped robot with changes by their names.

    :raises BadProperty: there is no such sensor, or its changes are no mapping
    """
    names = [sensor['name'] for sensor in sensors]
    for name, change in changes.items():
        if name not in names:
            there = ', '.join(names) or 'none'
            raise BadProperty(
                f'there is no sensor {shown(name)}{nearest_name(str(name), names)}; there are '
                f'{there}',
                field='sensors',
            )
        if not isinstance(change, dict):
            raise BadProperty(
                f'the changes of sensor {name} must be a mapping, not {shown(change)}',
                field='sensors',
            )
    return [{**sensor, **changes.get(sensor['name'], {})} for sensor in sensors]
