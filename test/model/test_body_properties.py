# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Properties of a body: what their own checks refuse, and the keys of a mapping."""

import math
from typing import Any

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import BadProperty, Refusal, UnknownProperty
import pytest

from ..building import refusal


def refusal_of(**said: Any) -> Refusal:
    with pytest.raises(Refusal) as refused:
        Properties(**said)
    return refused.value


def test_what_is_not_said_is_none_and_not_listed():
    said = {'friction': 0.0, 'anchored': False, 'group': 0}
    assert Properties().explicit() == {}
    assert Properties(**said).explicit() == said == Properties(**said).entry()


@pytest.mark.parametrize(
    ('name', 'good', 'bad'),
    [
        (
            'group',
            [-(2**31), -1, 0, 7, 2**31 - 1],
            [-(2**31) - 1, 2**31, 1.0, '1', True, [1], math.nan],
        ),
        (
            'label',
            ['', 'm₁', 'two\nlines', 'x' * 200, '{[#: ', '\ufeff'],
            [1, True, ['m'], 'x' * 201, 'a\tb', '\r', '\x00', '\ud800', '\u202e'],
        ),
    ],
)
def test_groups_and_labels_have_checks_of_their_own(name, good, bad):
    for value in good:
        assert getattr(Properties(**{name: value}), name) == value
    for value in bad:
        refusal = refusal_of(**{name: value})
        assert (type(refusal), refusal.field) == (BadProperty, name)


def test_a_body_has_a_mass_or_a_density_and_not_both():
    assert isinstance(refusal_of(mass=1.0, density=1.0), BadProperty)


def test_a_mapping_becomes_the_properties_that_it_names():
    said = {'density': 2, 'elasticity': 0.9, 'velocity': [3, 0], 'anchored': False}

    assert Properties.from_mapping(said) == Properties(
        density=2.0, elasticity=0.9, velocity=(3.0, 0.0), anchored=False
    )
    assert Properties.from_mapping(said).entry() == said


@pytest.mark.parametrize('key', Properties.FIELDS)
def test_a_key_without_a_value_is_bad(key):
    assert refusal(Properties.from_mapping, {key: None}) == (BadProperty, key)


@pytest.mark.parametrize(
    ('key', 'near'),
    [('elastic', 'elasticity'), ('frictoin', 'friction'), ('Mass', 'mass'), ('MASS', 'mass'),
     ('anchor', 'anchored'), ('censor', 'sensor'), ('labels', 'label')],
)  # fmt: skip
def test_an_unknown_key_is_refused_before_a_bad_value_and_the_nearest_named(key, near):
    with pytest.raises(UnknownProperty) as refused:
        Properties.from_mapping({'mass': 'heavy', key: 1})

    assert refused.value.field == key
    assert str(refused.value) == f"there is no property '{key}'; nearest is '{near}'"


@pytest.mark.parametrize(
    'key', ['', 'zzz', 'color', 'lifetime', 7, None, math.nan, True, 'x' * 10**5]
)
def test_a_key_like_no_other_is_refused_and_all_keys_named(key):
    with pytest.raises(UnknownProperty, match='; there are mass, density, ') as refused:
        Properties.from_mapping({key: 1})

    assert refused.value.field == str(key)[:60]
    assert len(str(refused.value)) < 1000
