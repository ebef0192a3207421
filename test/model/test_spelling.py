# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Names that look the same are the same, or are refused."""

import unicodedata

from physsim_ros import Delete, Disc, Join, Simulation, Spawn
from physsim_ros.model.errors import Malformed
from physsim_ros.model.names import check_hand_name, check_name
import pytest

# Persian, Urdu with a vowel mark, Hindi, Bengali, a composed emoji.
JOINED = ['می\u200cروم', 'نَ\u200cرم', 'क्\u200dष', 'ক্\u200cষ', '👩\u200d🚀', '❤\ufe0f\u200d🔥']
# A joiner between letters that do not join, at the end, between Latin letters; other characters
# that show nothing: soft hyphen, zero-width space, word joiner, Hangul filler, a tag.
INVISIBLE = [
    *('د\u200cر', 'می\u200c', 'a\u200cb', 'a\u200db', 'a\ufe0fb', '\u200da', 'क\u200dष'),
    *('a\u00adb', 'a\u200bb', 'a\u2060b', 'a\u3164b', 'a\ufeffb', 'a\U000e0061b'),
]


@pytest.mark.parametrize('word', JOINED)
def test_a_joiner_is_part_of_a_name_where_it_is_visible(word: str) -> None:
    assert check_name(f'{word}/1') == f'{word}/1'
    assert check_hand_name(word, 'hand') == word


@pytest.mark.parametrize('word', INVISIBLE)
def test_a_name_with_an_invisible_character_is_refused(word: str) -> None:
    with pytest.raises(Malformed, match='invisible') as refused:
        check_name(f'{word}/1')
    assert str(refused.value).isprintable()
    with pytest.raises(Malformed, match='invisible'):
        check_hand_name(word, 'hand')


@pytest.mark.parametrize('word', ['Würfel', 'e\u0301', 'ﷺ', '한', '\u212b'])
def test_a_body_has_one_name_however_its_characters_are_composed(word: str) -> None:
    forms = [unicodedata.normalize(form, f'{word}/0') for form in ('NFC', 'NFD')]
    for given, asked in (forms, reversed(forms)):
        simulation = Simulation()
        simulation.perform(Spawn(name=given, shape=Disc(radius=0.1)))
        assert simulation.perform(
            Spawn(name=asked, shape=Disc(radius=0.2), pose=(1.0, 0.0, 0.0))
        ).startswith('changed')
        simulation.perform(Join(name='j/0', kind='rod', a=asked, points=((1.0, 0.0), (2.0, 0.0))))
        assert simulation.frame.snapshot.row(asked) == 0
        simulation.perform(Delete(name=asked))
        assert len(simulation.world) == 0
