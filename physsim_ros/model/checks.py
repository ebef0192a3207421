# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Checks of values as people write them: numbers, ranges, flags, points, keys.

Law: a check returns the value to keep, or refuses it and names the field.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
import math
from numbers import Real
import reprlib
from types import UnionType
from typing import Any, ClassVar, Generic, get_args, Self, TypeVar

from physsim_ros.model.errors import BadProperty, Malformed, UnknownProperty
from physsim_ros.model.everyday_words import property_meant
from physsim_ros.model.texts import nearest_name
from physsim_ros.model.transform import Point, Pose

# Greatest speed [m/s] and spin [rad/s]. A body at this speed covers metres in a step, which
# float64 positions resolve.
FASTEST = 1e5
# Greatest coordinate [m]: beyond 10 000 km float64 positions are coarser than a nanometre.
FARTHEST = 1e7
# Greatest lifetime [s]: 300 years, more than a message's Duration holds, and exact as a number of
# steps.
LONGEST = 1e10
# Least and greatest mass [kg], and greatest force [N], torque [N m] and stiffness [N/m]: from a
# dust grain to a mountain. Impulses between any two of these are finite.
LIGHTEST, HEAVIEST = 1e-9, 1e12

# Functions of value and field name by field name; each returns the value to keep, or raises.
Checks = Mapping[str, Callable[[object, str], Any]]

# Length of a value in a message [characters]. A few YAML aliases make a value whose full text
# exceeds the memory.
_LONGEST_SHOWN = 60


class _Short(reprlib.Repr):
    """Abbreviated texts of values; reprlib's own writes subclasses of dict out in full."""

    def repr1(self, x: Any, level: int) -> str:
        """Return the text of a value within others."""
        return self.repr_dict(x, level) if isinstance(x, dict) else super().repr1(x, level)


_SHORT = _Short()
_SHORT.maxlevel = 2
_SHORT.maxstring = _SHORT.maxother = _SHORT.maxlong = _LONGEST_SHOWN


def shown(value: object) -> str:
    """Return the text of a value for a message, abbreviated."""
    return _SHORT.repr(value)


def number(value: object, name: str) -> float:
    """
    Return a finite number.

    :param name: of the field, for the refusal
    :raises BadProperty: it is not a number
    :raises Malformed: it is not finite
    """
    # Those of NumPy are `Real`, too.
    if isinstance(value, bool) or not isinstance(value, int | float | Real):
        raise BadProperty(f'{name} must be a number, not {shown(value)}', field=name)
    try:
        result = float(value)
    except OverflowError:
        result = math.inf
    if not math.isfinite(result):
        raise Malformed(f'{name} is {shown(value)}, not a finite number', field=name)
    return result


