# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Marks: lines within a solid, which have no effect."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from physsim_ros.drawing.geometry import inside
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes.choice import reading_of
from physsim_ros.drawing.strokes.figure import Figure, ON_SOLID
from physsim_ros.drawing.strokes.grouping import follows, is_side
from physsim_ros.drawing.strokes.joining import joined_strokes
from physsim_ros.drawing.strokes.resampled import middle_half
from physsim_ros.drawing.strokes.stages import Guess, MeaningKind, Outcome, Reading
from physsim_ros.model.translation import Text


def marked_solid(figures: Sequence[Figure], last: Figure, settings: DrawingSettings) -> bool:
    """Return whether the last stroke is a line through the solid that was drawn before it."""
    if not figures or not figures[-1].is_solid or not last.is_open:
        return False
    solid = figures[-1]
    if not follows(solid, last, settings) or is_side(last, solid, settings):
        return False
    return lies_within(last, solid)


def lies_within(line: Figure, solid: Figure) -> bool:
    """Return whether most of the middle half of a line lies within the outline of a solid."""
    outline = joined_strokes(solid.strokes)
    points = np.vstack([middle_half(stroke) for stroke in line.strokes])
    return float(inside(points, outline).mean()) >= ON_SOLID


def mark_reading(line: Figure) -> Reading:
    """Return the reading of a line within a solid: a mark, which has no requests."""
    mark = Guess(
        meaning=MeaningKind.MARK,
        confidence=line.guesses[0].confidence if line.guesses else 1.0,
        group_confidence=1.0,
        build=lambda: Outcome(
            requests=(),
            subject='',
            message=Text('a mark, which has no effect'),
            outline=line.strokes[0],
        ),
    )
    return reading_of((mark, *line.guesses), 0)
