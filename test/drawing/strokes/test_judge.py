# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The judge of doubt: trees that are whole, that change no reading, and that learn from errors."""

from collections.abc import Sequence
import csv
from importlib.resources import files

import numpy as np
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes import judge
from physsim_ros.drawing.strokes.forms import classification_of
from physsim_ros.drawing.strokes.judge import doubted, judged, measures_of, TABLE
from physsim_ros.drawing.strokes.reading import guesses_by_rules
from physsim_ros.drawing.strokes.signs import SIGNS
from physsim_ros.drawing.strokes.stages import Classification, Guess
from physsim_ros.drawing.strokes.stroke import resample_stroke
import pytest
from tools.evaluation.judge import Example, fit, table
from tools.evaluation.scenes import scenes

# A stroke with its forms, the guesses of the rules, and its scene.
ByRules = tuple[Classification, Sequence[Guess], SceneQuery]


@pytest.fixture(scope='module')
def guessed() -> list[ByRules]:
    """Return strokes of every kind in their scenes."""
    found = []
    for scene in scenes(1, 'report'):
        stroke = classification_of(resample_stroke(scene.samples))
        guesses = guesses_by_rules(stroke, scene.view, DrawingSettings())
        found.append((stroke, guesses, scene.view))
    return found


def test_every_tree_ends_in_leaves_and_asks_for_measures_that_readings_have(
    guessed: list[ByRules],
) -> None:
    rows = list(csv.DictReader((files(judge.__package__) / TABLE).read_text('utf-8').splitlines()))
    nodes = {(row['tree'], int(row['node'])): row['measure'] for row in rows}

    assert len(nodes) == len(rows)
    for (tree, number), measure in nodes.items():
        children = {(tree, 2 * number), (tree, 2 * number + 1)}
        assert children <= nodes.keys() if measure else not children & nodes.keys()
    had = {f'form {sign.name}' for sign in SIGNS}
    for stroke, guesses, scene in guessed:
        had |= measures_of(guesses, stroke, scene).keys()
    assert {each for each in nodes.values() if not each.startswith('read as')} - {''} <= had


def test_the_judge_changes_no_reading(guessed: list[ByRules]) -> None:
    for stroke, by_rules, scene in guessed:
        guesses = doubted(by_rules, stroke, scene)

        assert [each.meaning for each in guesses] == [each.meaning for each in by_rules]
        confidences = [each.confidence for each in guesses]
        assert confidences[0] == max(confidences)
        assert sum(confidences[:2]) <= 1.0


def test_trees_learn_which_readings_are_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(0)

    def examples(count: int) -> list[Example]:
        # Wrong where both measures are high, and not where one is.
        found = rng.random((count, 2))
        return [
            (0.9, {'a': a, 'b': b}, bool(min(a, b) < 0.7 or rng.random() < 0.1))
            for a, b in found.tolist()
        ]

    monkeypatch.setattr(judge, '_TREES', fit(examples(400)))
    right = [judged(0.9, measures) for _, measures, right in examples(300) if right]
    wrong = [judged(0.9, measures) for _, measures, right in examples(300) if not right]

    assert np.mean(right) > 0.9
    assert np.mean(wrong) < 0.3


@pytest.mark.slow
def test_the_trees_are_what_their_command_makes() -> None:
    """`python -m tools.evaluation.judge` makes them anew."""
    assert (files(judge.__package__) / TABLE).read_text('utf-8') == table()
