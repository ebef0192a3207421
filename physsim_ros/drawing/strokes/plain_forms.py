# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The forms of a stroke that is no sign: an open line, or a closed outline.

Law: every closed outline is a solid. An outline that is neither round nor made of straight sides
becomes a polygon along the stroke; an outline that crosses itself becomes its outer boundary.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
import math

import numpy as np
from physsim_ros.drawing.strokes import fitting
from physsim_ros.drawing.strokes.corner_detection import bends_of, outline_corners
from physsim_ros.drawing.strokes.evidence import LEAST, Limit, logistic
from physsim_ros.drawing.strokes.features import Features, TREMOR
from physsim_ros.drawing.strokes.fitting import rectangle, traced
from physsim_ros.drawing.strokes.geometry import (
    angles,
    loop_roundness,
    size_of,
    widened,
)
from physsim_ros.drawing.strokes.outer_boundary import outer_boundary
from physsim_ros.drawing.strokes.stages import DISC, Form, LINE, OVAL, POLYGON, RECTANGLE
from physsim_ros.model.arrays import Floats
from physsim_ros.model.shapes import crosses_itself, signed_area
from physsim_ros.model.transform import next_vertices, norms

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
# The spread of the radii of a circle or an oval, which is stretched to a circle, in shares of
# their mean: of a square it is 0.11. The distance of an outline from a rectangle, and from
# straight sides between its corners (rms), in shares of its size: that of a circle from a pentagon
# is 0.02, that of an octagon from a rectangle 0.024 and more.
_ELLIPTIC, _SIDED = Limit(0.1), Limit(0.022)
# Of four corners of a rectangle: their mean distance from the corners of the nearest one, in mean
# sides, and the mean deviation of their angles from right ones [rad]: a rhomb of 73° has 0.3, and
# an eight more.
_OFF, _SLANT = Limit(0.115), Limit(0.3)
# The least aspect of a circle as people draw it: from 0.5 to 0.63 no outline tells circles from
# ovals, wheels are drawn more often, and the other reading is offered. The number of sides of an
# oval, which rolls.
_CIRCULAR, _OVAL_SIDES = Limit(0.58), 48
# Evidence for an ellipse, in log odds: a constant, and the factors of the logarithms of the
# residuals of straight sides and of the ellipse, of the bulge of the sides, and of the log of
# the aspect below that of `_PLANK`: what is thinner is more often a plank than an oval.
_EVIDENCE, _SIDES, _ELLIPSE, _BULGE, _THIN, _PLANK = -5.5, 2.8, 5.55, 4.95, 7.5, 0.35


def plain_forms(features: Features, plain: float) -> Iterator[Form]:
    """
    Yield the forms of a stroke that is no sign: a line, or the shapes of an outline.

    The points of a line, straight, bent or curved, are its ends and bends; those of a disc its
    centre and a point on its rim; those of the other shapes corners.

    :param plain: weight of the stroke being no sign
    """
    stroke = features.stroke
    still = _SWINGING.below(features.swings.count)
    closure = _OPEN.below(stroke.gap - _RELATED * max(stroke.relatability, 0.0))
    line = plain * (1.0 - closure) * _lineness(features, still)
    if line >= LEAST:
        yield Form(name=LINE, weight=line, points=bends_of(stroke.points))
    closed = plain * closure * still
    if closed < LEAST:
        return
    shapes = list(_shapes(stroke.outline))
    total = sum(shape.weight for shape in shapes)
    if total >= LEAST:
        for shape in shapes:
            yield replace(shape, weight=closed * shape.weight / total)


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


