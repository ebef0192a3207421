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
Closed strokes: disc, rectangle, polygon.

Law: a closed stroke that does not cross itself is a solid; what is neither round nor sided is an
outline of its own.
"""

from __future__ import annotations

from collections.abc import Iterator
import math

import numpy as np
from physsim_ros.drawing.strokes import corner_detection
from physsim_ros.drawing.strokes.fitting import rectangle, traced
from physsim_ros.drawing.strokes.glyphs import Swings
from physsim_ros.drawing.strokes.hypothesis import Candidate, falls, LEAST, Primitive, rises
from physsim_ros.drawing.strokes.polyline import angles, smoothed, turns, widened
from physsim_ros.drawing.strokes.stroke import Stroke
from physsim_ros.model.arrays import Floats
from physsim_ros.model.shapes import crosses_itself, is_convex, signed_area
from physsim_ros.model.transform import cross

# So many corners that are all alike are a circle's samples; the weight of an outline of no shape.
MANY, BLOB = 9, 0.8


def solids(stroke: Stroke, swings: Swings, plain: float) -> Iterator[Candidate]:
    """Yield disc, rectangle and polygon."""
    closed = plain * falls(stroke.gap, 0.13, 0.01) * falls(swings.count, 4.5, 0.25)
    if stroke.outline is None or closed < LEAST:
        return
    center, radius, error, aspect = roundness(stroke.outline)
    outline, narrow = widened(stroke.outline)
    at = corner_detection.corners(outline, closed=True, gap=stroke.gap)
    found = corner_detection.vertices(outline, at, closed=True) @ narrow
    simple = len(at) >= 3 and not crosses_itself(found)
    # What sides leave unexplained, beside what a circle does; a hexagon's is a fifth.
    size = float(np.hypot(*np.ptp(outline, axis=0)))
    left = corner_detection.side_error(outline, at) / size if len(at) >= 3 else 1.0
    once = _once_around(stroke.outline - center)
    bend = turns(smoothed(outline, 2.5, closed=True), 6, closed=True)
    sharpness = float(np.sort(np.abs(bend))[-8:].mean() / np.abs(bend).mean())
    ratio = math.log(max(left, 1e-6) / max(error, 1e-6) / 0.19)
    evidence = ratio + 1.5 * math.log(2.25 / sharpness)
    round_ = rises(evidence, 0.0, 0.3) * rises(aspect, 0.55, 0.04)
    if len(at) >= MANY and is_convex(_counterclockwise(found)):
        # Nobody draws so many equal corners: they are the samples of a quick circle.
        round_ = max(round_, falls(error, 0.04, 0.004))
    disc = closed * once * round_ * falls(error, 0.085, 0.015)
    sided = closed * (1.0 - round_) * falls(left, 0.022, 0.003) if simple else 0.0
    # Thinner than that it is a line, drawn to and fro.
    broad = rises(aspect, 0.02, 0.003)
    square = squareness(found) if len(at) == 4 else 0.0
    rim = center + np.array((radius, 0.0))
    yield Candidate(primitive=Primitive.DISC, weight=disc, points=np.array((center, rim)))
    yield Candidate(primitive=Primitive.RECTANGLE, weight=broad * sided * square, points=found)
    blob = BLOB * (closed - disc - sided)
    sided *= 1.0 - square
    if blob > max(sided, LEAST):
        # Neither round nor sided: any other outline, as it was drawn.
        found = traced(stroke.outline)
        sided = 0.0 if crosses_itself(found) else blob
    yield Candidate(primitive=Primitive.POLYGON, weight=broad * sided, points=found)


def roundness(outline: Floats) -> tuple[Floats, float, float, float]:
    """
    Tell how round a closed way is.

    :return: its centre; its mean radius [m]; how much the radius varies once the ellipse that it
        might be is stretched to a circle, as a share; the ellipse's lesser axis by its greater
    """
    following = np.roll(outline, -1, axis=0)
    base = outline.mean(axis=0)
    weight = cross(outline - base, following - base)
    area = float(weight.sum()) / 2
    center = base
    if abs(area) > 1e-6 * float((np.ptp(outline, axis=0) ** 2).sum()):
        center = base + ((outline + following - 2 * base) * weight[:, None]).sum(axis=0) / 6 / area
    away = outline - center
    squares, axes = np.linalg.eigh(away.T @ away / len(away))
    scales = np.sqrt(np.maximum(squares, 1e-18 * squares[1]))
    radii = np.hypot(*(away @ axes / scales).T)
    radius = math.sqrt(abs(area) / math.pi)
    return center, radius, float(radii.std() / radii.mean()), float(scales[0] / scales[1])


def squareness(found: Floats) -> float:
    """Return how much four corners look like a rectangle's, 0 .. 1."""
    nearest = rectangle(found)
    sides = np.roll(found, -1, axis=0) - found
    lengths = np.hypot(*(np.roll(nearest, -1, axis=0) - nearest).T)
    off = float(np.hypot(*(nearest - found).T).mean() / lengths.mean())
    slants = np.abs(np.abs(angles(np.roll(sides, 1, axis=0), sides)) - math.pi / 2)
    # A short side's direction is hard to draw; its ends are not.
    slant = float(slants.mean()) * min(1.0, float(lengths.min() / lengths.max()) / 0.3)
    return falls(off, 0.115, 0.006) * falls(slant, 0.3, 0.012)


def _once_around(away: Floats) -> float:
    """Return how much a way looks like going round the origin once."""
    turn = float(angles(away, np.roll(away, -1, axis=0)).sum()) / (2 * math.pi)
    return falls(abs(abs(turn) - 1.0), 0.4, 0.05)


def _counterclockwise(found: Floats) -> Floats:
    return found if signed_area(found) > 0 else found[::-1]
