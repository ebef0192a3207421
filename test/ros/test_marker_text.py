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


@pytest.mark.parametrize('text', ['{actor: null, mass: 2}', 'actor:\nmass: 2'])
def test_a_property_that_is_null_is_unset(text: str) -> None:
    request = body_request(box(text=text), frame_id='map')

    assert isinstance(request, Spawn)
    assert (request.unset, request.properties) == (('actor',), Properties(mass=2.0))


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


# Tests of the values of properties are in `test/model`; these are of what YAML makes of a text.
@pytest.mark.parametrize(
    ('text', 'code', 'field'),
    [
        ('{density: heavy}', 'bad_property', 'density'),
        ('{density: 1e999}', 'malformed', 'density'),
        ('{density: .NaN}', 'malformed', 'density'),
        ('{velocity: [.inf, 0]}', 'malformed', 'velocity'),
        ('{velocity: [1]}', 'malformed', 'velocity'),
        ('{anchored: yes}', 'bad_property', 'anchored'),
        ('{kinematic: no}', 'bad_property', 'kinematic'),
        ('{forces: {force: [1, 0]}}', 'bad_property', 'forces'),
        ('{forces: [{at: [0, 0]}]}', 'bad_property', 'force'),
        ('{group: 1.0}', 'bad_property', 'group'),
        ('{mass: 1, density: 1}', 'bad_property', 'mass'),
        ('{mass: 2001-01-01}', 'bad_property', 'mass'),
        ('{mass: 1_000}', 'bad_property', 'mass'),
        ('{mass: 0x10}', 'bad_property', 'mass'),
        ('{mass: 1:30}', 'bad_property', 'mass'),
        ('{friction: 0.1, friction: 0.9}', 'malformed', 'text'),
        ('{1: 1}', 'unknown_property', '1'),
        ('{[a]: 1}', 'malformed', 'text'),
    ],
)
def test_a_bad_value_is_refused_by_its_key(text: str, code: str, field: str) -> None:
    refusal = refusal_of(text)
    assert (refusal.code, refusal.field) == (code, field)
    assert len(str(refusal)) < 300


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
