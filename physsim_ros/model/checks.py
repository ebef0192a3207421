# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Checks of values as people write them: numbers, ranges, flags, words, points.

Law: a check returns the value to keep, or refuses it and names the field.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
import math
from numbers import Real
import re
import reprlib
from types import UnionType
from typing import Any, get_args

from physsim_ros.model.errors import BadProperty, Malformed, Refusal
from physsim_ros.model.spelling import canonical
from physsim_ros.model.texts import nearest_name, Words
from physsim_ros.model.transform import Point, Pose
from physsim_ros.model.translation import Text

# Greatest speed [m/s] and spin [rad/s]. A body at this speed covers metres in a step, which
# float64 positions resolve.
FASTEST = 1e5
# Greatest coordinate [m]: beyond 10 000 km float64 positions are coarser than a nanometre.
FARTHEST = 1e7
# Position, angle or velocity at which a body is lost, and removed [m, rad, m/s, rad/s]; a double
# resolves 0.1 mm there.
LOST = 1e12
# Greatest lifetime [s]: 300 years, more than a message's Duration holds, and exact as a number of
# steps.
LONGEST = 1e10
# Least and greatest mass [kg], and greatest force [N], torque [N m] and stiffness [N/m]: from a
# dust grain to a mountain. Impulses between any two of these are finite.
LIGHTEST, HEAVIEST = 1e-9, 1e12

# A function of a value and the name of its field, which returns the value to keep, or raises.
Check = Callable[[object, str], Any]

# Length of a value in a message [characters]. A few YAML aliases make a value whose full text
# exceeds the memory.
LONGEST_SHOWN = 60


class _Short(reprlib.Repr):
    """Abbreviated texts of values, also of subclasses of dict and of any whole number."""

    def repr1(self, x: Any, level: int) -> str:
        """Return the text of a value within others."""
        return self.repr_dict(x, level) if isinstance(x, dict) else super().repr1(x, level)

    def repr_int(self, x: int, level: int) -> str:
        """Return the text of a whole number; Python writes none of more than 4,300 digits."""
        try:
            return super().repr_int(x, level)
        except ValueError:
            return f'a number of {x.bit_length():,} bits'


_SHORT = _Short()
_SHORT.maxlevel = 2
_SHORT.maxstring = _SHORT.maxother = _SHORT.maxlong = LONGEST_SHOWN


def shown(value: object) -> str:
    """Return the text of a value for a message, abbreviated."""
    return _SHORT.repr(value)


def brief(number: float) -> str:
    """Return a number as people write it: 0.5, 100000, 1e12."""
    return re.sub(r'e([-+])0*', lambda sign: 'e-' if sign[1] == '-' else 'e', f'{number:g}')


def must_be(wanted: str, value: object, name: str, error: type[Refusal] = BadProperty) -> Refusal:
    """
    Return the refusal of a value of another kind than the field has.

    :param wanted: a text, as `a number`, or the template of one
    :param name: of the field
    """
    kind = wanted if isinstance(wanted, Text) else Text(wanted)
    return error('{field} must be {kind}, not {value}', field=name, kind=kind, value=shown(value))


def number(value: object, name: str) -> float:
    """
    Return a finite number.

    :param name: of the field, for the refusal
    :raises BadProperty: it is not a number
    :raises Malformed: it is not finite
    """
    # Numbers of NumPy are `Real`, too.
    if isinstance(value, bool) or not isinstance(value, int | float | Real):
        raise must_be('a number', value, name)
    try:
        result = float(value)
    except OverflowError:
        result = math.inf
    if not math.isfinite(result):
        raise Malformed('{field} is {value}, not a finite number', field=name, value=shown(value))
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

    @property
    def span(self) -> str:
        """Return the range with its unit, as `0 .. 1e12 kg`."""
        return f'{brief(self.low)} .. {brief(self.high)} {self.unit}'.rstrip()

    def __call__(self, value: object, name: str) -> float:
        """
        Return the number.

        :raises BadProperty: it is not a number, or out of range
        :raises Malformed: it is not finite
        """
        result = number(value, name)
        if not self.low <= result <= self.high:
            raise BadProperty(
                '{field} is {value:g}; it must lie between {low:g} and {high:g}{unit}',
                field=name,
                value=result,
                low=self.low,
                high=self.high,
                unit=self.unit and f' {self.unit}',
            )
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

    @property
    def span(self) -> str:
        """Return the range, as `0 .. 1000`."""
        return f'{self.low} .. {self.high}'

    def __call__(self, value: object, name: str) -> int:
        """
        Return the number.

        :raises BadProperty: it is not whole, or out of range
        """
        low, high = self.low, self.high
        if isinstance(value, bool) or not isinstance(value, int) or not low <= value <= high:
            raise BadProperty(
                '{field} must be a whole number, {low} to {high}', field=name, low=low, high=high
            )
        return value


@dataclass(frozen=True, slots=True)
class Numbers:
    """
    A check of a list of as many numbers as it has checks, one each.

    :param checks: of the numbers
    """

    checks: tuple[Check, ...]

    def __call__(self, value: object, name: str) -> tuple[Any, ...]:
        """
        Return the numbers.

        :raises Malformed: there are more or fewer of them, or one is not finite
        :raises BadProperty: it is no list of numbers, or one is out of range
        """
        count = len(self.checks)
        if not isinstance(value, list | tuple):
            template = '{key} is {value}; it must be a list of {count} numbers'
            message = Text(template, key=name, value=shown(value), count=count)
            raise BadProperty(message, field=name)
        if len(value) != count:
            raise Malformed(
                '{field} needs {count} numbers, not {found}',
                field=name,
                count=count,
                found=len(value),
            )
        return tuple(check(each, name) for check, each in zip(self.checks, value, strict=True))


