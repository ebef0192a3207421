# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every property has its kind and its range, and what lies outside is refused and named."""

import math
from typing import Any

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.checks import (
    FASTEST,
    HEAVIEST,
    LIGHTEST,
    shown,
)
from physsim_ros.model.errors import BadProperty, Malformed, Refusal, UnknownProperty
import pytest

KEYS = ('mass', 'density', 'friction', 'elasticity', 'velocity', 'spin', 'anchored', 'kinematic',
        'group', 'sensor', 'forces', 'label')  # fmt: skip
NUMBERS = ('mass', 'density', 'friction', 'elasticity', 'spin')
FLAGS = ('anchored', 'kinematic', 'sensor')
RANGES = {
    'mass': (LIGHTEST, HEAVIEST),
    'density': (LIGHTEST, HEAVIEST),
    'friction': (0.0, 10.0),
    'elasticity': (0.0, 1.0),
    'spin': (-FASTEST, FASTEST),
}


def refusal_of(**said: Any) -> Refusal:
    with pytest.raises(Refusal) as refused:
        Properties(**said)
    return refused.value


def test_what_is_not_said_is_none_and_not_listed() -> None:
    assert Properties().explicit() == {}
    assert Properties(friction=0.0, anchored=False, group=0).explicit() == {
        'friction': 0.0,
        'anchored': False,
        'group': 0,
    }


@pytest.mark.parametrize('key', NUMBERS)
def test_the_ends_of_a_range_are_taken(key: str) -> None:
    for value in RANGES[key]:
        assert getattr(Properties(**{key: value}), key) == value


@pytest.mark.parametrize('key', NUMBERS)
def test_what_lies_just_outside_a_range_is_bad(key: str) -> None:
    low, high = RANGES[key]

    for value in (math.nextafter(low, -math.inf), math.nextafter(high, math.inf)):
        refusal = refusal_of(**{key: value})
        assert isinstance(refusal, BadProperty)
        assert refusal.field == key
        assert key in str(refusal)


@pytest.mark.parametrize('key', NUMBERS)
@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf, 10**400, -(10**400)])
def test_a_number_that_is_not_finite_is_malformed(key: str, value: float) -> None:
    refusal = refusal_of(**{key: value})

    assert isinstance(refusal, Malformed)
    assert refusal.field == key


@pytest.mark.parametrize('key', NUMBERS)
@pytest.mark.parametrize('value', ['1', True, False, [1.0], {'a': 1}, (1.0,), b'1', 1j])
def test_what_is_no_number_is_bad(key: str, value: object) -> None:
    refusal = refusal_of(**{key: value})

    assert isinstance(refusal, BadProperty)
    assert refusal.field == key


@pytest.mark.parametrize('key', NUMBERS)
def test_a_whole_number_is_kept_as_a_fraction(key: str) -> None:
    value = getattr(Properties(**{key: 1}), key)

    assert (type(value), value) == (float, 1.0)


def test_a_velocity_is_two_numbers_up_to_the_fastest() -> None:
    assert Properties(velocity=[3, -4]).velocity == (3.0, -4.0)
    assert Properties(velocity=(0.6 * FASTEST, 0.8 * FASTEST)).velocity is not None

    refusal = refusal_of(velocity=(0.8 * FASTEST, 0.8 * FASTEST))

    assert isinstance(refusal, BadProperty)
    assert refusal.field == 'velocity'


@pytest.mark.parametrize(
    ('value', 'error'),
    [([1.0], Malformed), ([1.0, 2.0, 3.0], Malformed), ([], Malformed),
     ([math.nan, 0.0], Malformed), ([0.0, math.inf], Malformed), ([1e308, 1e308], BadProperty),
     (1.0, BadProperty), ('fast', BadProperty), ({'x': 1.0}, BadProperty),
     (['a', 'b'], BadProperty), ([True, 0.0], BadProperty), ([None, 0.0], BadProperty),
     ([[1.0], [2.0]], BadProperty)],
)  # fmt: skip
def test_a_velocity_that_is_none_is_refused(value: object, error: type[Refusal]) -> None:
    refusal = refusal_of(velocity=value)

    assert isinstance(refusal, error)
    assert refusal.field == 'velocity'


@pytest.mark.parametrize('key', FLAGS)
def test_a_flag_is_true_or_false_and_nothing_else(key: str) -> None:
    for value in (True, False):
        assert getattr(Properties(**{key: value}), key) is value
    for other in (0, 1, 'true', 'yes', 1.0, [], [True]):
        refusal = refusal_of(**{key: other})
        assert isinstance(refusal, BadProperty)
        assert refusal.field == key


