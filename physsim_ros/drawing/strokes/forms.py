# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The classification of a stroke: the forms that it may have, without its scene, each with a weight.

The evidence for signs divides the weight between them and no sign; lines and outlines share what
is left.
"""

from __future__ import annotations

from collections.abc import Sequence

from physsim_ros.drawing.strokes.evidence import evidence, LEAST, probabilities
from physsim_ros.drawing.strokes.features import Features, features_of
from physsim_ros.drawing.strokes.plain_forms import plain_forms
from physsim_ros.drawing.strokes.signs import SIGNS
from physsim_ros.drawing.strokes.stages import Classification, Form, Sign
from physsim_ros.drawing.strokes.stroke import Stroke


def classification_of(stroke: Stroke) -> Classification:
    """Return a stroke with the forms that it may have."""
    features = features_of(stroke)
    signs, no_sign = sign_forms(features)
    plain, fits = plain_forms(features, no_sign)
    forms = sorted((*signs, *plain), key=lambda each: -each.weight)
    return Classification(features=features, forms=forms, fits=fits)


def sign_forms(
    features: Features, signs: Sequence[Sign] = SIGNS
) -> tuple[tuple[Form, ...], float]:
    """
    Return the forms of signs that are not too unlikely, and the weight of being no sign.

    :param signs: that the stroke may be
    """
    candidates = [(sign.name, each) for sign in signs for each in sign.candidates(features)]
    weights = probabilities([evidence(name, each.measures) for name, each in candidates])
    best: dict[str, Form] = {}
    for (name, each), weight in zip(candidates, weights, strict=True):
        if name not in best or weight > best[name].weight:
            best[name] = Form(name=name, weight=weight, points=each.points)
    likely = tuple(each for each in best.values() if each.weight >= LEAST)
    return likely, 1.0 - sum(weights)
