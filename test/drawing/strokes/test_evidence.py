# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The table has every measure of every sign; probabilities are shares, confidences grow."""

from collections.abc import Iterator
from importlib.resources import files
import itertools

import numpy as np
from physsim_ros.drawing.strokes import evidence
from physsim_ros.drawing.strokes.choice import group_confidence
from physsim_ros.drawing.strokes.evidence import (
    CONSTANT,
    probabilities,
    TABLE,
    Term,
    terms_of,
)
from physsim_ros.drawing.strokes.features import features_of
from physsim_ros.drawing.strokes.plain_forms import fits_of, SHAPES
from physsim_ros.drawing.strokes.signs import SIGNS
from physsim_ros.drawing.strokes.stages import Candidate, Sign
from physsim_ros.drawing.strokes.stroke import resample_stroke
import pytest
from tools.evaluation import arrows, figures
from tools.evaluation.fit import table
from tools.evaluation.hands import stroke


def test_a_term_is_linear_between_its_knots_and_constant_beyond_them() -> None:
    term = Term('length', (1.0, 2.0, 4.0), (-1.0, 3.0, 0.0))

    assert [term.at(value) for value in (0.0, 1.0, 1.5, 2.0, 3.0, 4.0, 9.0)] == [
        -1.0, -1.0, 1.0, 3.0, 1.5, 0.0, 0.0,
    ]  # fmt: skip


def test_probabilities_are_shares_of_odds_and_the_rest_is_no_sign() -> None:
    one, other = probabilities([np.log(3.0), np.log(2.0)])

    assert (one, other) == pytest.approx((3 / 6, 2 / 6))
    assert probabilities([800.0, -800.0]) == [1.0, 0.0]
    assert not probabilities([])


def test_more_weight_is_more_confidence_and_none_is_certain() -> None:
    confidences = [group_confidence(share, 1.0) for share in (0.0, 0.2, 0.5, 0.8, 1.0)]

    assert all(less < more for less, more in itertools.pairwise(confidences))
    assert confidences[0] > 0.0
    assert confidences[-1] < 1.0


def test_a_group_alone_is_sure_enough_to_delete_and_one_of_two_equals_is_not_built() -> None:
    assert group_confidence(1.0, 1.0) > 0.9
    assert group_confidence(0.5, 1.0) < 0.6


@pytest.mark.parametrize('sign', SIGNS, ids=lambda sign: sign.name)
def test_the_table_has_the_measures_of_a_sign_and_no_others(sign: Sign) -> None:
    candidate = next(_candidates(sign))

    assert {term.measure for term in terms_of(sign.name)} == {CONSTANT, *candidate.measures}
    assert all(list(term.knots) == sorted(set(term.knots)) for term in terms_of(sign.name))


def test_the_table_has_the_measures_of_shapes_and_no_others() -> None:
    outline = resample_stroke(stroke(figures.disc(rng := np.random.default_rng(0)), rng)).outline

    for shape in SHAPES:
        assert {term.measure for term in terms_of(shape)} == {CONSTANT, *fits_of(outline).measures}


@pytest.mark.slow
def test_the_table_is_what_its_command_makes() -> None:
    """`python -m tools.evaluation.fit` makes it anew, then the judge's is made anew, too."""
    assert (files(evidence.__package__) / TABLE).read_text('utf-8') == table()


def _candidates(sign: Sign) -> Iterator[Candidate]:
    """Yield the candidates of a sign in strokes by many hands."""
    rng = np.random.default_rng(0)
    draw = {
        'x': figures.cross,
        'arrow': arrows.arrow,
        'scribble': figures.scribble,
        'zigzag': figures.zigzag,
        'round arrow': arrows.round_arrow,
    }[sign.name]
    for _ in range(20):
        yield from sign.candidates(features_of(resample_stroke(stroke(draw(rng), rng))))
