# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Recognition: the forms that a stroke may have, each with a weight.

Law: every likely form is returned. `interpretation` chooses among these forms, by the scene over
which the stroke was drawn.
"""

from __future__ import annotations

from physsim_ros.drawing.strokes import closed_shapes, open_lines
from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.hypothesis import Hypothesis, LEAST
from physsim_ros.drawing.strokes.signs import SIGNS
from physsim_ros.drawing.strokes.stroke import Stroke


def recognise_form(stroke: Stroke) -> tuple[Hypothesis, ...]:
    """Return the forms that a stroke may have, by falling weight."""
    features = Features.of(stroke)
    signs = [sign.hypothesis(features) for sign in SIGNS]
    # Each sign is a line or an outline too; a stroke that fits a sign is that sign.
    plain = 1.0 - max(each.weight for each in signs)
    shapes = [
        *open_lines.hypotheses(features, plain),
        *closed_shapes.hypotheses(features, plain),
    ]
    likely = (each for each in (*signs, *shapes) if each.weight >= LEAST)
    return tuple(sorted(likely, key=lambda each: -each.weight))
