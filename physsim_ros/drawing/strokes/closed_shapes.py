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
from physsim_ros.drawing.strokes import corner_detection, fitting, outcomes, pivots
from physsim_ros.drawing.strokes.evidence import falls, LEAST, rises
from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.fitting import rectangle, traced
from physsim_ros.drawing.strokes.geometry import angles, point_of, principal_axis, size_of, widened
from physsim_ros.drawing.strokes.meanings import (
    Context,
    DISC,
    Form,
    Meaning,
    Outcome,
    POLYGON,
    RECTANGLE,
)
from physsim_ros.drawing.strokes.outer_boundary import outer_boundary
from physsim_ros.model.arrays import Floats
from physsim_ros.model.shapes import crosses_itself, signed_area
from physsim_ros.model.transform import next_vertices, norms, Point

# The name of a form whose meaning is a polygon.
OVAL = 'oval'
# The greatest distance of an outline from a rectangle (rms), in shares of its size: that of an
# octagon is 0.024 and more; and that in shares of the error of an ellipse, 0.5 for an oval.
_SQUARE, _SQUARER = 0.0222, 0.27
# The least aspect of a circle as people draw it: from 0.5 to 0.63 no outline tells circles from
# ovals, wheels are drawn more often, and the other reading is offered. The number of sides of an
# oval, which rolls.
_CIRCULAR, _OVAL_SIDES = 0.58, 48
# Evidence for an ellipse, in log odds: a constant, and the factors of the logarithms of the
# residuals of straight sides and of the ellipse, of the bulge of the sides, and of the log of
# the aspect below that of `_PLANK`: what is thinner is more often a plank than an oval.
_EVIDENCE, _SIDES, _ELLIPSE, _BULGE, _THIN, _PLANK = -5.5, 2.8, 5.55, 4.95, 7.5, 0.35
# The least residual that is told from 0, in shares of the size.
_EXACT = 0.001
# The least aspect of the corners of a polygon that may be a small circle.
_LEAST_ROUND = 0.4
# Factor on the weight of an outline that is neither round nor made of straight sides.
BLOB = 0.8


def forms(features: Features, plain: float) -> Iterator[Form]:
    """
    Yield disc, oval, rectangle and polygon, which share the weight of a closed outline.

    The points of a disc are its centre and a point on its rim; those of the others are corners.

    :param plain: weight of the stroke being no sign
    """
    stroke = features.stroke
    closed = plain * features.closure * features.swings.absence
    if stroke.outline is None or closed < LEAST:
        return
    shapes = list(_shapes(stroke.outline))
    total = sum(shape.weight for shape in shapes)
    if total >= LEAST:
        for shape in shapes:
            yield replace(shape, weight=closed * shape.weight / total)


def _shapes(outline: Floats) -> Iterator[Form]:
    """Yield the shapes that an outline may have, with relative weights."""
    ellipse = fitting.ellipse(outline)
    error, aspect = ellipse.error, ellipse.aspect
    wide, narrowed = widened(outline)
    at = corner_detection.corners(wide, closed=True)
    found = narrowed(corner_detection.vertices(wide, at, closed=True))
    size = size_of(wide)
    residual = corner_detection.side_error(wide, at) / size if len(at) >= 3 else 1.0
    # Independent of the corners: a rectangle may have a bent side or a round corner.
    corners, off = fitting.rectangle_of(wide)
    off /= size
    sides = min(residual, off)
    edgeless = _edgelessness(sides=sides, error=error, aspect=aspect, bulge=_bulge(wide, at))
    circle = edgeless * falls(error, 0.1, 0.01)
    sided = (1.0 - edgeless) * falls(residual, 0.022, 0.003)
    circular = rises(aspect, _CIRCULAR, 0.02)
    rim = ellipse.center + np.array((ellipse.radius, 0.0))
    disc = np.array((ellipse.center, rim))
    yield Form(name=DISC, weight=circle * circular, points=disc)
    # A thinner outline is a line, drawn to and fro.
    _, longer, shorter = principal_axis(outline - outline.mean(axis=0))
    broad = rises(math.sqrt(shorter / longer), 0.02, 0.003)
    oval = ellipse.corners(_OVAL_SIDES)
    yield Form(name=OVAL, weight=broad * circle * (1.0 - circular), points=oval)
    square = falls(off, _SQUARE, 0.003) * falls(off / max(error, 1e-6), _SQUARER, 0.03)
    if len(at) == 4 and squareness(found) > square:
        corners, square = found, squareness(found)
    else:
        corners = narrowed(corners)
    yield Form(name=RECTANGLE, weight=broad * (1.0 - edgeless) * square, points=corners)
    if len(at) >= 3 and crosses_itself(found):
        boundary = outer_boundary(found)
        sided = sided if boundary is not None else 0.0
        found = found if boundary is None else boundary
    sided *= 1.0 - square
    free = BLOB * max(1.0 - max(square, circle) - sided, 0.0)
    if free > sided:
        # Neither round nor sided: a polygon along the stroke.
        along = traced(outline)
        boundary = outer_boundary(along) if crosses_itself(along) else along
        found, free = (found, 0.0) if boundary is None else (boundary, free)
    yield Form(name=POLYGON, weight=broad * (sided + free), points=found)


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
        + _SIDES * math.log(max(sides, _EXACT))
        - _ELLIPSE * math.log(max(error, _EXACT))
        + _BULGE * bulge
        + _THIN * math.log(min(max(aspect, _EXACT) / _PLANK, 1.0))
    )
    return rises(evidence, 0.0, 1.0)


