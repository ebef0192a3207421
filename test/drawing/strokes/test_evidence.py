# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The table of evidence has every measure of every sign, and probabilities are shares."""

from collections.abc import Iterator

import numpy as np
from physsim_ros.drawing.strokes.evidence import Candidate, CONSTANT, probabilities, Term, terms_of
from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.signs import Sign, SIGNS
from physsim_ros.drawing.strokes.stroke import resample_stroke
import pytest
from tools.evaluation import arrows, figures
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


@pytest.mark.parametrize('sign', SIGNS, ids=lambda sign: sign.PRIMITIVE)
def test_the_table_has_the_measures_of_a_sign_and_no_others(sign: Sign) -> None:
    candidate = next(_candidates(sign))

    assert {term.measure for term in terms_of(sign.PRIMITIVE)} == {CONSTANT, *candidate.measures}
    assert all(list(term.knots) == sorted(set(term.knots)) for term in terms_of(sign.PRIMITIVE))


def _candidates(sign: Sign) -> Iterator[Candidate]:
    """Yield the candidates of a sign in strokes by many hands."""
    rng = np.random.default_rng(0)
    draw = {
        'x': figures.cross,
        'arrow': arrows.arrow,
        'scribble': figures.scribble,
        'zigzag': figures.zigzag,
        'round arrow': arrows.round_arrow,
    }[sign.PRIMITIVE]
    for _ in range(20):
        yield from sign.candidates(Features.of(resample_stroke(stroke(draw(rng), rng))))
