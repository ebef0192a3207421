# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
What a stroke looks like: every primitive that it could be, with a weight.

Law: nothing is decided here. A stroke is told by what it looks like and by where it lies, and the
second is for `reading`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from physsim_ros.drawing.strokes import glyphs
from physsim_ros.drawing.strokes.closed_shapes import solids
from physsim_ros.drawing.strokes.corner_detection import bends_of
from physsim_ros.drawing.strokes.glyphs import Crossing, Swings
from physsim_ros.drawing.strokes.hypothesis import Candidate, falls, LEAST, Primitive, rises
from physsim_ros.drawing.strokes.stroke import Stroke

# The longest loop that is a slip, in shares of the length.
SLIP = 0.15


def recognise(stroke: Stroke) -> tuple[Candidate, ...]:
    """Return all that a stroke could be, the most likely first."""
    swings = glyphs.swings_of(stroke.points)
    crossings = glyphs.crossings_of(stroke.points)
    made = [
        glyphs.zigzag(stroke, swings),
        glyphs.scribble(stroke, swings),
        glyphs.crossed(stroke, crossings),
        glyphs.arrow(stroke, swings),
    ]
    # Every sign is also some line or outline; what looks like a sign is meant as one.
    plain = 1.0 - max(each.weight for each in made)
    shapes = [
        *_line(stroke, swings, crossings, plain),
        *solids(stroke, swings, plain),
    ]
    likely = (each for each in (*made, *shapes) if each.weight >= LEAST)
    return tuple(sorted(likely, key=lambda each: -each.weight))


def _line(
    stroke: Stroke, swings: Swings, crossings: Sequence[Crossing], plain: float
) -> Iterator[Candidate]:
    """Yield a line, straight, bent or curved, that does not cross itself."""
    points = stroke.points
    straight = float(np.hypot(*(points[-1] - points[0]))) / stroke.length
    calm = max(
        falls(swings.count, 4.5, 0.25),
        rises(straight, 0.9, 0.02),
        falls(swings.height / stroke.size, 0.06, 0.006),
    )
    # Small loops are slips at a bend, or where the pen was set down.
    loops = sum(last - first > SLIP * len(points) for _, first, last in crossings)
    weight = plain * calm * rises(stroke.gap, 0.13, 0.01) * falls(loops, 0.5, 0.2)
    if weight >= LEAST:
        yield Candidate(primitive=Primitive.LINE, weight=weight, points=bends_of(points))
