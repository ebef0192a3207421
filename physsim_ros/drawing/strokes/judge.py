# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The judge of doubt: how sure the first guess is. It changes no meaning, and not their order.

Boosted trees (Friedman, "Greedy function approximation: a gradient boosting machine", 2001)
correct the log odds that the rules give to a reading, by the weights of all forms of the stroke,
and by how well an ellipse, a rectangle and straight sides fit its outline.
Each tree asks at most three questions, and adds log odds. Trees are rows of `judge.csv`, made by
`python -m tools.evaluation.judge` of readings of synthetic hands of the tuning half alone.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
import csv
from dataclasses import dataclass, replace
from importlib.resources import files

from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.strokes.evidence import log_odds, logistic
from physsim_ros.drawing.strokes.stages import Classification, Guess

# The file of the trees, beside this one.
TABLE = 'judge.csv'


@dataclass(frozen=True, slots=True)
class Node:
    """
    A node of a tree.

    :param measure: that is compared; '' at a leaf
    :param limit: up to which the first child is next, and beyond it the second
    :param value: of a leaf: log odds that it adds
    """

    measure: str
    limit: float
    value: float


# A tree: its nodes by number. The root is 1, the children of n are 2n and 2n + 1.
Tree = dict[int, Node]


def doubted(
    guesses: Sequence[Guess], stroke: Classification, scene: SceneQuery
) -> tuple[Guess, ...]:
    """
    Return guesses with the confidence of the judge in the first one.

    The others have no more confidence, nor more than the first one leaves.
    """
    if not guesses:
        return ()
    first, *others = guesses
    sure = judged(first.confidence, measures_of(guesses, stroke, scene))
    most = min(sure, 1.0 - sure)
    rest = (replace(each, confidence=min(each.confidence, most)) for each in others)
    return replace(first, confidence=sure), *rest


def measures_of(
    guesses: Sequence[Guess], stroke: Classification, scene: SceneQuery
) -> dict[str, float]:
    """Return the measures of guesses by which the first one is doubted, by their names."""
    return {
        'confidence': guesses[0].confidence,
        'group': guesses[0].group_confidence,
        'second': guesses[1].confidence if len(guesses) > 1 else 0.0,
        'bodies': float(bool(scene.names)),
        f'read as {guesses[0].meaning}': 1.0,
        **{f'form {form.name}': form.weight for form in stroke.forms},
        **stroke.fits,
    }


def judged(confidence: float, measures: Mapping[str, float]) -> float:
    """
    Return the confidence in a reading, 0 .. 1.

    :param confidence: of the rules, 0 .. 1
    :param measures: of the reading by name; one that it lacks is 0
    """
    return logistic(log_odds(confidence) + sum(_leaf_of(tree, measures) for tree in _TREES))


def _leaf_of(tree: Tree, measures: Mapping[str, float]) -> float:
    number = 1
    while (node := tree[number]).measure:
        number = 2 * number + (measures.get(node.measure, 0.0) > node.limit)
    return node.value


def _read_trees() -> list[Tree]:
    trees: dict[str, Tree] = {}
    path = files(__package__) / TABLE
    for row in csv.DictReader(path.read_text('utf-8').splitlines()):
        node = Node(row['measure'], float(row['limit']), float(row['value']))
        trees.setdefault(row['tree'], {})[int(row['node'])] = node
    return list(trees.values())


_TREES = _read_trees()
