# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Forms: the looks of a stroke, without its scene, each with a weight.

The evidence for signs divides the weight between them and no sign; lines and outlines share what
is left.
"""

from __future__ import annotations

from collections.abc import Sequence

from physsim_ros.drawing.strokes.evidence import evidence, LEAST, probabilities
from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.plain_forms import plain_forms
from physsim_ros.drawing.strokes.signs import SIGNS
from physsim_ros.drawing.strokes.stages import Form, Sign


def forms_of(features: Features) -> tuple[Form, ...]:
    """Return the forms that a stroke may have, by falling weight."""
    signs, plain = sign_forms(features)
    forms = *signs, *plain_forms(features, plain)
    likely = (each for each in forms if each.weight >= LEAST)
    return tuple(sorted(likely, key=lambda each: -each.weight))


def sign_forms(
    features: Features, signs: Sequence[Sign] = SIGNS
) -> tuple[tuple[Form, ...], float]:
    """
    Return the form of each sign, and the weight of the stroke being no sign.

    :param signs: that the stroke may be
    """
    candidates = [(sign.name, each) for sign in signs for each in sign.candidates(features)]
    weights = probabilities([evidence(name, each.measures) for name, each in candidates])
    best: dict[str, Form] = {}
    for (name, each), weight in zip(candidates, weights, strict=True):
        if name not in best or weight > best[name].weight:
            best[name] = Form(name=name, weight=weight, points=each.points)
    return tuple(best.values()), 1.0 - sum(weights)