@pytest.mark.parametrize('value', [-(2**31), -1, 0, 7, 2**31 - 1])
def test_a_group_is_a_whole_number_of_32_bits(value: int) -> None:
    assert Properties(group=value).group == value


@pytest.mark.parametrize('value', [-(2**31) - 1, 2**31, 1.0, '1', True, [1], math.nan])
def test_a_group_that_is_none_is_bad(value: object) -> None:
    refusal = refusal_of(group=value)

    assert isinstance(refusal, BadProperty)
    assert refusal.field == 'group'


@pytest.mark.parametrize('value', ['', 'm₁', 'two\nlines', 'x' * 200, '{[#: ', '\ufeff'])
def test_a_label_is_text_in_lines(value: str) -> None:
    assert Properties(label=value).label == value


@pytest.mark.parametrize(
    'value', [1, True, ['m'], 'x' * 201, 'a\tb', '\r', '\x00', '\ud800', '\u202e']
)
def test_a_label_that_is_none_is_bad(value: object) -> None:
    refusal = refusal_of(label=value)

    assert isinstance(refusal, BadProperty)
    assert refusal.field == 'label'


def test_a_body_has_a_mass_or_a_density_and_not_both() -> None:
    assert isinstance(refusal_of(mass=1.0, density=1.0), BadProperty)


def test_a_mapping_becomes_the_properties_that_it_names() -> None:
    properties = Properties.from_mapping(
        {'density': 2, 'elasticity': 0.9, 'velocity': [3, 0], 'anchored': False}
    )

    assert properties == Properties(
        density=2.0, elasticity=0.9, velocity=(3.0, 0.0), anchored=False
    )


def test_all_keys_of_the_contract_are_known_and_no_others() -> None:
    values: dict[str, Any] = {
        'mass': 1, 'friction': 1, 'elasticity': 1, 'velocity': [1, 1], 'spin': 1,
        'anchored': False, 'kinematic': True, 'group': 1, 'sensor': True,
        'forces': [], 'label': 'm1',
    }  # fmt: skip

    assert set(Properties.from_mapping(values).explicit()) == set(KEYS) - {'density'}
    assert Properties.from_mapping({'density': 1}).explicit() == {'density': 1.0}
    for key in ('color', 'name', 'shape', 'lifetime', 'MASS', ' mass', ''):
        with pytest.raises(UnknownProperty):
            Properties.from_mapping({key: 1})


@pytest.mark.parametrize('key', KEYS)
def test_a_key_without_a_value_is_bad(key: str) -> None:
    with pytest.raises(BadProperty) as refused:
        Properties.from_mapping({key: None})
    assert refused.value.field == key


@pytest.mark.parametrize(
    ('key', 'near'),
    [('elastic', 'elasticity'), ('frictoin', 'friction'), ('Mass', 'mass'), ('denisty', 'density'),
     ('anchor', 'anchored'), ('velocty', 'velocity'), ('spinn', 'spin'), ('groups', 'group'),
     ('kinematics', 'kinematic'), ('censor', 'sensor'), ('labels', 'label'), ('MASS', 'mass')],
)  # fmt: skip
def test_an_unknown_key_is_refused_and_the_nearest_named(key: str, near: str) -> None:
    with pytest.raises(UnknownProperty) as refused:
        Properties.from_mapping({key: 1})

    assert refused.value.field == key
    assert str(refused.value) == f"there is no property '{key}'; nearest is '{near}'"


@pytest.mark.parametrize('key', ['', 'zzz', 'wheel', 'loud', 7, None, math.nan, True, 1.5])
def test_a_key_like_no_other_is_refused_and_all_keys_named(key: object) -> None:
    with pytest.raises(UnknownProperty) as refused:
        Properties.from_mapping({key: 1})

    assert refused.value.field == str(key)
    assert str(refused.value).startswith(f'there is no property {str(key)!r}; there are mass, ')


def test_an_unknown_key_comes_before_a_bad_value() -> None:
    with pytest.raises(UnknownProperty):
        Properties.from_mapping({'mass': 'heavy', 'wheight': 1})


def test_what_a_message_shows_is_short_whatever_was_given() -> None:
    nested: object = [1, 2, 3]
    for _ in range(40):
        nested = [nested] * 9
    refusals = [
        refusal_of(friction=nested),
        refusal_of(velocity='x' * 10**6),
        refusal_of(mass=10**4000),
        refusal_of(sensor=nested),
    ]
    with pytest.raises(UnknownProperty) as refused:
        Properties.from_mapping({'x' * 10**5: 1})

    for refusal in (*refusals, refused.value):
        assert len(str(refusal)) < 1000
        assert len(refusal.field) < 100
    assert len(shown(nested)) < 1000