# The check of two finite numbers.
pair = Numbers((number, number))


@dataclass(frozen=True, slots=True)
class ListOf:
    """
    A check of each element of a list.

    :param check: of an element
    :param noun: for the elements, for messages
    :param most: greatest number of elements
    """

    check: Check
    noun: str
    most: float = math.inf

    def __call__(self, value: object, name: str) -> tuple[Any, ...]:
        """
        Return the elements.

        :raises BadProperty: it is no list, or too long; and as the check of an element
        """
        if not isinstance(value, list | tuple):
            raise must_be(Text('a list of {noun}', noun=Text(self.noun)), value, name)
        if len(value) > self.most:
            template = '{field} has more than {most} {noun}'
            raise BadProperty(template, field=name, most=self.most, noun=Text(self.noun))
        return tuple(self.check(each, name) for each in value)


# The check of a list of points.
point_list = ListOf(pair, 'points')


@dataclass(frozen=True, slots=True)
class Vector:
    """
    A check that a value is a vector of at most a length.

    :param longest: greatest length
    :param unit: of the length
    :param beyond: of a longer one, as `faster`
    """

    longest: float
    unit: str
    beyond: str

    @property
    def span(self) -> str:
        """Return the range with its unit, as `up to 100000 m/s`."""
        return f'up to {brief(self.longest)} {self.unit}'.rstrip()

    def __call__(self, value: object, name: str) -> Point:
        """
        Return the vector.

        :raises Malformed: it is no pair of finite numbers
        :raises BadProperty: it is no list of numbers, or too long
        """
        vector = pair(value, name)
        if math.hypot(*vector) > self.longest:
            raise BadProperty(
                '{field} is {beyond} than {most:g}{unit}',
                field=name,
                beyond=self.beyond,
                most=self.longest,
                unit=self.unit and f' {self.unit}',
            )
        return vector


# The checks of a velocity [m/s], of a mass [kg], of a density [kg/m²] and of the coefficients of
# friction and restitution [1].
VELOCITY = Vector(FASTEST, 'm/s', 'faster')
MASS, DENSITY = Within(LIGHTEST, HEAVIEST, 'kg'), Within(LIGHTEST, HEAVIEST, 'kg/m²')
FRICTION, ELASTICITY = Within(0.0, 10.0), Within(0.0, 1.0)
# Everyday words for them, for greatest speeds, and for places.
MASS_WORDS, DENSITY_WORDS = Words('weight', 'heavy', 'kg'), Words('specific_weight', 'rho')
FRICTION_WORDS = Words('rough', 'roughness', 'grip', 'slippery', 'slip', 'mu')
ELASTICITY_WORDS = Words('bouncy', 'bounce', 'bounciness', 'restitution', 'rebound')
MOST_SPEED_WORDS = Words('max_velocity', 'velocity_limit', 'speed_limit')
AT_WORDS = Words('position', 'pose', 'x', 'y', 'yaw', 'angle', 'orientation')


def flag(value: object, name: str) -> bool:
    """
    Return true or false.

    :param name: of the field, for the refusal
    :raises BadProperty: it is neither
    """
    if not isinstance(value, bool):
        raise must_be('true or false', value, name)
    return value


def text(value: object, name: str, error: type[Refusal] = Malformed) -> str:
    """
    Return a word or a name, in its canonical spelling.

    :param name: of the field, for the refusal
    :param error: that is raised where it is something else
    """
    if not isinstance(value, str):
        raise must_be('text', value, name, error)
    return canonical(value)


def texts(value: object, name: str, error: type[Refusal] = Malformed) -> tuple[str, ...]:
    """Return a list of words or names, each as `text`; parameters as of that."""
    if not isinstance(value, list | tuple) or not all(isinstance(each, str) for each in value):
        raise must_be('a list of texts', value, name, error)
    return tuple(map(canonical, value))


@dataclass(frozen=True, slots=True)
class OneOf:
    """
    A check that a value is one of several words.

    :param words: all of them; members of an enumeration count as their values
    """

    words: tuple[str, ...]

    @property
    def span(self) -> str:
        """Return the words, as `none, serve`."""
        return ', '.join(self.words)

    def __call__(self, value: object, name: str) -> str:
        """
        Return the word.

        :raises BadProperty: it is none of them
        """
        if not isinstance(value, str) or value not in self.words:
            near = nearest_name(shown(value).strip("'"), self.words)
            raise BadProperty(
                '{field} must be one of {span}{near}', field=name, span=self.span, near=near
            )
        return str(value)


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
            raise must_be(Text('of class {known}', known=known), value, name, Malformed)
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
        template = '{field} needs {count} numbers, not {value}'
        raise Malformed(template, field=name, count=count, value=shown(values))
    if not finite:
        raise Malformed('{field} is not finite', field=name)
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
        raise BadProperty('{field} is further away than {most:g} m', field=name, most=FARTHEST)


def _check_turn(yaw: float, name: str) -> None:
    if abs(yaw) > FARTHEST:
        raise BadProperty('the yaw of {field} is too large', field=name)
