# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`python -m tools.evaluation.judge`: the trees of the judge of doubt, from imitated hands.

The examples are readings by the rules of strokes of the tuning half, of all kinds and faults:
right or wrong. Strokes without a meaning are among them, and wrong whatever they are read as.
Trees are fitted one after the other to the gradient of the likelihood (Newton boosting; Friedman,
2001; Chen and Guestrin, "XGBoost", 2016), each to a part of the examples, from the log odds of the
rules on.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
import csv
from io import StringIO
import itertools
from pathlib import Path
import sys

import numpy as np
from numpy.typing import NDArray
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes import judge
from physsim_ros.drawing.strokes.choice import is_likely
from physsim_ros.drawing.strokes.evidence import log_odds
from physsim_ros.drawing.strokes.forms import classification_of
from physsim_ros.drawing.strokes.judge import measures_of, Node, TABLE, Tree
from physsim_ros.drawing.strokes.reading import guesses_by_rules
from physsim_ros.drawing.strokes.stroke import resample_stroke
from physsim_ros.model.arrays import Flags
from physsim_ros.model.errors import Refusal

from .outlines import Floats
from .scenes import faulty_scenes, scenes

# Strokes of each kind and of each fault.
_COUNT = 120
# Number of trees, depth of each, the share of a tree's step that is taken, and of the examples
# that it is fitted to.
_TREES, _DEPTH, _RATE, _PART = 80, 3, 0.1, 0.7
# Quantiles of a measure that are limits, the penalty on the square of a leaf, and the least weight
# of its examples.
_LIMITS, _LARGE, _LEAST = np.linspace(0.02, 0.98, 24), 3.0, 2.0

# An example: the confidence of the rules, the measures of the reading, whether it is right.
Example = tuple[float, Mapping[str, float], bool]


def examples(count: int, half: str) -> Iterator[Example]:
    """Yield readings of strokes of all kinds and faults, so many of each."""
    settings = DrawingSettings()
    for scene in itertools.chain(scenes(count, half), faulty_scenes(count, half)):
        try:
            stroke = classification_of(resample_stroke(scene.samples))
        except Refusal:
            continue
        guesses = guesses_by_rules(stroke, scene.view, settings)
        if is_likely(guesses, settings):
            measures = measures_of(guesses, stroke, scene.view)
            yield guesses[0].confidence, measures, guesses[0].meaning == scene.meaning


def fit(found: list[Example]) -> list[Tree]:
    """Return trees of nearly the greatest likelihood of examples."""
    names = sorted({name for _, measures, _ in found for name in measures})
    values = np.array([[each.get(name, 0.0) for name in names] for _, each, _ in found])
    right = np.array([each for *_, each in found], dtype=np.float64)
    odds = np.array([log_odds(confidence) for confidence, *_ in found])
    limits = [np.unique(np.quantile(column, _LIMITS)) for column in values.T]
    rng = np.random.default_rng(0)
    trees: list[Tree] = []
    for _ in range(_TREES):
        share = 1.0 / (1.0 + np.exp(-odds))
        part = rng.random(len(right)) < _PART
        tree: Tree = {}
        _grow(tree, 1, values, (right - share, share * (1.0 - share)), part, (names, limits))
        for number, node in tree.items():
            tree[number] = Node(node.measure, node.limit, _RATE * node.value)
        odds += _values(tree, values, names)
        trees.append(tree)
    return trees


def _grow(
    tree: Tree,
    number: int,
    values: Floats,
    gradients: tuple[Floats, Floats],
    rows: Flags,
    measures: tuple[list[str], list[Floats]],
) -> None:
    """Add a node and those below it to a tree: the split of the greatest gain, or a leaf."""
    first, second = (each[rows] for each in gradients)
    total, weight = float(first.sum()), float(second.sum())
    best = 0.0, '', 0.0, np.zeros(0, np.bool_)
    if number < 2**_DEPTH:
        for name, column, limits in zip(measures[0], values.T, measures[1], strict=True):
            place: NDArray[np.intp] = np.searchsorted(limits, column[rows], 'left')
            size = len(limits) + 1
            lower = np.bincount(place, first, size).cumsum()[:-1]
            less = np.bincount(place, second, size).cumsum()[:-1]
            gain = lower**2 / (less + _LARGE) + (total - lower) ** 2 / (weight - less + _LARGE)
            gain[(less < _LEAST) | (weight - less < _LEAST)] = 0.0
            at = int(gain.argmax())
            if gain[at] > max(best[0], total**2 / (weight + _LARGE)):
                best = float(gain[at]), name, float(limits[at]), column <= limits[at]
    _, name, limit, low = best
    tree[number] = Node(name, limit, 0.0 if name else total / (weight + _LARGE))
    if name:
        _grow(tree, 2 * number, values, gradients, rows & low, measures)
        _grow(tree, 2 * number + 1, values, gradients, rows & ~low, measures)


def _values(tree: Tree, values: Floats, names: list[str]) -> Floats:
    """Return the log odds that a tree adds to each example."""
    at = np.ones(len(values), np.intp)
    for number, node in sorted(tree.items()):
        here = at == number
        if node.measure:
            at[here] = 2 * number + (values[here, names.index(node.measure)] > node.limit)
    return np.array([tree[each].value for each in at.tolist()])


def table(count: int = _COUNT) -> str:
    """Return the trees as a table, fitted to so many strokes of each kind."""
    file = StringIO()
    writer = csv.writer(file, lineterminator='\n')
    writer.writerow(('tree', 'node', 'measure', 'limit', 'value'))
    for number, tree in enumerate(fit(list(examples(count, 'tuning')))):
        for place, node in sorted(tree.items()):
            row = number, place, node.measure, f'{node.limit:.6g}', f'{node.value:.4f}'
            writer.writerow(row)
    return file.getvalue()


if __name__ == '__main__':
    Path(judge.__file__).with_name(TABLE).write_text(table(*map(int, sys.argv[1:])), 'utf-8')
