# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Each shape is written to world files and read again under a key of its own."""

from physsim_ros.model.errors import BadProperty, Refusal, UnknownProperty
from physsim_ros.model.shapes import kinds, SHAPES
import pytest

from ...building import refusal
from ...building import SHAPES as EXAMPLES


def test_every_class_with_a_key_is_a_shape():
    keyed = {each for each in vars(kinds).values() if hasattr(each, 'KEY')}

    assert keyed == {*SHAPES.values()}


@pytest.mark.parametrize('shape', EXAMPLES.values(), ids=EXAMPLES.keys())
def test_a_shape_is_read_as_it_was_written(shape):
    assert SHAPES[shape.KEY].from_value(shape.entry(), shape.KEY) == shape


@pytest.mark.parametrize('key', SHAPES)
@pytest.mark.parametrize('entry', [None, 1, 'round', {}, {'points': None}, [1, 2]])
def test_an_entry_that_is_none_is_refused(key, entry):
    with pytest.raises(Refusal):
        SHAPES[key].from_value(entry, key)


@pytest.mark.parametrize(
    ('entry', 'error', 'field'),
    [
        ({'centers': [[0, 0]]}, BadProperty, 'shape'),
        (
            {'circle': {'radius': 1}, 'box': {'width': 1, 'height': 1}, 'centers': [[0, 0]]},
            BadProperty,
            'shape',
        ),
        ({'polygon': [[0, 0], [1, 0], [0, 1]], 'centers': [[0, 0]]}, UnknownProperty, 'polygon'),
    ],
)
def test_a_compound_is_made_of_one_disc_or_box(entry, error, field):
    assert refusal(SHAPES['compound'].from_value, entry, 'compound') == (error, field)
