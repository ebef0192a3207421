# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The texts in the scripts of the page, as a reader of JavaScript finds them."""

from __future__ import annotations

from collections.abc import Iterator
import re
from typing import NamedTuple

# A comment, a string, the begin of a template, a regular expression after what no value ends with.
_PIECE = re.compile(
    r"""/\*.*?\*/ | //[^\n]* | '(?:[^'\\\n]|\\.)*' | ` | [{}] |
    (?<=[(,=:\[!&|?]) \s* /(?:[^/\\\n\[]|\\.|\[(?:[^\]\\\n]|\\.)*\])+/[a-z]*""",
    re.DOTALL | re.VERBOSE,
)
_PART = re.compile(r'(?:[^`\\$]|\\.|\$(?!\{))*', re.DOTALL)


class Text(NamedTuple):
    """
    A string, or what a template holds between its values.

    :param text: as a reader sees it
    :param translated: whether it is the argument of `t`
    :param line: where it begins
    """

    text: str
    translated: bool
    line: int


def texts_of(script: str) -> Iterator[Text]:
    """Yield the strings and the parts of templates of a script, without its comments."""
    place, depths = 0, [0]
    while found := _PIECE.search(script, place):
        place, piece = found.end(), found[0]
        begins = piece == '`'
        if piece == '{':
            depths[-1] += 1
        elif piece == '}' and depths[-1]:
            depths[-1] -= 1
        elif piece == '}':
            # The value of a template ends.
            depths.pop()
            begins = True
        elif piece.startswith("'"):
            begin = found.start()
            translated = script.endswith('t(', 0, begin) and not script[begin - 3].isalnum()
            line = script.count('\n', 0, begin) + 1
            yield Text(_unescaped(piece[1:-1]), translated, line)
        if not begins:
            continue
        part = _PART.match(script, place)
        assert part
        yield Text(_unescaped(part[0]), False, script.count('\n', 0, place) + 1)
        place = part.end() + 1
        if script[part.end()] == '$':
            depths.append(0)
            place += 1


def _unescaped(text: str) -> str:
    """Return a text without the escapes of JavaScript that the page uses."""
    text = re.sub(r'\\u([0-9a-fA-F]{4})', lambda found: chr(int(found[1], 16)), text)
    return re.sub(r'\\(.)', lambda found: {'n': '\n', 't': '\t'}.get(found[1], found[1]), text)
