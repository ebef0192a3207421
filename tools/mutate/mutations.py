# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The mutations that there can be of a file: constants times 40, and operators turned round.

Bounds are not shifted (`<` to `<=`): in floating point, that is the same program.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
import re

FACTOR = 40
_TURNED = {'<': '>=', '>=': '<', '>': '<=', '<=': '>', '==': '!=', '!=': '=='}
_TURNED |= {'&&': '||', '||': '&&', 'and': 'or', 'or': 'and', 'is': 'is not', 'is not': 'is'}
_TURNED |= {'in': 'not in', 'not in': 'in', '===': '!==', '!==': '==='}
_TURNED |= {'+': '-', '-': '+', '*': '/', '/': '*', '|': '&', '&': '|', '+=': '-=', '-=': '+='}
# A constant of a file, or of an enum that has no other.
_CONSTANTS = re.compile(
    r'^((?:static const double|(?:export )?const [A-Z_]+) .*;|enum \{ \w+ = .* \};)', re.MULTILINE
)
_NUMBER = re.compile(r'(?<== )\d[\d.e+-]*')
# Without loops: one that never ends is no answer. Without assertions, which are tests themselves.
_STATEMENTS = re.compile(
    r'^(?!.*\b(?:for|while|assert) ?\()(?! *(?://|\*|/\*|import)).*$', re.MULTILINE
)
_OPERATOR = re.compile(r'(?<= )(<=|>=|<|>|===?|!==?|&&?|\|\|?|[-+]=|[-+*/])(?= )')


@dataclass(frozen=True, slots=True, kw_only=True)
class Mutation:
    """A part of a file, by its bytes, and the text that takes its place."""

    path: Path
    begin: int
    end: int
    after: str

    def applied(self, text: bytes) -> bytes:
        """Return the text of the file with this mutation."""
        begin, end = self.begin, self.end
        return text[:begin] + self.after.encode() + text[end:]

    def told(self, text: bytes) -> str:
        """Return the place, and its line before and after."""
        line = text.count(b'\n', 0, self.begin)
        before, after = (each.decode().splitlines()[line] for each in (text, self.applied(text)))
        return f'{self.path}:{line + 1}\n  - {before.strip()}\n  + {after.strip()}'


def mutations_of(path: Path, text: str) -> list[Mutation]:
    """Return the mutations of a file in C, JavaScript or Python."""
    found = _in_python(text) if path.suffix == '.py' else _by_lines(text)
    return [Mutation(path=path, begin=begin, end=end, after=after) for begin, end, after in found]


def _by_lines(text: str) -> Iterator[tuple[int, int, str]]:
    def at(line: re.Match[str], part: re.Match[str], after: str) -> tuple[int, int, str]:
        begin = len(text[: line.start() + part.start()].encode())
        return begin, begin + len(part[0].encode()), after

    for line in _CONSTANTS.finditer(text):
        for part in _NUMBER.finditer(line[0].partition('//')[0]):
            yield at(line, part, f'{part[0]} * {FACTOR}')
    for line in _STATEMENTS.finditer(text):
        for part in _OPERATOR.finditer(line[0].partition('//')[0]):
            yield at(line, part, _TURNED[part[0]])


def _in_python(text: str) -> Iterator[tuple[int, int, str]]:
    lines = text.encode().splitlines(keepends=True)
    starts = [0, *(sum(map(len, lines[:number])) for number in range(1, len(lines)))]
    data = b''.join(lines)

    def place(line: int, column: int) -> int:
        return starts[line - 1] + column

    def between(left: ast.expr, right: ast.expr) -> Iterator[tuple[int, int, str]]:
        begin = place(left.end_lineno or 0, left.end_col_offset or 0)
        end = place(right.lineno, right.col_offset)
        operator = data[begin:end].decode()
        word = operator.strip(' ()\n')
        if word in _TURNED:
            first = begin + operator.index(word)
            yield first, first + len(word), _TURNED[word]

    module = ast.parse(text)
    types = {id(part) for each in _annotations(module) for part in ast.walk(each)}
    for node in module.body:
        value = node.value if isinstance(node, (ast.Assign, ast.AnnAssign)) else None
        # 0 times 40 is 0.
        if isinstance(value, ast.Constant) and type(value.value) in {int, float} and value.value:
            end = place(value.end_lineno or 0, value.end_col_offset or 0)
            yield end, end, f' * {FACTOR}'
    for part in ast.walk(module):
        if isinstance(part, ast.Compare) and len(part.comparators) == 1:
            yield from between(part.left, part.comparators[0])
        elif isinstance(part, ast.BoolOp):
            yield from between(*part.values[:2])
        elif isinstance(part, ast.BinOp) and id(part) not in types:
            yield from between(part.left, part.right)


def _annotations(module: ast.Module) -> Iterator[ast.expr]:
    """Yield the types of a module, which are not evaluated."""
    for part in ast.walk(module):
        for name in ('annotation', 'returns'):
            if each := getattr(part, name, None):
                yield each