def disc_meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield axle and disc."""
    points = form.points
    build = partial(outcomes.disc, points, context)
    circle = point_of(points[0]), math.dist(*points)
    yield from _axle_or_body(form, context, *circle, meaning=DISC, build=build)


def oval_meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield axle and polygon, which is not regularised."""
    points = form.points
    build = partial(outcomes.smooth_polygon, points, context)
    circle = point_of(points.mean(axis=0)), size_of(points) / 3
    yield from _axle_or_body(form, context, *circle, meaning=POLYGON, build=build)


def _axle_or_body(
    form: Form,
    context: Context,
    center: Point,
    radius: float,
    *,
    meaning: str,
    build: Callable[[], Outcome],
) -> Iterator[Meaning]:
    """
    Yield an axle and a body, which share the weight of a round outline.

    :param meaning: of the body
    :param build: returns its outcome
    """
    share = pivots.axle_share(center, radius, context)
    yield pivots.axle_meaning(center, radius, context, weight=form.weight * share)
    yield Meaning(name=meaning, weight=form.weight * (1.0 - share), build=build)


def rectangle_meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield a weld and a rectangle."""
    pin = pivots.weld_meaning(form.points, context, weight=form.weight)
    yield pin
    yield Meaning(
        name=RECTANGLE,
        weight=form.weight - pin.weight,
        build=partial(outcomes.rectangle, form.points, context),
    )


def polygon_meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield axle and polygon: small circles are drawn with corners."""
    points = form.points
    center, radius = points.mean(axis=0), size_of(points) / 3
    _, along, across = principal_axis(points - center)
    share = pivots.axle_share(point_of(center), radius, context, corners=len(points))
    share *= rises(math.sqrt(across / along), _LEAST_ROUND, 0.03)
    weight, shown = form.weight * share, math.dist(center, points[0])
    yield pivots.axle_meaning(point_of(center), shown, context, weight=weight)
    yield Meaning(
        name=POLYGON,
        weight=form.weight * (1.0 - share),
        build=partial(outcomes.polygon, points, context),
    )


def _bulge(outline: Floats, at: list[int]) -> float:
    """Return how much the sides of a closed polyline are arcs: 1 those of a circle, 0 straight."""
    if len(at) < 3:
        return 1.0
    beyond = 1.0 - abs(signed_area(outline[at])) / max(abs(signed_area(outline)), 1e-300)
    turn = 2.0 * math.pi / len(at)
    # Of a circle, over equal sides.
    return min(max(beyond / (1.0 - math.sin(turn) / turn), 0.0), 2.0)


def squareness(found: Floats) -> float:
    """Return how well four corners fit a rectangle, 0 .. 1."""
    nearest = rectangle(found)
    sides = next_vertices(found) - found
    lengths = norms(next_vertices(nearest) - nearest)
    off = float(norms(nearest - found).mean() / lengths.mean())
    slants = np.abs(np.abs(angles(np.roll(sides, 1, axis=0), sides)) - math.pi / 2)
    # The direction of a short side is less exact than its ends.
    slant = float(slants.mean()) * min(1.0, float(lengths.min() / lengths.max()) / 0.3)
    return falls(off, 0.115, 0.012) * falls(slant, 0.3, 0.024)
