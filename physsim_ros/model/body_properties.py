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
What a body is like apart from its shape: material, motion, role.

One table holds every key with its check, so that markers, world files and parameters agree.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
import difflib
import math
import reprlib
from typing import Any

from physsim_ros.model.errors import BadProperty, Malformed, UnknownProperty

# Faster than anything in a room by far; a body at this speed still moves by whole metres a step,
# which float64 positions resolve.
FASTEST = 1e5
# From a dust grain to a mountain; the engine's impulses stay finite between any two of these.
LIGHTEST, HEAVIEST = 1e-9, 1e12

# Of each key: a function of value and key that returns the value to be kept, or raises.
Checks = Mapping[str, Callable[[object, str], Any]]

# A few aliases of YAML make a value whose whole text would fill the memory.
_LONGEST_SHOWN = 60
_SHORT = reprlib.Repr()
_SHORT.maxlevel = 2
_SHORT.maxstring = _SHORT.maxother = _SHORT.maxlong = _LONGEST_SHOWN


@dataclass(frozen=True, slots=True, kw_only=True)
class Properties:
    """
    The properties that a request names; None is *not said*.

    :param mass: [kg], excludes density
    :param density: [kg/m²], excludes mass
    :param friction: coefficient, 0 .. 10
    :param elasticity: coefficient of restitution, 0 .. 1
    :param velocity: of the centre of mass, world axes [m/s]
    :param spin: [rad/s], counter-clockwise
    :param anchored: fixed to the background
    :param kinematic: moves as commanded whatever it touches
    :param group: bodies of the same non-zero group pass through each other
    :param sensor: reports contacts, pushes nothing
    :raises Malformed: a number is not finite or an array has the wrong length
    :raises BadProperty: a value is of the wrong kind or out of range
    """

    mass: float | None = None
    density: float | None = None
    friction: float | None = None
    elasticity: float | None = None
    velocity: tuple[float, float] | None = None
    spin: float | None = None
    anchored: bool | None = None
    kinematic: bool | None = None
    group: int | None = None
    sensor: bool | None = None

    def __post_init__(self) -> None:
        check_values(self, _CHECKS)
        if self.mass is not None and self.density is not None:
            raise BadProperty('a body has a mass or a density, not both', field='mass')

    def said(self) -> dict[str, Any]:
        """Return what was said, key by key."""
        return values_said(self, _CHECKS)


def properties_from(mapping: Mapping[Any, Any]) -> Properties:
    """
    Return the properties that a YAML mapping names.

    :raises UnknownProperty: a key is not a property; one that is near is named
    :raises Malformed: a number is not finite or an array has the wrong length
    :raises BadProperty: a value is null, of the wrong kind, or out of range
    """
    check_keys(mapping, _CHECKS)
    return Properties(**mapping)


def check_values(properties: object, checks: Checks) -> None:
    """
    Put what the checks make of them in the place of values that were said.

    :raises Refusal: what a check raises
    """
    for name, value in values_said(properties, checks).items():
        # They are frozen for everybody else.
        object.__setattr__(properties, name, checks[name](value, name))


def values_said(properties: object, checks: Checks) -> dict[str, Any]:
    """Return what was said, key by key."""
    pairs = ((name, getattr(properties, name)) for name in checks)
    return {name: value for name, value in pairs if value is not None}


def check_keys(mapping: Mapping[Any, Any], checks: Checks) -> None:
    """
    Refuse keys that no check knows, and those without a value.

    :raises UnknownProperty: a key is not a property; one that is near is named
    :raises BadProperty: a value is null
    """
    known = list(checks)
    for key, value in mapping.items():
        check_key(key, known)
        if value is None:
            raise BadProperty(f'{key} has no value', field=str(key))


