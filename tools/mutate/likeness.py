# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The order in which tests are run after a mutation: by the words that they share with its file.

A word weighs the more, the fewer other files have it (tf-idf; of tests after a change: Saha et
al., "An Information Retrieval Approach for Regression Test Prioritization", ICSE 2015).
"""

from __future__ import annotations

from collections import Counter
from functools import cache
import math
from pathlib import Path
import re
from test.source_tree import ROOT

from .mutations import Mutation

# A word in the name of a file, and in a line near the mutation, counts as so many in its text.
IN_NAME = 20
NEAR = 5
# Lines before and after the mutation.
LINES = 8


def by_likeness(tests: list[Path], mutation: Mutation) -> list[Path]:
    """Return tests, those first that share the most words with the lines near a mutation."""
    sources = (ROOT / 'physsim_ros').rglob(f'*{mutation.path.suffix}')
    rarity_here = _rarity(tuple(sources))
    rarity = _rarity(tuple(tests))
    text = (ROOT / mutation.path).read_bytes()
    line = text.count(b'\n', 0, mutation.begin)
    first, end = max(0, line - LINES), line + LINES
    near = b'\n'.join(text.split(b'\n')[first:end]).decode()
    asked = {
        word: _weight(count) * rarity_here[word]
        for word, count in (_words(ROOT / mutation.path) + _counted(near, NEAR)).items()
    }

    def likeness(test: Path) -> float:
        weights = {word: _weight(count) * rarity[word] for word, count in _words(test).items()}
        shared = sum(asked.get(word, 0.0) * weight for word, weight in weights.items())
        return shared / math.hypot(*weights.values())

    return sorted(tests, key=likeness, reverse=True)


def _weight(count: int) -> float:
    return 1.0 + math.log(count)


@cache
def _rarity(files: tuple[Path, ...]) -> dict[str, float]:
    having = Counter(word for path in files for word in _words(path))
    return {word: math.log((len(files) + 1) / count) for word, count in having.items()}


@cache
def _words(path: Path) -> Counter[str]:
    stem = path.stem.removeprefix('test_')
    return _counted(path.read_text(encoding='utf-8'), 1) + _counted(stem, IN_NAME)


def _counted(text: str, times: int) -> Counter[str]:
    # Parts of `camelCase` and `snake_case`; cut, so that `measures` is like `measuring`.
    found = Counter(word[:6].lower() for word in re.findall(r'[A-Za-z]?[a-z]{3,}', text))
    return Counter({word: times * count for word, count in found.items()})
