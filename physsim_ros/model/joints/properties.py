# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The properties that a request sets on a joint, of whichever kind."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any

from physsim_ros.model.checks import check_keys, check_values, Checks, explicit_values
from physsim_ros.model.errors import BadProperty, UnknownProperty
from physsim_ros.model.joints.kinds import JointKind, PROPERTIES


@dataclass(frozen=True, slots=True, kw_only=True)
class JointProperties:
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
    :param phase: angle of b times ratio, less angle of a [rad]
    :param max_force: greatest force of the joint [N]; of a torque, at an arm of 1 m
    :param break_force: force above which the joint is removed [N]; of a torque, at an arm of 1 m
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

    def explicit(self) -> dict[str, Any]:
        """Return the properties that are set, by name."""
        return explicit_values(self, _CHECKS)

    def check_kind(self, kind: JointKind) -> None:
        """
        Refuse a property that a kind of joint does not have.

        :raises UnknownProperty: there is one
        """
        known = kind.schema.properties
        for name in self.explicit():
            if name not in known:
                raise UnknownProperty(
                    f'a {kind} has no {name}; it has {", ".join(known)}', field=name
                )


# In the order of the fields, which is that of world files and of refusals.
_CHECKS: Checks = {each.name: PROPERTIES[each.name].check for each in fields(JointProperties)}
# Keys of a joint in the text of a marker.
JOINT_KEYS = ['kind', 'a', 'b', *_CHECKS]


def joint_properties_from(mapping: Mapping[Any, Any]) -> JointProperties:
    """
    Return the properties that a YAML mapping sets.

    :raises UnknownProperty: a key is not a property; the nearest one is named
    :raises Malformed: a number is not finite
    :raises BadProperty: a value is null, of the wrong kind, or out of range
    """
    check_keys(mapping, _CHECKS)
    return JointProperties(**mapping)
