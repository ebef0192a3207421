# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Texts that somebody else has written, as far as they are repeated to others."""

from __future__ import annotations

from collections.abc import Iterable
import difflib
from itertools import islice
import unicodedata

# Unicode categories of control characters, surrogates, line and paragraph separators. Format
# characters are allowed: Persian, Hindi and emoji are written with them.
_UNPRINTABLE = {'Cc', 'Cs', 'Zl', 'Zp'}
# Bidirectional classes of the characters that change the order in which others are shown, so that
# a text reads as another one (Unicode Standard Annex 9; CVE-2021-42574).
_REORDERING = {'LRE', 'RLE', 'LRO', 'RLO', 'PDF', 'LRI', 'RLI', 'FSI', 'PDI'}
# Greatest lengths of a word and of a whole message [characters]: some six lines of a terminal.
LONGEST_WORD, LONGEST_MESSAGE = 80, 480
_OMISSION = '…'
# Names that a misspelt one is compared with [1], some 10 µs each: a peer may repeat its mistake.
_MOST_COMPARED = 200


def is_printable(text: str) -> bool:
    """Return whether a text has no character of control, of order or of lines, nor a surrogate."""
    return text.isprintable() or not any(
        unicodedata.category(character) in _UNPRINTABLE
        or unicodedata.bidirectional(character) in _REORDERING
        for character in text
    )


def abbreviated(text: str, longest: int = LONGEST_WORD) -> str:
    """Return a text with its middle left out where it is longer [characters], escaped."""
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
    """Return a message with all long words abbreviated, and itself too, escaped."""
    if len(text) > LONGEST_WORD:
        text = ' '.join(map(abbreviated, text.split(' ')))
    return abbreviated(text, LONGEST_MESSAGE)


def nearest_name(name: str, known: Iterable[str]) -> str:
    """
    Return the end of a sentence that names the most similar of the known names, or ''.

    :param name: that is not known
    :param known: names, of which the first `_MOST_COMPARED` are compared
    """
    # Similarity below difflib's default cutoff (0.6) suggests another word, not a misspelling.
    near = difflib.get_close_matches(abbreviated(name), islice(known, _MOST_COMPARED), n=1)
    return f'; nearest is {near[0]!r}' if near else ''
