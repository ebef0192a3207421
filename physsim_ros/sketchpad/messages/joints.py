# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Messages that change joints by their names, or delete them."""

from __future__ import annotations

from dataclasses import dataclass

from physsim_ros.model.errors import BadProperty
from physsim_ros.model.joints import joint_properties_from, JointProperties
from physsim_ros.model.requests import Unjoin
from physsim_ros.sketchpad.messages.bodies import Submit
from physsim_ros.sketchpad.messages.fields import Fields, Readers, text_of


@dataclass(frozen=True, slots=True, kw_only=True)
class ChangeJoint:
    """
    Change the properties of a joint, where it is.

    :param name: of the joint
    :param properties: that are set; the others stay
    """

    name: str
    properties: JointProperties


def _change_joint(fields: Fields) -> ChangeJoint:
    given = fields.get('properties')
    if not isinstance(given, dict):
        raise BadProperty('properties must be a mapping', field='properties')
    name = text_of(fields.get('name'), 'name')
    return ChangeJoint(name=name, properties=joint_properties_from(given))


def _unjoin(fields: Fields) -> Submit:
    name = text_of(fields.get('name'), 'name')
    return Submit(requests=(Unjoin(name=name),), topic='~/join')


READERS: Readers = {
    'change_joint': (['name', 'properties'], _change_joint),
    'unjoin': (['name'], _unjoin),
}