@dataclass(frozen=True, slots=True)
class Within:
    """
    A check that a number lies in a closed range.

    :param low: least value
    :param high: greatest value
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


@dataclass(frozen=True, slots=True)
class Whole:
    """
    A check that a number is whole and lies in a closed range.

    :param low: least value
    :param high: greatest value
    """

    low: int
    high: int

    def __call__(self, value: object, name: str) -> int:
        """
        Return the number.

        :raises BadProperty: it is not whole, or out of range
        """
        low, high = self.low, self.high
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            raise BadProperty(f'{name} must be a whole number, {low} to {high}', field=name)
        return value


def pair(value: object, name: str) -> Point:
    """
    Return two finite numbers.

    :param name: of the field, for the refusal
    :raises Malformed: there are not two of them, or one is not finite
    :raises BadProperty: it is no list of numbers
    """
    if not isinstance(value, list | tuple):
        raise BadProperty(f'{name} must be a list of two numbers, not {shown(value)}', field=name)
    if len(value) != 2:
        raise Malformed(f'{name} needs two numbers, not {len(value)}', field=name)
    return number(value[0], name), number(value[1], name)


def point_list(value: object, name: str) -> tuple[Point, ...]:
    """
    Return a list of points.

    :param name: of the field, for the refusal
    :raises Malformed: a point has not two coordinates, or one is not finite
    :raises BadProperty: it is no list of pairs of numbers
    """
    if not isinstance(value, list):
        raise BadProperty(f'{name} must be a list of points', field=name)
    return tuple(pair(point, name) for point in value)


def velocity(value: object, name: str) -> Point:
    """
    Return a velocity [m/s].

    :param name: of the field, for the refusal
    :raises Malformed: it is no pair of finite numbers
    :raises BadProperty: it is faster than FASTEST
    """
    result = pair(value, name)
    if math.hypot(*result) > FASTEST:
        raise BadProperty(f'{name} is faster than {FASTEST:g} m/s', field=name)
    return result


def flag(value: object, name: str) -> bool:
    """
    Return true or false.

    :param name: of the field, for the refusal
    :raises BadProperty: it is neither
    """
    if not isinstance(value, bool):
        raise BadProperty(f'{name} must be true or false, not {shown(value)}', field=name)
    return value


def known_mapping(value: object, name: str, known: list[str]) -> dict[Any, Any]:
    """
    Return a mapping with no other keys than the known ones.

    :param name: of the field, for the refusal
    :raises BadProperty: it is no mapping
    :raises UnknownProperty: a key is not known; the nearest known one is named
    """
    if not isinstance(value, dict):
        raise BadProperty(f'{name} must be a mapping', field=name)
    for key in value:
        check_key(key, known)
    return value


def text(value: object, name: str) -> str:
    """
    Return a text.

    :param name: of the field, for the refusal
    :raises Malformed: it is something else
    """
    if not isinstance(value, str):
        raise Malformed(f'{name} must be text, not {shown(value)}', field=name)
    return value


@dataclass(frozen=True, slots=True)
class OfClass:
    """
    A check that a value is of a class, or of one of several.

    :param classes: a class, or a union of classes
    """

    classes: type | UnionType

    def __call__(self, value: object, name: str) -> object:
        """
        Return the value.

        :raises Malformed: it is of another class
        """
        if not isinstance(value, self.classes):
            known = ', '.join(each.__name__ for each in get_args(self.classes) or (self.classes,))
            raise Malformed(f'{name} must be of class {known}, not {shown(value)}', field=name)
        return value


def check_finite(values: Any, count: int, name: str) -> tuple[float, ...]:
    """
    Return the right count of finite numbers.

    :param values: a tuple, a list or an array
    :raises Malformed: they are something else
    """
    try:
        row = tuple(values)
        finite = all(map(math.isfinite, row))
    except (TypeError, OverflowError):
        row, finite = (), False
    if len(row) != count:
        raise Malformed(f'{name} needs {count} numbers, not {shown(values)}', field=name)
    if not finite:
        raise Malformed(f'{name} is not finite', field=name)
    return tuple(map(float, row))


def check_point(point: Any, name: str) -> Point:
    """
    Return a point that is finite and not too far away.

    :raises Malformed: it is no pair of finite numbers
    :raises BadProperty: it is too far away
    """
    x, y = check_finite(point, 2, name)
    _check_near(x, y, name)
    return x, y


def check_pose(pose: Any, name: str) -> Pose:
    """
    Return a pose that is finite and not too far away.

    :raises Malformed: it is not three finite numbers
    :raises BadProperty: it is too far away
    """
    x, y, yaw = check_finite(pose, 3, name)
    _check_near(x, y, name)
    _check_turn(yaw, name)
    return x, y, yaw


def check_yaw(yaw: Any, name: str) -> float:
    """
    Return an angle that is finite and not too large.

    :param name: of the pose, for the refusal
    :raises Malformed: it is no finite number
    :raises BadProperty: it is too large
    """
    (angle,) = check_finite((yaw,), 1, name)
    _check_turn(angle, name)
    return angle


def _check_near(x: float, y: float, name: str) -> None:
    if max(abs(x), abs(y)) > FARTHEST:
        raise BadProperty(f'{name} is further away than {FARTHEST:g} m', field=name)


def _check_turn(yaw: float, name: str) -> None:
    if abs(yaw) > FARTHEST:
        raise BadProperty(f'the yaw of {name} is too large', field=name)


def check_key(key: object, known: list[str]) -> None:
    """
    Refuse an unknown key, and name the known one that is meant or similar, else all of them.

    :raises UnknownProperty: the key is not one of the known
    """
    if key in known:
        return
    word = str(key)
    meant = property_meant(word, known)
    hint = f'; use {meant!r}' if meant else nearest_name(word.lower(), known)
    if known and not hint:
        hint = f'; there are {", ".join(known)}'
    raise UnknownProperty(f'there is no property {shown(word)}{hint}', field=word[:_LONGEST_SHOWN])


@dataclass(frozen=True, slots=True)
class Checked:
    """
    The base of values whose fields are checked.

    :cvar CHECKS: check of each field, in their order; None is not checked where it is the default
    :raises Refusal: a check raised it
    """

    CHECKS: ClassVar[Checks] = {}

    def __post_init__(self) -> None:
        for name, check in self.CHECKS.items():
            value = getattr(self, name)
            if value is None and self.__dataclass_fields__[name].default is None:
                continue
            kept = check(value, name)
            if kept is not value:
                # Frozen for everyone but its own constructor.
                object.__setattr__(self, name, kept)

    def explicit(self) -> dict[str, Any]:
        """Return the fields that are set, by name, in the order of the checks."""
        pairs = ((name, getattr(self, name)) for name in self.CHECKS)
        return {name: value for name, value in pairs if value is not None}

    @classmethod
    def from_mapping(cls, mapping: Mapping[Any, Any]) -> Self:
        """
        Return the value of a YAML mapping.

        :raises UnknownProperty: a key is no field; the nearest one is named
        :raises Malformed: a number is not finite or an array has the wrong length
        :raises BadProperty: a value is null, of the wrong kind, or out of range
        """
        cls.check_keys(mapping)
        return cls(**mapping)

    @classmethod
    def from_value(cls, value: object, name: str) -> Self:
        """
        Return a value of this class as it is, and that of a mapping as `from_mapping`.

        :param name: of the field, for the refusal
        :raises BadProperty: it is neither; and as `from_mapping`
        """
        if isinstance(value, cls):
            return value
        if not isinstance(value, dict):
            raise BadProperty(f'{name} must be a mapping, not {shown(value)}', field=name)
        return cls.from_mapping(value)

    @classmethod
    def check_keys(cls, mapping: Mapping[Any, Any]) -> None:
        """
        Refuse keys that are no fields, and keys without a value.

        :raises UnknownProperty: a key is no field; the nearest one is named
        :raises BadProperty: a value is null
        """
        known = list(cls.CHECKS)
        for key, value in mapping.items():
            check_key(key, known)
            if value is None:
                raise BadProperty(f'{key} has no value', field=str(key))


_Value = TypeVar('_Value', bound=Checked)


@dataclass(frozen=True, slots=True)
class OfKind(Generic[_Value]):
    """
    A check of values of several kinds, whose mapping says by the key `kind` which one it is.

    :param noun: for such a value, for messages
    :param kinds: classes by the words for them
    """

    noun: str
    kinds: Mapping[str, type[_Value]]

    def __call__(self, value: object, name: str) -> _Value:
        """
        Return a value of one of the kinds as it is, and that of a mapping as `from_mapping`.

        :raises BadProperty: it is neither, or there is no such kind; and as `from_mapping`
        """
        for each in self.kinds.values():
            if isinstance(value, each):
                return value
        if not isinstance(value, dict):
            raise BadProperty(f'a {self.noun} must be a mapping, not {shown(value)}', field=name)
        kind, words = value.get('kind'), ', '.join(self.kinds)
        if kind is None:
            raise BadProperty(f'a {self.noun} needs a kind: {words}', field='kind')
        if not isinstance(kind, str) or kind not in self.kinds:
            near = nearest_name(str(kind), self.kinds)
            raise BadProperty(
                f'there is no kind of {self.noun} {shown(kind)}{near}; there are {words}',
                field='kind',
            )
        rest = {key: each for key, each in value.items() if key != 'kind'}
        return self.kinds[kind].from_mapping(rest)
