# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Checks, docstring and keys of a value follow from the declarations of its fields."""

from dataclasses import dataclass, field
from typing import Annotated

from physsim_ros.model.checks import OneOf, VELOCITY, Within
from physsim_ros.model.declarations import Checked
from physsim_ros.model.errors import BadProperty, UnknownProperty
from physsim_ros.model.transform import Point
import pytest


@dataclass(frozen=True, slots=True, kw_only=True)
class Wheel(Checked):
    """
    A wheel.

    :raises BadProperty: a value is out of range
    """

    radius: Annotated[float, Within(0.001, 1e12, 'm'), 'of its rim', 'a note']
    tyre: Annotated[str | None, OneOf(('solid', 'air')), '`solid` or `air`'] = None
    slip: Annotated[Point, VELOCITY, 'against the floor'] = field(default_factory=lambda: (0, 0))


@dataclass(frozen=True, slots=True, kw_only=True)
class Caster(Wheel):
    """A wheel without a drive."""

    radius: float = 0.01
    trail: Annotated[float, Within(0.0, 1.0, 'm'), 'behind its axis'] = 0.02


def test_a_value_out_of_its_declared_range_is_refused():
    with pytest.raises(BadProperty, match='radius is 0; it must lie between 0'):
        Wheel(radius=0)
    with pytest.raises(BadProperty, match="tyre must be one of solid, air; nearest is 'air'"):
        Wheel(radius=1, tyre='aira')


def test_none_is_not_checked_where_it_is_the_default():
    assert Wheel(radius=1).tyre is None


def test_the_docstring_has_sentence_and_range_of_each_field_before_what_is_raised():
    lines = [line.strip() for line in (Wheel.__doc__ or '').strip().splitlines()]

    assert lines == [
        'A wheel.',
        '',
        ':param radius: of its rim; 0.001 .. 1e12 m',
        ':param tyre: `solid` or `air`',
        ':param slip: against the floor; up to 100000 m/s',
        ':raises BadProperty: a value is out of range',
    ]


def test_a_class_below_has_all_fields_with_its_own_defaults():
    fields = Caster.FIELDS

    assert [*fields] == ['radius', 'tyre', 'slip', 'trail']
    assert (fields['radius'].default, fields['radius'].sentence) == (0.01, 'of its rim')
    assert fields['radius'].notes == ('a note',)
    assert fields['slip'].default == (0, 0)
    assert Caster().radius == 0.01
    with pytest.raises(BadProperty, match='radius'):
        Caster(radius=-1)


def test_a_key_that_is_no_field_is_refused_with_the_nearest():
    with pytest.raises(UnknownProperty, match="no property 'radios'; nearest is 'radius'"):
        Wheel.from_mapping({'radios': 1})


def test_a_field_without_a_sentence_is_a_mistake_of_its_class():
    with pytest.raises(TypeError, match='size needs a check or none, and a sentence'):

        class Bad(Checked):
            size: Annotated[float, None, 'of it']


def test_declarations_as_texts_are_a_mistake_of_their_class():
    with pytest.raises(TypeError, match='declares fields as texts'):

        class Bad(Checked):
            size: 'Annotated[float, Within(0.0, 1.0), "of it"]'
