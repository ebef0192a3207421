# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The forms of a stroke that is no sign: an open line, or a closed outline.

Law: every closed outline is a solid. An outline that is neither round nor made of straight sides
becomes a polygon along the stroke; an outline that crosses itself becomes its outer boundary.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
import math

import numpy as np
from physsim_ros.drawing.geometry import size_of
from physsim_ros.drawing.strokes import fitting
from physsim_ros.drawing.strokes.corner_detection import outline_corners, turning_within
from physsim_ros.drawing.strokes.evidence import evidence, LEAST, Limit, probabilities
from physsim_ros.drawing.strokes.features import Features, TREMOR
from physsim_ros.drawing.strokes.fitting import Ellipse, traced
from physsim_ros.drawing.strokes.outer_boundary import outer_boundary
from physsim_ros.drawing.strokes.resampled import loop_roundness, widened
from physsim_ros.drawing.strokes.stages import DISC, Form, LINE, OVAL, POLYGON, RECTANGLE
from physsim_ros.model.arrays import Floats
from physsim_ros.model.shapes import crosses_itself, signed_area
from physsim_ros.model.transform import norms

# The number of swings from which on a stroke is no plain line or outline.
_SWINGING = Limit(5.5)
# The greatest gap of a closed outline, in shares of its length, and how much it rises with the
# relatability of its ends: 99 of 100 people leave less than 11.5 %; a question mark has 17 %, and
# ends that do not go on across it.
_OPEN, _RELATED = Limit(0.134), 0.045
# The greatest length of a loop that is a mistake of the hand, in shares of the length.
_LOOP = 0.15
# The greatest area of a loop that is the tip of a brace, by its length squared; the loop of an x
# has 0.037 and more, that of a pigtail 0.07.
_NARROW = 0.035
# The distance of an outline from straight sides between its corners (rms), in shares of its size,
# beyond which a polygon follows the stroke: that of a circle from a pentagon is 0.02.
_SIDED = 0.022
# The least aspect of a circle as people draw it: from 0.5 to 0.63 no outline tells circles from
# ovals, wheels are drawn more often, and the other reading is offered. The number of sides of an
# oval, which rolls.
_CIRCULAR, _OVAL_SIDES = Limit(0.58), 48
# Shapes that the table of evidence has; the rest of the weight of an outline is a polygon's.
ELLIPSE, SHAPES = 'ellipse', ('ellipse', RECTANGLE)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Fits:
    """
    The fits to an outline.

    :param ellipse: of its area
    :param rectangle: (4, 2) float64: corners of the nearest rectangle [m]
    :param corners: (k, 2) float64: the meeting points of straight sides [m]
    :param measures: by name, as the table of evidence has them: error and aspect of the ellipse;
        the distances (rms) from the rectangle and from the sides, in shares of the size; that of
        the rectangle's farthest corner, in widths of it; the number of corners; the bulge of
        sides, and the share of the turning that lies within them
    """

    ellipse: Ellipse
    rectangle: Floats
    corners: Floats
    measures: Mapping[str, float]


def plain_forms(features: Features, plain: float) -> tuple[list[Form], Mapping[str, float]]:
    """
    Return the forms of a stroke that is no sign: a line, and the shapes of an outline.

    The points of a line, straight, bent or curved, are its ends and bends; those of a disc its
    centre and a point on its rim; those of the other shapes corners.

    :param plain: weight of the stroke being no sign
    :return: the forms, and the measures of the fits to the outline; {} where it has no shape
    """
    stroke = features.stroke
    still = _SWINGING.below(features.swings.count)
    closure = _OPEN.below(stroke.gap - _RELATED * max(stroke.relatability, 0.0))
    line = plain * (1.0 - closure) * _lineness(features, still)
    closed = plain * closure * still
    forms: list[Form] = []
    if line >= LEAST:
        forms.append(Form(name=LINE, weight=line, points=features.bends))
    if closed < LEAST:
        return forms, {}
    fits = fits_of(stroke.outline)
    shapes = [each for each in _shapes(stroke.outline, fits, closed) if each.weight >= LEAST]
    return [*forms, *shapes], fits.measures if shapes else {}


def _lineness(features: Features, still: float) -> float:
    """
    Return the weight of an open stroke being a line, 0 .. 1.

    :param still: weight of its having no swings
    """
    points = features.stroke.points
    calm = max(still, TREMOR.below(features.measures['height']))
    # An x has a loop; small ones come from bends, and from setting the pen down; narrow ones from
    # retraced tips.
    looped = any(
        each[2] - each[1] > _LOOP * len(points) and loop_roundness(points, each) > _NARROW
        for each in features.crossings
    )
    return 0.0 if looped else calm


def _shapes(outline: Floats, fits: Fits, closed: float) -> Iterator[Form]:
    """
    Yield the shapes that an outline may have.

    :param closed: weight of the stroke being an outline
    """
    ellipse, measures = fits.ellipse, fits.measures
    elliptic, square = probabilities([evidence(each, measures) for each in SHAPES])
    circular = _CIRCULAR.above(ellipse.aspect)
    rim = ellipse.center + np.array((ellipse.radius, 0.0))
    disc = np.array((ellipse.center, rim))
    yield Form(name=DISC, weight=closed * (elliptic * circular), points=disc)
    oval = ellipse.corners(_OVAL_SIDES)
    yield Form(name=OVAL, weight=closed * (elliptic * (1.0 - circular)), points=oval)
    # Corners that the stroke has are more exact than those of the rectangle of least squares.
    sharp = len(fits.corners) == 4 and measures['sides error'] < measures['rectangle error']
    corners = fits.corners if sharp else fits.rectangle
    yield Form(name=RECTANGLE, weight=closed * square, points=corners)
    corners = fits.corners if measures['sides error'] < _SIDED else traced(outline)
    boundary = outer_boundary(corners) if crosses_itself(corners) else corners
    if boundary is not None:
        weight = closed * (1.0 - elliptic - square)
        yield Form(name=POLYGON, weight=weight, points=boundary)


def fits_of(outline: Floats) -> Fits:
    """Return the fits to a closed polyline, with the measures by which its shape is told."""
    ellipse, size = fitting.ellipse(outline), size_of(outline)
    rectangle, off = fitting.rectangle_of(outline)
    away = norms(rectangle[:, None] - outline).min(axis=1)
    width = float(norms(np.diff(rectangle[:3], axis=0)).min())
    wide, narrowed = widened(outline)
    at, sharp, residual = outline_corners(wide)
    measures = {
        'ellipse error': ellipse.error,
        'aspect': ellipse.aspect,
        'rectangle error': off / size,
        'farthest corner': float(away.max()) / max(width, 1e-300),
        'sides error': min(residual / size_of(wide), 1.0),
        'corners': float(len(at)),
        'bulge': _bulge(wide, at),
        'arcs': turning_within(wide, at),
    }
    return Fits(ellipse=ellipse, rectangle=rectangle, corners=narrowed(sharp), measures=measures)


def _bulge(outline: Floats, at: list[int]) -> float:
    """Return how much the sides of a closed polyline are arcs: 1 those of a circle, 0 straight."""
    if len(at) < 3:
        return 1.0
    beyond = 1.0 - abs(signed_area(outline[at])) / max(abs(signed_area(outline)), 1e-300)
    turn = 2.0 * math.pi / len(at)
    # Of a circle, over equal sides.
    return min(max(beyond / (1.0 - math.sin(turn) / turn), 0.0), 2.0)
