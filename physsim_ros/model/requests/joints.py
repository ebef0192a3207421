# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Requests that add, change and remove joints, by their names or at a point."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
import math
from typing import Any

from physsim_ros.model.checks import check_key, check_point, shown
from physsim_ros.model.errors import BadProperty, BadSize, Malformed
from physsim_ros.model.joints import (
    JOINT_KEYS,
    JointKind,
    JointProperties,
    kind_from,
    PROPERTIES,
)
from physsim_ros.model.names import check_name, WORLD
from physsim_ros.model.requests.bodies import AtPoint
from physsim_ros.model.transform import Point


@dataclass(frozen=True, slots=True, kw_only=True)
class Join:
    """
    Join two bodies, or a body and the background; or change the joint of that name in place.

    A change replaces the bodies, the points and the properties that are set or unset. The other
    properties are kept if the kind is the same.

    :param name: of the joint
    :param kind: of joint
    :param points: anchor points, one or two as the kind requires [m]
    :param frame: of the points: '' for the world, or a body's name
    :param a: name of a body; '' is the topmost one at the first point
    :param b: name of a body, or 'world' for the background; '' is the next body at the point, or
        the topmost one at the second point, or the background if there is none
    :param properties: of the kind
    :param unset: names of the properties that get their defaults again
    :raises Malformed: a number is not finite, the name has no id, or the number of points is wrong
    :raises BadProperty: there is no such kind, a body would be joined to itself, or a point is too
        far away
    :raises BadSize: the points are closer than the kind allows
    :raises UnknownProperty: the kind of joint does not have a property
    """

    name: str
    kind: JointKind
    points: tuple[Point, ...]
    frame: str = ''
    a: str = ''
    b: str = ''
    properties: JointProperties = field(default_factory=JointProperties)
    unset: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        check_name(self.name)
        object.__setattr__(self, 'kind', kind_from(self.kind))
        count = self.kind.points
        if len(self.points) != count:
            raise Malformed(
                f'a {self.kind} has {count} point{"s" * (count - 1)}, not {len(self.points)}',
                field='points',
            )
        for point in self.points:
            check_point(point, 'points')
        if self.a == WORLD:
            raise BadProperty('a is a body; the background can only be b', field='a')
        if self.a and self.a == self.b:
            raise BadProperty(f'{self.a} cannot be joined to itself', field='b')
        self.properties.check_kind(self.kind, self.unset)
        least = self.kind.schema.least_distance
        if least and math.dist(*self.points) < least:
            raise BadSize(f'the points of a {self.kind} must be {least:g} m apart', field='points')


@dataclass(frozen=True, slots=True, kw_only=True)
class Pin(AtPoint):
    """Weld the two topmost bodies at a point, or the only one to the background."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Axle(AtPoint):
    """Join the two topmost bodies at a point by an axle, or the only one to the background."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Unjoin:
    """Remove the joint of that name."""

    name: str


@dataclass(frozen=True, slots=True, kw_only=True)
class UnjoinAll:
    """
    Remove all joints, or all of a namespace.

    :param namespace: of their names, the part before the last slash; None is every joint
    """

    namespace: str | None = None


def join_from(
    mapping: Mapping[Any, Any], *, name: str, points: tuple[Point, ...], frame: str = ''
) -> Join:
    """
    Return the request for a joint of a YAML mapping: `kind`, `a`, `b` and properties.

    Without `b`, a mapping with `a` means the background; without both it means the bodies at the
    points. A property that is null is unset.

    :param name: of the joint
    :param points: in the frame [m]
    :param frame: '' for the world, or a body's name
    :raises Refusal: a key is unknown, or a value is out of range
    """
    unset = unset_in(mapping)
    kind, a, b, properties = joined_from(
        {key: mapping[key] for key in mapping if key not in unset}
    )
    return Join(
        name=name,
        kind=kind,
        points=points,
        frame=frame,
        a=a,
        b=b,
        properties=properties,
        unset=unset,
    )


def unset_in(mapping: Mapping[Any, Any]) -> tuple[str, ...]:
    """Return the properties that are null in a YAML mapping."""
    return tuple(name for name in PROPERTIES if mapping.get(name, name) is None)


def joined_from(mapping: Mapping[Any, Any]) -> tuple[JointKind, str, str, JointProperties]:
    """
    Return kind, names of the bodies a and b, and properties of a YAML mapping.

    :raises Refusal: a key is unknown, or a value is out of range
    """
    for key in mapping:
        check_key(key, JOINT_KEYS)
    properties = {key: mapping[key] for key in mapping if key not in {'kind', 'a', 'b'}}
    a, b = _body_name(mapping, 'a'), _body_name(mapping, 'b')
    kind = kind_from(mapping.get('kind'))
    return kind, a, WORLD if a and not b else b, JointProperties.from_mapping(properties)


def _body_name(mapping: Mapping[Any, Any], key: str) -> str:
    name = mapping.get(key, '')
    if not isinstance(name, str):
        raise BadProperty(f'{key} must be the name of a body, not {shown(name)}', field=key)
    return name
