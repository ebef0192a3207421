# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A body's name is `<namespace>/<id>`, in one spelling."""

from physsim_ros.model.errors import Malformed
from physsim_ros.model.names import check_body_name, check_name, LONGEST_NAME, split_name
import pytest

NAMES = {
    'ball/0': ('ball', 0),
    'ball/-7': ('ball', -7),
    'a b/12': ('a b', 12),
    'a/b/3': ('a/b', 3),
    '7/7': ('7', 7),
    'Würfel/1': ('Würfel', 1),
    '球/1': ('球', 1),
    'می\u200cروم/1': ('می\u200cروم', 1),
    'क्\u200dष/1': ('क्\u200dष', 1),
    '👩\u200d🚀/1': ('👩\u200d🚀', 1),
    'à\xa0gauche/1': ('à\xa0gauche', 1),
    '赤い\u3000球/1': ('赤い\u3000球', 1),
    'a|b/1': ('a|b', 1),
    f'a/{2**31 - 1}': ('a', 2**31 - 1),
    f'a/{-(2**31)}': ('a', -(2**31)),
}
NO_NAMES = [
    '', '/', 'ball', 'ball/', '/7', '7', 'world', 'ball/x', 'ball/7.0', 'ball/07', 'ball/+7',
    'ball/-0', 'ball/1_0', 'ball/ 7', 'ball/7 ', 'ball/\u0667', 'ball/0x7', 'ball/1e3', 'ball\\7',
]  # fmt: skip


@pytest.mark.parametrize(('name', 'parts'), NAMES.items())
def test_a_name_is_a_namespace_and_an_id(name, parts):
    check_name(name)

    assert split_name(name) == parts
    assert '/'.join(map(str, parts)) == name


@pytest.mark.parametrize('name', NO_NAMES)
def test_what_is_no_name_is_malformed_and_has_no_namespace(name):
    assert split_name(name)[0] == ''
    with pytest.raises(Malformed) as refused:
        check_name(name)
    assert refused.value.field == 'name'
    assert 'the id a whole number' in str(refused.value)


@pytest.mark.parametrize(
    'character',
    ['\0', '\n', '\t', '\x7f', '\x85', '\ud800', '\u2028', '\u2029', '\u202e', '\u2066'],
)
def test_a_character_that_cannot_be_printed_is_refused(character):
    with pytest.raises(Malformed) as refused:
        check_name(f'a{character}b/1')
    assert str(refused.value).isprintable()


@pytest.mark.parametrize('id_', [2**31, -(2**31) - 1, 10**30])
def test_an_id_is_a_number_of_32_bits(id_):
    with pytest.raises(Malformed):
        check_name(f'a/{id_}')


def test_an_id_of_thousands_of_digits_is_no_name():
    with pytest.raises(Malformed):
        check_name('a/' + '9' * 100_000)


def test_a_name_has_an_end():
    check_name('a' * (LONGEST_NAME - 2) + '/1')
    with pytest.raises(Malformed) as refused:
        check_name('a' * (LONGEST_NAME - 1) + '/1')
    assert len(str(refused.value)) < LONGEST_NAME


@pytest.mark.parametrize('name', ['a|b/1', '|/1', 'a\ufffd/1'])
def test_a_body_has_no_name_that_others_may_mistake(name):
    with pytest.raises(Malformed):
        check_body_name(name)
