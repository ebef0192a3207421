# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Closed strokes: disc, oval, rectangle and polygon, or, small and on a body, an axle or a weld.

Law: every closed outline is a solid. An outline that is neither round nor made of straight sides
becomes a polygon along the stroke; an outline that crosses itself becomes its outer boundary.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
import math

import numpy as np
from physsim_ros.drawing.strokes import corner_detection, fitting, request_builder
from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.fitting import rectangle, traced
from physsim_ros.drawing.strokes.hypothesis import falls, Hypothesis, LEAST, rises
from physsim_ros.drawing.strokes.meanings import (
    Context,
    DISC,
    Interpretation,
    Outcome,
    POLYGON,
    RECTANGLE,
)
from physsim_ros.drawing.strokes.outer_boundary import outer_boundary
from physsim_ros.drawing.strokes.plane import angles, principal_axis
from physsim_ros.drawing.strokes.polyline import point_of, size_of, widened
from physsim_ros.drawing.strokes.signs import axle, weld
from physsim_ros.model.arrays import Floats
from physsim_ros.model.shapes import crosses_itself, is_convex, signed_area
from physsim_ros.model.transform import cross, norms, Point, rotated_each

# The name of a form whose meaning is a polygon.
OVAL = 'oval'
# The greatest gap of a closed outline, in shares of its length: 99 of 100 people leave less than
# 11.5 %, and a question mark has 17 %.
_GAP = 0.147
# The greatest distance of an outline from a rectangle (rms), in shares of its size: that of an
# octagon is 0.024 and more; and that in shares of the error of an ellipse, 0.5 for an oval.
_SQUARE, _SQUARER = 0.022, 0.22
# The least aspect of a circle as people draw it, and the number of sides of an oval, which rolls.
_CIRCULAR, _OVAL_SIDES = 0.68, 48
# Evidence for a circle: a constant, the factors of the logarithm of its error and of the number of
# corners of a convex outline, and the number of corners that speaks neither for nor against it.
_EVIDENCE, _ERROR, _CORNER, _FEW = 1.1, 1.18, 0.5, 5.0
# The least aspect of the corners of a polygon that may be a small circle.
_LEAST_ROUND = 0.4
# The least number of equal corners that are the samples of a circle.
MANY = 9
# Factor on the weight of an outline that is neither round nor made of straight sides.
BLOB = 0.8


def hypotheses(features: Features, plain: float) -> Iterator[Hypothesis]:
    """
    Yield disc, oval, rectangle and polygon, which share the weight of a closed outline.

    The points of a disc are its centre and a point on its rim; those of the others are corners.

    :param plain: weight of the stroke being no sign
    """
    stroke = features.stroke
    closed = plain * falls(stroke.gap, _GAP, 0.006) * features.swings.absence
    if stroke.outline is None or closed < LEAST:
        return
    shapes = list(_shapes(stroke.outline, stroke.gap))
    total = sum(shape.weight for shape in shapes)
    if total >= LEAST:
        for shape in shapes:
            yield replace(shape, weight=closed * shape.weight / total)


def _shapes(outline: Floats, gap: float) -> Iterator[Hypothesis]:
    """Yield the shapes that an outline may have, with relative weights."""
    center, radius, error, aspect = roundness(outline)
    wide, narrowed = widened(outline)
    at = corner_detection.corners(wide, closed=True, gap=gap)
    found = narrowed(corner_detection.vertices(wide, at, closed=True))
    size = size_of(wide)
    residual = corner_detection.side_error(wide, at) / size if len(at) >= 3 else 1.0
    # Logistic regression on hand-drawn circles and polygons: sides fit a circle badly, and
    # a circle has many corners.
    evidence = _EVIDENCE + math.log(max(residual, 1e-6)) - _ERROR * math.log(max(error, 1e-6))
    convex = len(at) > 3 and is_convex(_counterclockwise(found))
    circle = rises(evidence + (_CORNER * (len(at) - _FEW) if convex else 0.0), 0.0, 0.31)
    if len(at) >= MANY and convex:
        # Many equal corners are the samples of a circle that was drawn quickly.
        circle = max(circle, falls(error, 0.04, 0.004))
    edgeless = circle
    sided = (1.0 - edgeless) * falls(residual, 0.022, 0.003)
    circle *= _winds_once(outline - center) * falls(error, 0.085, 0.015)
    circular = rises(aspect, _CIRCULAR, 0.02)
    rim = center + np.array((radius, 0.0))
    yield Hypothesis(primitive=DISC, weight=circle * circular, points=np.array((center, rim)))
    # A thinner outline is a line, drawn to and fro.
    broad = rises(aspect, 0.02, 0.003)
    ellipse = fitting.ellipse(outline, _OVAL_SIDES)
    yield Hypothesis(primitive=OVAL, weight=broad * circle * (1.0 - circular), points=ellipse)
    # Independent of the corners: a rectangle may have a bent side or a round corner.
    corners, off = fitting.rectangle_of(wide)
    off /= size
    square = falls(off, _SQUARE, 0.0015) * falls(off / max(error, 1e-6), _SQUARER, 0.015)
    if len(at) == 4 and squareness(found) > square:
        corners, square = found, squareness(found)
    else:
        corners = narrowed(corners)
    yield Hypothesis(primitive=RECTANGLE, weight=broad * (1.0 - edgeless) * square, points=corners)
    if len(at) >= 3 and crosses_itself(found):
        boundary = outer_boundary(found)
        sided = sided if boundary is not None else 0.0
        found = found if boundary is None else boundary
    sided *= 1.0 - square
    yield Hypothesis(primitive=POLYGON, weight=broad * sided, points=found)
    free = BLOB * max(1.0 - max(square, circle) - sided, 0.0)
    if free < LEAST:
        return
    along: Floats | None = traced(outline)
    if along is not None and crosses_itself(along):
        along = outer_boundary(along)
    if along is not None:
        # Neither round nor sided: a polygon along the stroke.
        yield Hypothesis(primitive=POLYGON, weight=broad * free, points=along)


