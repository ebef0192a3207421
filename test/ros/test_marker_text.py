# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The text of a marker names the properties of its body, or is refused with the key at fault."""

from __future__ import annotations

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import BadProperty, Malformed, Refusal, UnknownProperty
from physsim_ros.model.requests import Spawn
from physsim_ros.ros.requests.conversions import body_request, LONGEST_TEXT
from physsim_ros.testing import box
import pytest


def properties_of(text: str) -> Properties:
    request = body_request(box(text=text), frame_id='map')
    assert isinstance(request, Spawn)
    return request.properties


def refusal_of(text: str) -> Refusal:
    with pytest.raises(Refusal) as caught:
        properties_of(text)
    return caught.value


def test_no_text_says_nothing() -> None:
    for text in ('', '  \n', '{}', '# a remark', '---'):
        assert properties_of(text) == Properties()


def test_text_names_every_property() -> None:
    text = (
        '{mass: 2, friction: 0.25, elasticity: 1, velocity: [3, -4.5], spin: -2, '
        'anchored: false, kinematic: true, group: -3, sensor: true, label: "m1\\n2 kg"}'
    )
    assert properties_of(text) == Properties(
        mass=2.0,
        friction=0.25,
        elasticity=1.0,
        velocity=(3.0, -4.5),
        spin=-2.0,
        anchored=False,
        kinematic=True,
        group=-3,
        sensor=True,
        label='m1\n2 kg',
    )
    assert properties_of('density: 7').density == 7.0
    assert properties_of('anchored: true\nfriction: 0').anchored is True


@pytest.mark.parametrize(
    ('text', 'value'),
    [
        ('1e5', 1e5),
        ('1E5', 1e5),
        ('1.e+5', 1e5),
        ('1e-5', 1e-5),
        ('.5', 0.5),
        ('5', 5.0),
        ('+5', 5.0),
        ('010', 10.0),
        ('0.1', 0.1),
    ],
)
def test_numbers_are_those_of_yaml_1_2(text: str, value: float) -> None:
    assert properties_of(f'{{density: {text}}}').density == value


@pytest.mark.parametrize('number', ['.nan', '.NaN', '.inf', '-.inf', '1e999', '[.inf, 0]'])
def test_a_number_that_is_not_finite_is_refused(number: str) -> None:
    key = 'velocity' if number.startswith('[') else 'density'
    refusal = refusal_of(f'{{{key}: {number}}}')
    assert (type(refusal), refusal.field) == (Malformed, key)


@pytest.mark.parametrize(
    ('text', 'field'),
    [
        ('{density: heavy}', 'density'),
        ('{density: "2"}', 'density'),
        ('{density: true}', 'density'),
        ('{density: 0}', 'density'),
        ('{density: -1}', 'density'),
        ('{mass: 0}', 'mass'),
        ('{density: ~}', 'density'),
        ('{density: }', 'density'),
        ('{mass: [1]}', 'mass'),
        ('{mass: {a: 1}}', 'mass'),
        ('{friction: -0.1}', 'friction'),
        ('{friction: 10.1}', 'friction'),
        ('{elasticity: 1.1}', 'elasticity'),
        ('{elasticity: -1}', 'elasticity'),
        ('{velocity: 3}', 'velocity'),
        ('{velocity: [a, b]}', 'velocity'),
        ('{velocity: [1e9, 0]}', 'velocity'),
        ('{spin: [1]}', 'spin'),
        ('{spin: 1e9}', 'spin'),
        ('{anchored: 1}', 'anchored'),
        ('{anchored: yes}', 'anchored'),
        ('{anchored: "true"}', 'anchored'),
        ('{kinematic: no}', 'kinematic'),
        ('{sensor: 0.0}', 'sensor'),
        ('{label: 1}', 'label'),
        ('{label: "\\t"}', 'label'),
        ('{forces: {force: [1, 0]}}', 'forces'),
        ('{forces: [{force: 1}]}', 'force'),
        ('{forces: [{at: [0, 0]}]}', 'force'),
        ('{forces: [{force: [1, 0], axes: wind}]}', 'axes'),
        ('{group: 1.0}', 'group'),
        ('{group: true}', 'group'),
        ('{group: 4294967296}', 'group'),
        ('{mass: 1, density: 1}', 'mass'),
        ('{mass: 2001-01-01}', 'mass'),
        ('{mass: 1_000}', 'mass'),
        ('{mass: 0x10}', 'mass'),
        ('{mass: 1:30}', 'mass'),
    ],
)
def test_a_bad_value_is_refused_by_its_key(text: str, field: str) -> None:
    refusal = refusal_of(text)
    assert (type(refusal), refusal.field) == (BadProperty, field)


@pytest.mark.parametrize('text', ['{velocity: []}', '{velocity: [1]}', '{velocity: [1, 2, 3]}'])
def test_a_velocity_of_the_wrong_length_is_refused(text: str) -> None:
    refusal = refusal_of(text)
    assert (type(refusal), refusal.field) == (Malformed, 'velocity')


