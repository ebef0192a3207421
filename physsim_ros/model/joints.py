# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Kinds of joints and their properties: one table of properties, one table of kinds.

Not here: constraints and Jacobian rows of a kind (`engine.joints`), and its glyph (`view`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import ClassVar

from physsim_ros.model.checks import Checked, Checks, FASTEST, flag, HEAVIEST, shown, Within
from physsim_ros.model.errors import BadProperty, UnknownProperty
from physsim_ros.model.everyday_words import kind_meant
from physsim_ros.model.shapes import LARGEST, SMALLEST
from physsim_ros.model.texts import nearest_name

# Greatest ratio of a gear, and the inverse of the least: between the fastest and the slowest wheel
# of a clock it is 1e6.
_MOST_RATIO = 1e6
# Greatest phase of a gear [rad]: exact to a nanometre at an arm of a metre.
_MOST_PHASE = 1e6


def _ratio(value: object, name: str) -> float:
    ratio = Within(-_MOST_RATIO, _MOST_RATIO)(value, name)
    if abs(ratio) < 1.0 / _MOST_RATIO:
        raise BadProperty(f'{name} is {ratio:g}; it must not be 0', field=name)
    return ratio


@dataclass(frozen=True, slots=True)
class Property:
    """
    A property of joints.

    :param check: returns the value to keep, or refuses it; a `Within` holds range and unit
    :param default: None is no limit, or the value as drawn
    :param as_drawn: whether the bodies' poses when the joint is made supply the default
    """

    check: Callable[[object, str], float | bool]
    default: float | bool | None = None
    as_drawn: bool = False


# In the order of world files and of refusals. Kinds that share a name share the property.
PROPERTIES: Mapping[str, Property] = {
    'lower': Property(Within(-LARGEST, LARGEST, 'rad or m')),
    'upper': Property(Within(-LARGEST, LARGEST, 'rad or m')),
    'rate': Property(Within(-FASTEST, FASTEST, 'rad/s'), default=1.0),
    'max_torque': Property(Within(0.0, HEAVIEST, 'N m'), default=1000.0),
    'stiffness': Property(Within(0.0, HEAVIEST, 'N/m'), default=100.0),
    'damping': Property(Within(0.0, HEAVIEST, 'N s/m'), default=0.0),
    'rest_length': Property(Within(0.0, LARGEST, 'm'), as_drawn=True),
    'length': Property(Within(0.0, LARGEST, 'm'), as_drawn=True),
    'ratio': Property(_ratio, default=1.0),
    'phase': Property(Within(-_MOST_PHASE, _MOST_PHASE, 'rad'), as_drawn=True),
    'max_force': Property(Within(0.0, HEAVIEST, 'N')),
    'break_force': Property(Within(0.0, HEAVIEST, 'N')),
    'collide': Property(flag, default=False),
}
# The properties of every kind.
_COMMON = ('max_force', 'break_force', 'collide')
# Keys of a joint in the text of a marker.
JOINT_KEYS = ['kind', 'a', 'b', *PROPERTIES]


class JointKind(StrEnum):
    """Kinds of joints; the value is the word in markers and world files."""

    PIN = 'pin'
    AXLE = 'axle'
    MOTOR = 'motor'
    SPRING = 'spring'
    ROD = 'rod'
    ROPE = 'rope'
    SLIDER = 'slider'
    GEAR = 'gear'

    @property
    def schema(self) -> JointSchema:
        """Return the points and properties of this kind."""
        return _SCHEMAS[self]

    @property
    def points(self) -> int:
        """Return the number of points that a joint of this kind is drawn with."""
        return self.schema.points

    @property
    def phrase(self) -> str:
        """Return the kind with its article, as `an axle`."""
        return f'an {self}' if self[0] in 'aeiou' else f'a {self}'


@dataclass(frozen=True, slots=True)
class JointSchema:
    """
    The points and properties of a kind.

    :param points: number of points that a joint is drawn with, 1 or 2
    :param own: names of the properties that not every kind has
    :param least_distance: between its two points [m]; 0 is no such rule
    :param has_axis: whether the direction from its first to its second point is an axis of body b
    """

    points: int
    own: tuple[str, ...] = ()
    least_distance: float = 0.0
    has_axis: bool = False

    @property
    def properties(self) -> dict[str, Property]:
        """Return the properties of the kind by name, its own first."""
        return {name: PROPERTIES[name] for name in (*self.own, *_COMMON)}


_SCHEMAS: Mapping[JointKind, JointSchema] = {
    JointKind.PIN: JointSchema(1),
    JointKind.AXLE: JointSchema(1, ('lower', 'upper')),
    JointKind.MOTOR: JointSchema(1, ('rate', 'max_torque')),
    JointKind.SPRING: JointSchema(2, ('stiffness', 'damping', 'rest_length')),
    JointKind.ROD: JointSchema(2, least_distance=SMALLEST),
    JointKind.ROPE: JointSchema(2, ('length',)),
    JointKind.SLIDER: JointSchema(2, ('lower', 'upper'), least_distance=SMALLEST, has_axis=True),
    JointKind.GEAR: JointSchema(1, ('ratio', 'phase')),
}


def kind_from(value: object) -> JointKind:
    """
    Return the kind of joint that a word names.

    :raises BadProperty: there is no such kind
    """
    if isinstance(value, str) and value in tuple(JointKind):
        return JointKind(value)
    kinds = ', '.join(JointKind)
    if value is None:
        raise BadProperty(f'a joint needs a kind: {kinds}', field='kind')
    meant = kind_meant(str(value))
    hint = f'; use {meant!r}' if meant else nearest_name(str(value).lower(), JointKind)
    raise BadProperty(
        f'there is no kind of joint {shown(value)}{hint}; there are {kinds}', field='kind'
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class JointProperties(Checked):
    """
    The properties that a request sets; None leaves a property as it is, or at its default.

    :param lower: least angle of a relative to b [rad], or displacement of a along the axis [m],
        from the pose in which they were joined
    :param upper: greatest angle or displacement
    :param rate: angular velocity of a relative to b, counter-clockwise [rad/s]
    :param max_torque: greatest torque of a motor [N m]
    :param stiffness: [N/m]
    :param damping: [N s/m]
    :param rest_length: length of a spring without force [m]
    :param length: greatest distance of a rope's points [m]
    :param ratio: angle of a over angle of b; negative for opposite directions
    :param phase: angle of b times ratio minus angle of a [rad]
    :param max_force: greatest force of the joint [N]; of a torque, at an arm of 1 m
    :param break_force: force above which the joint is removed [N]; of a torque, at an arm of 1 m
    :param collide: whether the joined bodies collide with each other
    :raises Malformed: a number is not finite
    :raises BadProperty: a value is of the wrong kind or out of range
    """

    CHECKS: ClassVar[Checks] = {name: each.check for name, each in PROPERTIES.items()}

    lower: float | None = None
    upper: float | None = None
    rate: float | None = None
    max_torque: float | None = None
    stiffness: float | None = None
    damping: float | None = None
    rest_length: float | None = None
    length: float | None = None
    ratio: float | None = None
    phase: float | None = None
    max_force: float | None = None
    break_force: float | None = None
    collide: bool | None = None

    def __post_init__(self) -> None:
        Checked.__post_init__(self)
        if self.lower is not None and self.upper is not None and self.lower > self.upper:
            raise BadProperty(
                f'lower is {self.lower:g} and upper {self.upper:g}; lower must not be greater',
                field='lower',
            )

    def check_kind(self, kind: JointKind, unset: tuple[str, ...] = ()) -> None:
        """
        Refuse a property that a kind of joint does not have.

        :param unset: names of further properties
        :raises UnknownProperty: there is one
        """
        known = kind.schema.properties
        for name in (*self.explicit(), *unset):
            if name not in known:
                raise UnknownProperty(
                    f'{kind.phrase} has no {name}; it has {", ".join(known)}', field=name
                )