def check_key(key: object, known: list[str]) -> None:
    """
    Refuse a key that is not known, and name the nearest that is, where one is near.

    :raises UnknownProperty: the key is not one of the known
    """
    if key in known:
        return
    # What is less alike than difflib's own measure of a good match is another word.
    near = difflib.get_close_matches(str(key).lower(), known, n=1)
    nearest = f'; nearest is {near[0]!r}' if near else ''
    raise UnknownProperty(
        f'there is no property {shown(str(key))}{nearest}', field=str(key)[:_LONGEST_SHOWN]
    )


def shown(value: object) -> str:
    """Return a value as a message shows it: short, whatever somebody has put into it."""
    return _SHORT.repr(value)


def number(value: object, name: str) -> float:
    """
    Return a finite number.

    :raises BadProperty: it is not a number
    :raises Malformed: it is not finite
    """
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise BadProperty(f'{name} must be a number, not {shown(value)}', field=name)
    try:
        result = float(value)
    except OverflowError:
        result = math.inf
    if not math.isfinite(result):
        raise Malformed(f'{name} is {shown(value)}, not a finite number', field=name)
    return result


def check_finite(values: tuple[float, ...], count: int, name: str) -> None:
    """
    Refuse values that are not the right count of finite numbers.

    :raises Malformed: they are not
    """
    if len(values) != count:
        raise Malformed(f'{name} needs {count} numbers, not {len(values)}', field=name)
    if not all(map(math.isfinite, values)):
        raise Malformed(f'{name} is not finite', field=name)


@dataclass(frozen=True, slots=True)
class Within:
    """
    A check that a number lies in a closed range.

    :param low: the least
    :param high: the greatest
    :param unit: of both, for messages
    """

    low: float
    high: float
    unit: str = ''

    def __call__(self, value: object, name: str) -> float:
        """
        Return the number.

        :raises BadProperty: it is not a number, or out of range
        :raises Malformed: it is not finite
        """
        result = number(value, name)
        if not self.low <= result <= self.high:
            span = f'{self.low:g} and {self.high:g} {self.unit}'.rstrip()
            raise BadProperty(f'{name} is {result:g}; it must lie between {span}', field=name)
        return result


def pair(value: object, name: str) -> tuple[float, float]:
    """
    Return two finite numbers.

    :raises Malformed: there are not two of them, or one is not finite
    :raises BadProperty: it is no list of numbers
    """
    if not isinstance(value, list | tuple):
        raise BadProperty(f'{name} must be a list of two numbers, not {shown(value)}', field=name)
    if len(value) != 2:
        raise Malformed(f'{name} needs two numbers, not {len(value)}', field=name)
    return number(value[0], name), number(value[1], name)


def velocity(value: object, name: str) -> tuple[float, float]:
    """
    Return a velocity [m/s].

    :raises Malformed: it is no pair of finite numbers
    :raises BadProperty: it is too fast
    """
    result = pair(value, name)
    if math.hypot(*result) > FASTEST:
        raise BadProperty(f'{name} is faster than {FASTEST:g} m/s', field=name)
    return result


def flag(value: object, name: str) -> bool:
    """
    Return true or false.

    :raises BadProperty: it is neither
    """
    if not isinstance(value, bool):
        raise BadProperty(f'{name} must be true or false, not {shown(value)}', field=name)
    return value


def _group(value: object, name: str) -> int:
    if isinstance(value, bool) or not isinstance(value, int):
        raise BadProperty(f'{name} must be a whole number, not {shown(value)}', field=name)
    # The engine keeps groups in an unsigned 64-bit word; negative ones wrap to distinct words.
    if not -(2**31) <= value < 2**31:
        raise BadProperty(f'{name} must fit into 32 bits', field=name)
    return value


_CHECKS: Checks = {
    'mass': Within(LIGHTEST, HEAVIEST, 'kg'),
    'density': Within(LIGHTEST, HEAVIEST, 'kg/m²'),
    'friction': Within(0.0, 10.0),
    'elasticity': Within(0.0, 1.0),
    'velocity': velocity,
    'spin': Within(-FASTEST, FASTEST, 'rad/s'),
    'anchored': flag,
    'kinematic': flag,
    'group': _group,
    'sensor': flag,
}
