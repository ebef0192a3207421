# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Values as people write them are checked, and what is none is refused and named."""

import math

from physsim_ros.model.checks import check_finite, flag, number, pair, point_list, Whole
from physsim_ros.model.declarations import known_mapping
from physsim_ros.model.errors import BadProperty, Malformed, UnknownProperty
import pytest

from ..building import refusal


def test_numbers_and_pairs_are_told_from_what_only_looks_alike():
    assert number(3, 'n') == 3.0
    assert pair((1, 2), 'p') == (1.0, 2.0)
    for value in (True, '3', None):
        with pytest.raises(BadProperty):
            number(value, 'n')
    for other in ('ab', None, {1: 2, 3: 4}, {1, 2}):
        with pytest.raises(BadProperty):
            pair(other, 'p')


def test_a_count_of_finite_numbers_is_checked():
    check_finite((1.0, 2.0), 2, 'p')
    for values in ((1.0,), (1.0, 2.0, 3.0), (1.0, math.nan), (math.inf, 1.0), ()):
        assert refusal(check_finite, values, 2, 'p') == (Malformed, 'p')


def test_a_mapping_has_known_keys_only():
    assert known_mapping({'a': 1}, 'm', ['a', 'b']) == {'a': 1}
    with pytest.raises(UnknownProperty):
        known_mapping({'c': 1}, 'm', ['a', 'b'])
    for value in (None, [], 'a'):
        assert refusal(known_mapping, value, 'm', ['a', 'b']) == (BadProperty, 'm')


def test_a_list_of_points_is_pairs_of_numbers():
    assert point_list([[1, 2], (3.0, 4.0)], 'p') == ((1.0, 2.0), (3.0, 4.0))
    for value, error in ((None, BadProperty), ([1], BadProperty), ([[1]], Malformed)):
        with pytest.raises(error):
            point_list(value, 'p')


@pytest.mark.parametrize('value', [10**5000, -(10**5000), [10**5000]], ids=['+', '-', 'list'])
def test_a_number_of_any_length_is_refused_with_a_word_about_it(value):
    for check in (number, pair, Whole(0, 9), flag):
        with pytest.raises((BadProperty, Malformed)) as refused:
            check(value, 'n')
        assert refused.value.field == 'n'