def _shapes(outline: Floats) -> Iterator[Form]:
    """
    Yield the shapes that an outline may have, with relative weights.

    Each has the measures of all of them: the number of corners, the distances from the sides
    between those and from a rectangle, in shares of the size, the ellipse's error and aspect.
    """
    ellipse = fitting.ellipse(outline)
    error, aspect = ellipse.error, ellipse.aspect
    wide, narrowed = widened(outline)
    at, sharp, residual = outline_corners(wide)
    found, size = narrowed(sharp), size_of(wide)
    residual /= size
    # Independent of the corners: a rectangle may have a bent side or a round corner.
    corners, off = fitting.rectangle_of(wide)
    off /= size
    measures = {
        'ellipse error': error,
        'aspect': aspect,
        'sides error': min(residual, 1.0),
        'rectangle error': off,
        'corners': float(len(at)),
    }
    sides = min(residual, off)
    edgeless = _edgelessness(sides=sides, error=error, aspect=aspect, bulge=_bulge(wide, at))
    circle = edgeless * _ELLIPTIC.below(error)
    sided = (1.0 - edgeless) * _SIDED.below(residual)
    circular = _CIRCULAR.above(aspect)
    rim = ellipse.center + np.array((ellipse.radius, 0.0))
    disc = np.array((ellipse.center, rim))
    yield Form(name=DISC, weight=circle * circular, points=disc, measures=measures)
    oval = ellipse.corners(_OVAL_SIDES)
    yield Form(name=OVAL, weight=circle * (1.0 - circular), points=oval, measures=measures)
    square = _SIDED.below(off)
    sharpness = _squareness(found) if len(at) == 4 else 0.0
    # Corners that are sharp are more exact than the rectangle of least squares.
    corners = found if 2.0 * sharpness > square else narrowed(corners)
    square = max(square, sharpness)
    weight = (1.0 - edgeless) * square
    yield Form(name=RECTANGLE, weight=weight, points=corners, measures=measures)
    if len(at) >= 3 and crosses_itself(found):
        boundary = outer_boundary(found)
        sided = sided if boundary is not None else 0.0
        found = found if boundary is None else boundary
    sided *= 1.0 - square
    free = max(1.0 - max(square, circle) - sided, 0.0)
    if free > sided:
        # Neither round nor sided: a polygon along the stroke.
        along = traced(outline)
        boundary = outer_boundary(along) if crosses_itself(along) else along
        found, free = (found, 0.0) if boundary is None else (boundary, free)
    yield Form(name=POLYGON, weight=sided + free, points=found, measures=measures)


def _edgelessness(*, sides: float, error: float, aspect: float, bulge: float) -> float:
    """
    Return the probability that an outline is an ellipse, and not one with straight sides.

    Logistic regression on outlines of both kinds by hands of the tuning half of `make evaluate`,
    with constants of earlier hands as the prior: thin outlines are planks.

    :param sides: residual of straight sides, in shares of the size
    :param error: residual of the ellipse, in shares of the size
    :param aspect: of the ellipse
    :param bulge: of the sides
    """
    evidence = (
        _EVIDENCE
        + _SIDES * math.log(max(sides, 1e-6))
        - _ELLIPSE * math.log(max(error, 1e-6))
        + _BULGE * bulge
        + _THIN * math.log(min(max(aspect, 1e-6) / _PLANK, 1.0))
    )
    return logistic(evidence)


def _bulge(outline: Floats, at: list[int]) -> float:
    """Return how much the sides of a closed polyline are arcs: 1 those of a circle, 0 straight."""
    if len(at) < 3:
        return 1.0
    beyond = 1.0 - abs(signed_area(outline[at])) / max(abs(signed_area(outline)), 1e-300)
    turn = 2.0 * math.pi / len(at)
    # Of a circle, over equal sides.
    return min(max(beyond / (1.0 - math.sin(turn) / turn), 0.0), 2.0)


def _squareness(found: Floats) -> float:
    """Return how well four corners fit a rectangle, 0 .. 1."""
    nearest = rectangle(found)
    sides = next_vertices(found) - found
    lengths = norms(next_vertices(nearest) - nearest)
    off = float(norms(nearest - found).mean() / lengths.mean())
    slants = np.abs(np.abs(angles(np.roll(sides, 1, axis=0), sides)) - math.pi / 2)
    # The direction of a short side is less exact than its ends.
    slant = float(slants.mean() * lengths.min() / lengths.max())
    return _OFF.below(off) * _SLANT.below(slant)
