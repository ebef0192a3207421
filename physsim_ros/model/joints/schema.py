# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The schema of a kind of joint: its word, its points and what they need, its properties."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from physsim_ros.model.checks import flag, HEAVIEST, Within
from physsim_ros.model.shapes import LARGEST


@dataclass(frozen=True, slots=True, kw_only=True)
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


@dataclass(frozen=True, slots=True, kw_only=True)
class JointSchema:
    """
    A kind of joint.

    :param kind: word for it in markers and world files
    :param points: number of points it is drawn with, 1 or 2
    :param own: properties that not all joints have, by name
    :param least_distance: between its two points [m]; 0 is no such rule
    :param has_axis: whether the direction from its first to its second point is an axis fixed to b
    """

    kind: str
    points: int
    own: Mapping[str, Property] = field(default_factory=dict)
    least_distance: float = 0.0
    has_axis: bool = False

    @property
    def properties(self) -> dict[str, Property]:
        """Return all its properties by name, its own first."""
        return {**self.own, **COMMON}


# Properties of every joint. Where a joint acts by a torque, a force counts at an arm of 1 m.
COMMON: Mapping[str, Property] = {
    'max_force': Property(check=Within(0.0, HEAVIEST, 'N')),
    'break_force': Property(check=Within(0.0, HEAVIEST, 'N')),
    'collide': Property(check=flag, default=False),
}
# Limits of the one coordinate that a joint leaves free: of an axle [rad], of a slider [m].
LIMITS: Mapping[str, Property] = {
    'lower': Property(check=Within(-LARGEST, LARGEST, 'rad or m')),
    'upper': Property(check=Within(-LARGEST, LARGEST, 'rad or m')),
}