@pytest.mark.parametrize(
    ('key', 'nearest'),
    [
        ('frcition', 'friction'),
        ('Elasticity', 'elasticity'),
        ('anchor', 'anchored'),
        ('z', ''),
        ('colour', 'color'),
        ('radius', 'scale'),
        ('position', 'pose'),
        ('lifetime', 'as fields'),
    ],
)
def test_an_unknown_key_is_refused_and_the_nearest_known_one_named(key: str, nearest: str) -> None:
    refusal = refusal_of(f'{{{key}: 1}}')
    assert (type(refusal), refusal.field) == (UnknownProperty, key)
    assert nearest in str(refusal)


@pytest.mark.parametrize('key', ['1', '1.5', 'true', '~', '[a]', '""'])
def test_a_key_that_is_no_word_is_refused(key: str) -> None:
    assert isinstance(refusal_of(f'{{{key}: 1}}'), UnknownProperty | Malformed)


@pytest.mark.parametrize(
    'text',
    [
        'friction',
        '3',
        '[friction, 3]',
        'friction 3',
        '{friction: 3',
        '{friction: 3}}',
        'friction: 1\n friction: 2',
        '{friction: 1}\n---\n{friction: 2}',
        '\t{friction: 1}',
        '!!python/object/apply:os.system ["false"]',
        '{friction: !!python/name:os.system }',
        '{anchored: !!bool maybe}',
        '{group: !!int ""}',
        '{mass: !!int x}',
        '{mass: !!float ""}',
        '{mass: !!timestamp x}',
        '{mass: !!binary x}',
        '{mass: !!omap [x]}',
        '{mass: !!null [x]}',
        '{mass: !!int [x]}',
        '{velocity: !!seq x}',
        '!!map [x]',
        '!!set {x}',
        '{!!merge x: y}',
        '{mass: !!int 0x%s}' % ('f' * 9000),
        '!x {friction: 1}',
        '{friction: *unknown}',
        '{? {a: 1} : 1}',
        'friction: \x07',
        '\ud800',
        '"',
        '%YAML 9.9\n--- {}',
    ],
)
def test_text_that_is_no_mapping_is_refused(text: str) -> None:
    refusal = refusal_of(text)
    assert (refusal.code, refusal.field) == ('malformed', 'text')


def test_a_key_that_comes_twice_is_refused() -> None:
    refusal = refusal_of('{friction: 0.1, friction: 0.9}')
    assert (refusal.code, refusal.field) == ('malformed', 'text')
    assert 'friction' in str(refusal)


def test_text_that_is_too_long_is_refused_unread() -> None:
    fits = '{friction: 0.25}'.ljust(LONGEST_TEXT)
    assert properties_of(fits).friction == 0.25
    refusal = refusal_of(fits + ' ')
    assert (refusal.code, refusal.field) == ('malformed', 'text')


@pytest.mark.parametrize('key', ['a', 'mass', 'velocity', 'anchored', 'group', '? [*j] : 1 #'])
def test_aliases_that_would_unfold_to_a_billion_are_refused_at_once(key: str) -> None:
    value = '&a [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]'
    for before, name in zip('abcdefghi', 'bcdefghij', strict=True):
        value = f'&{name} [{value}{f", *{before}" * 9}]'
    # Unfolded it would fill the memory.
    refusal = refusal_of(f'{key}: {value}')
    assert isinstance(refusal, UnknownProperty | BadProperty | Malformed)
    assert len(str(refusal)) < 500


@pytest.mark.parametrize('text', ['&a {mass: *a}', '{velocity: &a [*a, 1]}', '{mass: &a [[*a]]}'])
def test_text_that_holds_itself_is_refused(text: str) -> None:
    assert isinstance(refusal_of(text), BadProperty | Malformed)


@pytest.mark.parametrize(
    'text',
    [
        '[' * 5000 + ']' * 5000,
        '{mass: ' * 1400,
        '[' * 9000,
        '- ' * 5000,
        '? ' * 5000,
        ''.join(f'{" " * depth}a:\n' for depth in range(130)),
    ],
)
def test_deeply_nested_text_is_refused(text: str) -> None:
    refusal = refusal_of(text)
    assert isinstance(refusal, Malformed | UnknownProperty)


def test_what_a_refusal_says_stays_short_and_on_one_line() -> None:
    long = 'x' * 4000
    for text in (
        f'{{? {long} : 1}}',
        f'{{mass: {long}}}',
        f'{{velocity: [{long}, 1]}}',
        f'"{long}',
        f'{{group: {"9" * 4000}}}',
        f'{{mass: {"9" * 4000}}}',
        f'{{mass: "{long}"}}',
        f'{{? {long} : 1, ? {long} : 1}}',
    ):
        refusal = refusal_of(text)
        assert len(str(refusal)) < 300
        assert '\n' not in str(refusal)
        assert len(refusal.field) < 300
