# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Recognition: the forms that a stroke may have, each with a weight.

Law: every likely form is returned. `interpretation` chooses among these forms, by the scene over
which the stroke was drawn.
"""

from __future__ import annotations

from physsim_ros.drawing.strokes import closed_shapes, open_lines
from physsim_ros.drawing.strokes.evidence import evidence, probabilities
from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.hypothesis import Hypothesis, LEAST
from physsim_ros.drawing.strokes.signs import SIGNS
from physsim_ros.drawing.strokes.stroke import Stroke


def recognise_form(stroke: Stroke) -> tuple[Hypothesis, ...]:
    """Return the forms that a stroke may have, by falling weight."""
    features = Features.of(stroke)
    signs, plain = _signs(features)
    shapes = [
        *open_lines.hypotheses(features, plain),
        *closed_shapes.hypotheses(features, plain),
    ]
    likely = (each for each in (*signs, *shapes) if each.weight >= LEAST)
    return tuple(sorted(likely, key=lambda each: -each.weight))


def _signs(features: Features) -> tuple[list[Hypothesis], float]:
    """Return the hypothesis of each sign, and the weight of the stroke being no sign."""
    candidates = [(sign.PRIMITIVE, each) for sign in SIGNS for each in sign.candidates(features)]
    weights = probabilities([evidence(name, each.measures) for name, each in candidates])
    best: dict[str, Hypothesis] = {}
    for (name, each), weight in zip(candidates, weights, strict=True):
        if name not in best or weight > best[name].weight:
            best[name] = Hypothesis(primitive=name, weight=weight, points=each.points)
    return list(best.values()), 1.0 - sum(weights)
