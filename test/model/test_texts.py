# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Texts that others wrote are repeated abbreviated and printable."""

from collections.abc import Iterator

from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import BadWorldFile, Malformed, PhysSimError
from physsim_ros.model.names import LONGEST_NAME, shown_name
from physsim_ros.model.texts import (
    abbreviated,
    is_printable,
    LONGEST_MESSAGE,
    LONGEST_WORD,
    nearest_name,
)
import pytest

NASTY = [
    '\x1b[31mred',
    'bell\a',
    'line\nline',
    'half \ud83d',
    'sep\u2028sep',
    'nul\0',
    '\x9b31m',
    'cba\u202eabc',
]


@pytest.mark.parametrize('text', NASTY)
@pytest.mark.parametrize('kind', [PhysSimError, Malformed, BadWorldFile])
def test_a_message_is_printable_and_encodable(kind, text):
    message = str(kind(f'there is no {text}'))
    assert is_printable(message)
    message.encode()
    assert message.startswith('there is no ')


def test_an_ordinary_text_is_repeated_to_the_letter():
    for text in ("there is no body 'x/0'", '👩\u200d🚀', 'क्\u200dष', ''):
        assert str(PhysSimError(text)) == text
        assert abbreviated(text) == text
    # A name that an object has is its key.
    name = 'a' * (LONGEST_NAME - 2) + '/1'
    assert shown_name(name) == name


def test_a_megabyte_is_cut_and_the_reason_remains():
    for name in ('a' * 1_000_000, 'a b ' * 250_000, '\x1b' * 1_000_000):
        refusal = Malformed(f'{name!r} is not a name', field=name)
        assert str(refusal).endswith('is not a name')
        assert len(str(refusal)) <= LONGEST_MESSAGE
        answer = Answer.refused(refusal, topic='~/spawn', subject=name)
        # An escape has up to ten characters.
        assert max(len(answer.subject), len(answer.field)) <= 10 * LONGEST_WORD
        assert is_printable(answer.subject + answer.field)


def test_a_misspelt_name_is_answered_with_the_nearest():
    assert nearest_name('ramp0', ['box/0', 'ramp/0']) == "; nearest is 'ramp/0'"
    assert nearest_name('ramp0', ['box/0', 'ball/0']) == ''
    assert nearest_name('', []) == ''


def test_a_word_is_answered_with_the_names_that_have_it_not_with_another_word():
    known = ['trace', 'physics_rate', 'publish_rate', 'friction']
    assert nearest_name('rate', known) == "; nearest are 'physics_rate', 'publish_rate'"
    assert nearest_name('ball', ['box/0', 'ball/0']) == "; nearest is 'ball/0'"
    assert nearest_name('position', known) == ''
    assert nearest_name('p', known) == ''


def test_the_time_for_the_nearest_name_is_bounded():
    def names() -> Iterator[str]:
        yield from (f'box/{number}' for number in range(1000))
        pytest.fail('all names were compared')

    assert nearest_name('x' * 10**6, names()) == ''
