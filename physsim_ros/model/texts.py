# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Texts of users: abbreviated and escaped before messages repeat them; words that they mean."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
import difflib
from itertools import islice
from typing import Self
import unicodedata

from physsim_ros.model.translation import Text

# Unicode categories of control characters, surrogates, line and paragraph separators. Format
# characters are allowed: Persian, Hindi and emoji need them.
_UNPRINTABLE = {'Cc', 'Cs', 'Zl', 'Zp'}
# Bidirectional classes of characters that change the order in which other characters are shown: a
# text with them can look like another text (Unicode Standard Annex 9; CVE-2021-42574).
_REORDERING = {'LRE', 'RLE', 'LRO', 'RLO', 'PDF', 'LRI', 'RLI', 'FSI', 'PDI'}
# Greatest lengths of a word and of a whole message [characters]: some six lines of a terminal.
LONGEST_WORD, LONGEST_MESSAGE = 80, 480
_OMISSION = '…'
# Names that a misspelt one is compared with [1], some 10 µs each: a peer may repeat its mistake.
_MOST_COMPARED = 200
# Names that begin with a part, or have a word that does [1]; length of such a part [characters].
_MOST_NAMED = 3
_LEAST_PART = 3
# Least similarity of a misspelt name, 0 .. 1, of `difflib`: with one wrong letter a name of three
# has 0.67; `position` and `friction`, which are two words, have 0.63.
_SIMILAR = 0.65


class Words(tuple[str, ...]):
    """The everyday words that people use for a key, which a refusal then names."""

    __slots__ = ()

    def __new__(cls, *words: str) -> Self:
        """Make it of the words."""
        return super().__new__(cls, words)


def is_printable(text: str) -> bool:
    """Return whether a text has no control, reordering, line or surrogate character."""
    return text.isprintable() or not any(
        unicodedata.category(character) in _UNPRINTABLE
        or unicodedata.bidirectional(character) in _REORDERING
        for character in text
    )


def abbreviated(text: str, longest: int = LONGEST_WORD) -> str:
    """Return a text, escaped, and without its middle if it is longer [characters]."""
    if len(text) > longest:
        kept = (longest - len(_OMISSION)) // 2
        text = text[:kept] + _OMISSION + text[-kept:]
    if is_printable(text):
        return text
    return ''.join(
        character if is_printable(character) else character.encode('unicode_escape').decode()
        for character in text
    )


def message_text(text: str) -> str:
    """Return a message, escaped; its long words and the message itself are abbreviated."""
    english = text
    if len(text) > LONGEST_WORD:
        english = ' '.join(map(abbreviated, text.split(' ')))
    english = abbreviated(english, LONGEST_MESSAGE)
    return text.with_english(english) if isinstance(text, Text) else english


def nearest_name(name: str, known: Iterable[str]) -> str:
    """
    Return the end of a sentence that names the most similar of the known names, or ''.

    Names of which a word begins with it are nearest: 'publish_rate' to 'rate', 'ball/0' to 'ball'.

    :param name: that is not known
    :param known: names, of which the first `_MOST_COMPARED` are compared
    """
    compared = [str(each) for each in islice(known, _MOST_COMPARED)]
    similar = difflib.get_close_matches(abbreviated(name), compared, 1, _SIMILAR)
    begun = [each for each in compared if f'_{name}' in f'_{each}']
    near = (begun[:_MOST_NAMED] if len(name) >= _LEAST_PART else []) or similar
    if not near:
        return ''
    template = '; nearest are {names}' if len(near) > 1 else '; nearest is {names}'
    return Text(template, names=', '.join(map(repr, near)))


def name_meant(word: str, everyday: Mapping[str, Collection[str]]) -> str:
    """
    Return the first name that people mean by a word, or ''.

    :param everyday: words by the names that they mean
    """
    word = word.lower().replace(' ', '_').replace('-', '_')
    return next((name for name, words in everyday.items() if word in words), '')


def hint_of(word: str, everyday: Mapping[str, Collection[str]]) -> str:
    """
    Return the end of a sentence that names what people mean by a word, or the most similar name.

    :param everyday: words by the names that there are
    """
    meant = name_meant(word, everyday)
    return Text("; use '{name}'", name=meant) if meant else nearest_name(word.lower(), everyday)


def no_kind(noun: str, kind: str, hint: str, kinds: str) -> Text:
    """
    Return the message about a kind that there is not.

    :param noun: of which it would be a kind
    :param hint: `hint_of` it
    :param kinds: that there are
    """
    template = 'there is no kind of {noun} {kind}{hint}; there are {kinds}'
    return Text(template, noun=noun, kind=kind, hint=hint, kinds=kinds)
