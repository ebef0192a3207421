# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The canonical spelling of names: names that look the same are the same, as far as characters go.

Method: Unicode Normalization Form C (Unicode Standard Annex 15), and no invisible characters
(Default_Ignorable_Code_Point). Joiners are visible in Persian, Hindi and emoji, and selectors
after emoji; there they are allowed, joiners by the contextual rules of RFC 5892, appendix A.1 and
A.2. Whether two letters of an Arabic script join is read off their presentation forms (U+FB50 to
U+FEFC), which Python has, in place of Joining_Type, which it has not: letters without such forms
count as not joining.
Letters of different scripts that look alike (Unicode Technical Standard 39) stay different.
"""

from __future__ import annotations

from functools import lru_cache
import unicodedata

# First and last of the ranges of Default_Ignorable_Code_Point (DerivedCoreProperties.txt, 15.0).
_IGNORABLE = (
    *((0xAD, 0xAD), (0x34F, 0x34F), (0x61C, 0x61C), (0x115F, 0x1160), (0x17B4, 0x17B5)),
    *((0x180B, 0x180F), (0x200B, 0x200F), (0x202A, 0x202E), (0x2060, 0x206F), (0x3164, 0x3164)),
    *((0xFE00, 0xFE0F), (0xFEFF, 0xFEFF), (0xFFA0, 0xFFA0), (0xFFF0, 0xFFF8)),
    *((0x1BCA0, 0x1BCA3), (0x1D173, 0x1D17A), (0xE0000, 0xE0FFF)),
)
# Selectors of the presentation of an emoji, which they follow.
_SELECTORS = '\ufe0e\ufe0f'
_NON_JOINER, _JOINER = '\u200c', '\u200d'
# Canonical combining class of a virama; Unicode categories of an emoji and of its skin colour.
_VIRAMA, _EMOJI = 9, {'So', 'Sk'}


def canonical(name: str) -> str:
    """Return a name in Normalization Form C."""
    return name if name.isascii() else unicodedata.normalize('NFC', name)


def has_invisible(name: str) -> bool:
    """Return whether a name has a character that shows nothing, and changes nothing beside it."""
    return not name.isascii() and any(
        _is_ignorable(character) and not _is_visible_joiner(name, place)
        for place, character in enumerate(name)
    )


def _is_ignorable(character: str) -> bool:
    return any(first <= ord(character) <= last for first, last in _IGNORABLE)


def _is_visible_joiner(name: str, place: int) -> bool:
    """Return whether a place has a joiner, or a selector of an emoji, where that is visible."""
    before, sign, after = name[:place], name[place], name[place:][1:]
    if sign in _SELECTORS:
        return unicodedata.category(before[-1:] or ' ') in _EMOJI
    before = before.rstrip(_SELECTORS)
    if sign not in {_NON_JOINER, _JOINER} or not before or not after:
        return False
    if unicodedata.combining(before[-1]) == _VIRAMA:
        return True
    if sign == _JOINER:
        return {unicodedata.category(before[-1]), unicodedata.category(after[0])} <= _EMOJI
    to_next, to_previous = _joining_letters()
    return _nearest_letter(before[::-1]) in to_next and _nearest_letter(after) in to_previous


def _nearest_letter(text: str) -> str:
    """Return the first character of a text that is no mark, or ''."""
    return next((each for each in text if unicodedata.category(each) != 'Mn'), '')


@lru_cache(maxsize=1)
def _joining_letters() -> tuple[frozenset[str], frozenset[str]]:
    """Return the letters that join to the next one, and those that join to the previous one."""
    letters: dict[str, set[str]] = {'<initial>': set(), '<final>': set()}
    for code in range(0xFB50, 0xFEFD):
        form, _, plain = unicodedata.decomposition(chr(code)).partition(' ')
        if form in letters and ' ' not in plain:
            letters[form].add(chr(int(plain, 16)))
    return frozenset(letters['<initial>']), frozenset(letters['<final>'])
