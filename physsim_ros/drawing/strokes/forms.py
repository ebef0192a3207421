# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The classification of a stroke: the forms that it may have, without its scene, each with a weight.

The evidence for signs divides the weight between them and no sign; lines and outlines share what
is left. Several strokes are classified as one: an x, an arrow, or the sides of a path.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from physsim_ros.drawing.strokes.evidence import evidence, LEAST, probabilities
from physsim_ros.drawing.strokes.features import Features, features_of
from physsim_ros.drawing.strokes.joining import joined_arrow, joined_strokes
from physsim_ros.drawing.strokes.plain_forms import plain_forms
from physsim_ros.drawing.strokes.signs import SIGNS, x
from physsim_ros.drawing.strokes.signs.arrow import ARROW
from physsim_ros.drawing.strokes.stages import Classification, Form, Sign
from physsim_ros.drawing.strokes.stroke import resample_stroke, Stroke
from physsim_ros.model.arrays import Floats


def classification_of(stroke: Stroke) -> Classification:
    """Return a stroke with the forms that it may have."""
    features = features_of(stroke)
    signs, no_sign = _sign_forms(features)
    plain, fits = plain_forms(features, no_sign)
    forms = sorted((*signs, *plain), key=lambda each: -each.weight)
    return Classification(features=features, forms=forms, fits=fits)


def path_of(strokes: Sequence[Floats]) -> Classification:
    """Return strokes as one, joined end to end."""
    return classification_of(_joined(joined_strokes(strokes)))


def cross_of(strokes: Sequence[Floats]) -> Classification | None:
    """Return strokes as one if they are an x of two lines, else None."""
    cross = x.of_lines(strokes)
    if cross is None:
        return None
    features = features_of(_joined(joined_strokes(strokes)))
    return Classification(features=features, forms=(cross,))


def arrow_of(strokes: Sequence[Floats]) -> Classification | None:
    """Return strokes as one if they are a shaft and its head, else None."""
    arrow = joined_arrow(strokes)
    if arrow is None:
        return None
    features = features_of(_joined(arrow))
    # The gaps between the parts are no evidence for other forms.
    forms, _ = _sign_forms(features, (ARROW,))
    return Classification(features=features, forms=forms)


def _joined(path: Floats) -> Stroke:
    """Return joined strokes as one: another one may close a gap, which the ends do not tell."""
    return replace(resample_stroke(path), relatability=0.0)


def _sign_forms(
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
