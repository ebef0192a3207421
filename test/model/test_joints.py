# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Each kind of joint has its points and properties, and the tables of all kinds agree."""

from __future__ import annotations

from dataclasses import fields

from physsim_ros.model.errors import BadProperty, UnknownProperty
from physsim_ros.model.joints import (
    JOINT_KEYS,
    JointKind,
    JointProperties,
    kind_from,
    PROPERTIES,
)
import pytest

# The table of the contract: points, and properties of one kind only.
CONTRACT = {
    'pin': (1, ()),
    'axle': (1, ('lower', 'upper')),
    'motor': (1, ('rate', 'max_torque')),
    'spring': (2, ('stiffness', 'damping', 'rest_length')),
    'rod': (2, ()),
    'rope': (2, ('length',)),
    'slider': (2, ('lower', 'upper')),
    'gear': (1, ('ratio', 'phase')),
}
COMMON = ('max_force', 'break_force', 'collide')


def test_the_kinds_are_those_of_the_contract() -> None:
    assert set(JointKind) == set(CONTRACT)


@pytest.mark.parametrize('kind', JointKind)
def test_a_kind_has_the_points_and_properties_of_the_contract(kind: JointKind) -> None:
    points, own = CONTRACT[kind]

    assert kind.points == points
    assert kind.phrase == ('an axle' if kind is JointKind.AXLE else f'a {kind}')
    assert tuple(kind.schema.properties) == (*own, *COMMON)


def test_every_property_is_a_field_and_a_key() -> None:
    names = [each.name for each in fields(JointProperties)]

    assert names == list(PROPERTIES)
    assert ['kind', 'a', 'b', *names] == JOINT_KEYS


@pytest.mark.parametrize('kind', JointKind)
def test_a_default_passes_its_own_check(kind: JointKind) -> None:
    for name, each in kind.schema.properties.items():
        if each.default is not None:
            assert each.check(each.default, name) == each.default


@pytest.mark.parametrize('kind', JointKind)
def test_a_property_of_another_kind_is_unknown(kind: JointKind) -> None:
    for name in set(PROPERTIES) - set(kind.schema.properties):
        with pytest.raises(UnknownProperty, match=f'{kind.phrase} has no {name}'):
            JointProperties(**{name: 1.0}).check_kind(kind)


@pytest.mark.parametrize('word', ['weld', 'PIN', '', None, 1, ['pin']])
def test_a_word_that_is_no_kind_is_bad(word: object) -> None:
    with pytest.raises(BadProperty) as refused:
        kind_from(word)
    assert refused.value.field == 'kind'
