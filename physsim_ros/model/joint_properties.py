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
What a joint is like apart from where it is: its kind, and numbers that go with the kind.

One table holds every key with its check and another what each kind knows, so that markers and
world files agree.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any

from physsim_ros.model.body_properties import (
    check_keys,
    check_values,
    Checks,
    FASTEST,
    flag,
    HEAVIEST,
    shown,
    values_said,
    Within,
)
from physsim_ros.model.errors import BadProperty, UnknownProperty
from physsim_ros.model.shapes import LARGEST

# More turns than anyone winds, and still exact to a nanometre at an arm of a metre [rad].
_MOST_TURN = 1e6
# A ratio and its inverse: the slowest wheel of a clock turns 1e6 times slower than the fastest.
_MOST_RATIO = 1e6


class JointKind(StrEnum):
    """How a joint holds its two bodies."""

    PIN = 'pin'
    AXLE = 'axle'
    MOTOR = 'motor'
    SPRING = 'spring'
    ROD = 'rod'
    ROPE = 'rope'
    SLIDER = 'slider'
    GEAR = 'gear'

    @property
    def points(self) -> int:
        """Return how many points it is drawn with."""
        return 2 if self in _DRAWN_AS_LINES else 1


_DRAWN_AS_LINES = {JointKind.SPRING, JointKind.ROD, JointKind.ROPE, JointKind.SLIDER}


@dataclass(frozen=True, slots=True, kw_only=True)
class JointProperties:
    """
    The properties that a request names; None is *not said*.

    :param lower: least turn of a against b [rad], or way along the line [m], from where they were
    :param upper: the same, greatest
    :param rate: of a against b, counter-clockwise [rad/s]
    :param max_torque: the most that a motor gives [N m]
    :param stiffness: [N/m]
    :param damping: [N s/m]
    :param rest_length: at which a spring is slack [m]
    :param length: of a rope [m]
    :param ratio: turns of a for one of b; negative where they turn against each other
    :param phase: turn of b times ratio less turn of a [rad]
    :param max_force: the most that the joint gives [N]; where it turns, at an arm of 1 m
    :param break_force: with more it breaks [N]; where it turns, at an arm of 1 m
    :param collide: whether the joined bodies collide with each other
    :raises Malformed: a number is not finite
    :raises BadProperty: a value is of the wrong kind or out of range
    """

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
        check_values(self, _CHECKS)
        if self.lower is not None and self.upper is not None and self.lower > self.upper:
            raise BadProperty(
                f'lower is {self.lower:g} and upper {self.upper:g}; lower is the lesser one',
                field='lower',
            )

    def said(self) -> dict[str, Any]:
        """Return what was said, key by key."""
        return values_said(self, _CHECKS)

    def check_kind(self, kind: JointKind) -> None:
        """
        Refuse a property that a kind of joint does not have.

        :raises UnknownProperty: there is one
        """
        for name in self.said():
            if name not in KNOWN[kind]:
                raise UnknownProperty(
                    f'a {kind} has no {name}; it has {", ".join(KNOWN[kind])}', field=name
                )


def joint_properties_from(mapping: Mapping[Any, Any]) -> JointProperties:
    """
    Return the properties that a YAML mapping names.

    :raises UnknownProperty: a key is not a property; one that is near is named
    :raises Malformed: a number is not finite
    :raises BadProperty: a value is null, of the wrong kind, or out of range
    """
    check_keys(mapping, _CHECKS)
    return JointProperties(**mapping)


def kind_from(value: object) -> JointKind:
    """
    Return the kind of joint that a word means.

    :raises BadProperty: there is no such kind
    """
    if isinstance(value, str) and value in tuple(JointKind):
        return JointKind(value)
    kinds = ', '.join(JointKind)
    if value is None:
        raise BadProperty(f'a joint needs a kind: {kinds}', field='kind')
    raise BadProperty(f'there is no kind of joint {shown(value)}; there are {kinds}', field='kind')


def _ratio(value: object, name: str) -> float:
    ratio = Within(-_MOST_RATIO, _MOST_RATIO)(value, name)
    if abs(ratio) < 1.0 / _MOST_RATIO:
        raise BadProperty(f'{name} is {ratio:g}; it must not be 0', field=name)
    return ratio


_LIMIT = Within(-LARGEST, LARGEST, 'rad or m')
_LENGTH = Within(0.0, LARGEST, 'm')
_CHECKS: Checks = {
    'lower': _LIMIT,
    'upper': _LIMIT,
    'rate': Within(-FASTEST, FASTEST, 'rad/s'),
    'max_torque': Within(0.0, HEAVIEST, 'N m'),
    'stiffness': Within(0.0, HEAVIEST, 'N/m'),
    'damping': Within(0.0, HEAVIEST, 'N s/m'),
    'rest_length': _LENGTH,
    'length': _LENGTH,
    'ratio': _ratio,
    'phase': Within(-_MOST_TURN, _MOST_TURN, 'rad'),
    'max_force': Within(0.0, HEAVIEST, 'N'),
    'break_force': Within(0.0, HEAVIEST, 'N'),
    'collide': flag,
}

_ALL = ('max_force', 'break_force', 'collide')
# What the text of a joint may name.
JOINT_KEYS = ['kind', 'a', 'b', *_CHECKS]
# What each kind knows, what is its own first.
KNOWN: dict[JointKind, tuple[str, ...]] = {
    JointKind.PIN: _ALL,
    JointKind.AXLE: ('lower', 'upper', *_ALL),
    JointKind.MOTOR: ('rate', 'max_torque', *_ALL),
    JointKind.SPRING: ('stiffness', 'damping', 'rest_length', *_ALL),
    JointKind.ROD: _ALL,
    JointKind.ROPE: ('length', *_ALL),
    JointKind.SLIDER: ('lower', 'upper', *_ALL),
    JointKind.GEAR: ('ratio', 'phase', *_ALL),
}
# What holds where nothing is said; what is missing here is as drawn, or without limit.
DEFAULTS = JointProperties(
    rate=1.0, max_torque=1000.0, stiffness=100.0, damping=0.0, ratio=1.0, collide=False
)
