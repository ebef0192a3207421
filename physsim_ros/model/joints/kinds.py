# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The kinds of joints, and the table of their schemas."""

from __future__ import annotations

from enum import StrEnum

from physsim_ros.model.checks import shown
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.joints import axle, gear, motor, pin, rod, rope, slider, spring
from physsim_ros.model.joints.schema import JointSchema, Property

_SCHEMAS: dict[str, JointSchema] = {
    each.SCHEMA.kind: each.SCHEMA for each in (pin, axle, motor, spring, rod, rope, slider, gear)
}


class JointKind(StrEnum):
    """Kinds of joints; the value is the word in markers and world files."""

    WELD = 'pin'
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
        """Return the number of points a joint of this kind is drawn with."""
        return self.schema.points


# Properties of all kinds by name. Kinds that share a name share the property.
PROPERTIES: dict[str, Property] = {
    name: each for kind in JointKind for name, each in kind.schema.properties.items()
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
    raise BadProperty(f'there is no kind of joint {shown(value)}; there are {kinds}', field='kind')