def disc_interpretations(hypothesis: Hypothesis, context: Context) -> Iterator[Interpretation]:
    """Yield axle and disc."""
    points = hypothesis.points
    build = partial(request_builder.disc, points, context)
    circle = point_of(points[0]), math.dist(*points)
    yield from _axle_or_body(hypothesis, context, *circle, meaning=DISC, build=build)


def oval_interpretations(hypothesis: Hypothesis, context: Context) -> Iterator[Interpretation]:
    """Yield axle and polygon, which is not regularised."""
    points = hypothesis.points
    build = partial(request_builder.smooth_polygon, points, context)
    circle = point_of(points.mean(axis=0)), size_of(points) / 3
    yield from _axle_or_body(hypothesis, context, *circle, meaning=POLYGON, build=build)


def _axle_or_body(
    hypothesis: Hypothesis,
    context: Context,
    center: Point,
    radius: float,
    *,
    meaning: str,
    build: Callable[[], Outcome],
) -> Iterator[Interpretation]:
    """
    Yield an axle and a body, which share the weight of a round outline.

    :param meaning: of the body
    :param build: returns its outcome
    """
    share = axle.share_of(center, radius, context)
    yield axle.interpretation(center, radius, context, weight=hypothesis.weight * share)
    yield Interpretation(meaning=meaning, weight=hypothesis.weight * (1.0 - share), build=build)


def rectangle_interpretations(
    hypothesis: Hypothesis, context: Context
) -> Iterator[Interpretation]:
    """Yield a weld and a rectangle."""
    pin = weld.interpretation(hypothesis.points, context, weight=hypothesis.weight)
    yield pin
    yield Interpretation(
        meaning=RECTANGLE,
        weight=hypothesis.weight - pin.weight,
        build=partial(request_builder.rectangle, hypothesis.points, context),
    )


def polygon_interpretations(hypothesis: Hypothesis, context: Context) -> Iterator[Interpretation]:
    """Yield axle and polygon: small circles are drawn with corners."""
    points = hypothesis.points
    center, radius = points.mean(axis=0), size_of(points) / 3
    _, along, across = principal_axis(points - center)
    share = axle.share_of(point_of(center), radius, context, corners=len(points))
    share *= rises(math.sqrt(across / along), _LEAST_ROUND, 0.03)
    weight, shown = hypothesis.weight * share, math.dist(center, points[0])
    yield axle.interpretation(point_of(center), shown, context, weight=weight)
    yield Interpretation(
        meaning=POLYGON,
        weight=hypothesis.weight * (1.0 - share),
        build=partial(request_builder.polygon, points, context),
    )


def roundness(outline: Floats) -> tuple[Floats, float, float, float]:
    """
    Return how round a closed polyline is.

    :return: its centre [m]; its mean radius [m]; the standard deviation of the radius, in shares
        of it, once the ellipse of the same moments is stretched to a circle; the lesser axis of
        that ellipse by the greater
    """
    following = np.roll(outline, -1, axis=0)
    base = outline.mean(axis=0)
    weight = cross(outline - base, following - base)
    area = float(weight.sum()) / 2
    center = base
    if abs(area) > 1e-6 * float((np.ptp(outline, axis=0) ** 2).sum()):
        center = base + ((outline + following - 2 * base) * weight[:, None]).sum(axis=0) / 6 / area
    away = outline - center
    angle, along, across = principal_axis(away)
    aspect = math.sqrt(max(across / along, 1e-18))
    x, y = rotated_each(away, -angle).T
    radii = np.hypot(x, y / aspect)
    radius = math.sqrt(abs(area) / math.pi)
    return center, radius, float(radii.std() / radii.mean()), aspect


def squareness(found: Floats) -> float:
    """Return how well four corners fit a rectangle, 0 .. 1."""
    nearest = rectangle(found)
    sides = np.roll(found, -1, axis=0) - found
    lengths = norms(np.roll(nearest, -1, axis=0) - nearest)
    off = float(norms(nearest - found).mean() / lengths.mean())
    slants = np.abs(np.abs(angles(np.roll(sides, 1, axis=0), sides)) - math.pi / 2)
    # The direction of a short side is less exact than its ends.
    slant = float(slants.mean()) * min(1.0, float(lengths.min() / lengths.max()) / 0.3)
    return falls(off, 0.115, 0.006) * falls(slant, 0.3, 0.012)


def _winds_once(away: Floats) -> float:
    """Return how well the winding number of a closed polyline fits ±1, 0 .. 1."""
    turn = float(angles(away, np.roll(away, -1, axis=0)).sum()) / (2 * math.pi)
    return falls(abs(abs(turn) - 1.0), 0.4, 0.05)


def _counterclockwise(found: Floats) -> Floats:
    return found if signed_area(found) > 0 else found[::-1]
