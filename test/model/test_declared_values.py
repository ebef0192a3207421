# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Every declared number, flag, vector and word of the package has its range, and no more."""

from collections.abc import Callable, Iterator
import math
from typing import Any

from physsim_ros.drawing import DrawingSettings
from physsim_ros.model.checks import flag, OneOf, Vector, Whole, Within
from physsim_ros.model.declarations import Checked, Declaration
from physsim_ros.model.errors import BadProperty, Malformed, Refusal
from physsim_ros.model.requests import Request
import pytest

NOT_FINITE = (math.nan, math.inf, -math.inf, 10**400, -(10**400))
# Whatever a front imports has been declared.
assert {DrawingSettings, Request} <= {*Checked.__subclasses__()}


def _classes(kind: type[Checked] = Checked) -> Iterator[type[Checked]]:
    for each in kind.__subclasses__():
        if each.__module__.startswith('physsim_ros.'):
            yield each
            yield from _classes(each)


DECLARED = {
    f'{kind.__name__}.{name}': each for kind in _classes() for name, each in kind.FIELDS.items()
}


def every(check: type) -> Callable[[Any], Any]:
    """Give a test each declaration whose check is of a class."""
    found = {name: each for name, each in DECLARED.items() if isinstance(each.check, check)}
    return pytest.mark.parametrize('declared', found.values(), ids=found.keys())


def refused(declared: Declaration, value: object, kind: type[Refusal] = BadProperty) -> None:
    """Assert that a value is refused by the name of its field, in a short message."""
    assert declared.check is not None
    with pytest.raises(kind) as caught:
        declared.check(value, declared.name)
    assert caught.value.field == declared.name
    assert declared.name in str(caught.value)
    assert len(str(caught.value)) < 1000


@every(Within)
def test_a_number_lies_in_its_range(declared):
    check: Any = declared.check
    for value in (check.low, check.high):
        kept = check(value, declared.name)
        assert (type(kept), kept) == (float, value)
    for value in (math.nextafter(check.low, -math.inf), math.nextafter(check.high, math.inf)):
        refused(declared, value)
    for value in NOT_FINITE:
        refused(declared, value, Malformed)
    for other in ('1', True, False, [1.0], {'a': 1}, (1.0,), b'1', 1j, None):
        refused(declared, other)


@every(Whole)
def test_a_whole_number_lies_in_its_range(declared):
    check: Any = declared.check
    assert [check(value, 'n') for value in (check.low, check.high)] == [check.low, check.high]
    for value in (check.low - 1, check.high + 1, 5.0, '5', None, True, math.nan, [5]):
        refused(declared, value)


@every(Vector)
def test_a_vector_is_two_numbers_of_at_most_a_length(declared):
    check: Any = declared.check
    most = check.longest
    assert check([3, -4], 'v') == (3.0, -4.0)
    assert check((0.6 * most, 0.8 * most), 'v') == (0.6 * most, 0.8 * most)
    for value in ([], [1.0], [1.0] * 3, [math.nan, 0.0], [0.0, math.inf]):
        refused(declared, value, Malformed)
    too_long = ((0.8 * most, 0.8 * most), [1e308, 1e308])
    for other in (
        *too_long,
        1.0,
        'ab',
        {'x': 1.0},
        ['a', 'b'],
        [True, 0.0],
        [None, 0.0],
        [[1], 2],
    ):
        refused(declared, other)


@every(OneOf)
def test_a_word_is_one_of_its_words(declared):
    check: Any = declared.check
    assert [check(word, 'w') for word in check.words] == [*check.words]
    for other in (f'{check.words[0]}x', '', None, 1, [check.words[0]]):
        refused(declared, other)


FLAGS = {name: each for name, each in DECLARED.items() if each.check is flag}


@pytest.mark.parametrize('declared', FLAGS.values(), ids=FLAGS.keys())
def test_a_flag_is_true_or_false_and_nothing_else(declared):
    assert [flag(value, 'f') for value in (True, False)] == [True, False]
    for other in (0, 1, 'true', 'yes', 1.0, [], [True], None):
        refused(declared, other)


@pytest.mark.parametrize('name', DECLARED)
def test_a_message_is_short_whatever_was_given(name):
    nested: object = [1, 2, 3]
    for _ in range(40):
        nested = [nested] * 9
    declared = DECLARED[name]
    if declared.check is None:
        return
    for value in (nested, {'x' * 10**5: 1}, 10**4000):
        with pytest.raises(Refusal) as caught:
            declared.check(value, declared.name)
        assert len(str(caught.value)) < 1000
