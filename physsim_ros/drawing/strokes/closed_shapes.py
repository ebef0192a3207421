# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Meanings of closed strokes: a solid, or, small and on a body, an axle or a weld.

A small circle is an axle, which joins a body to the one behind it or to the background; a small
square over two bodies welds them (a pin).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
import math

import numpy as np
from physsim_ros.drawing.strokes import bodies_under, outcomes
from physsim_ros.drawing.strokes.evidence import Form, Limit
from physsim_ros.drawing.strokes.geometry import circle_outline, point_of, principal_axis, size_of
from physsim_ros.drawing.strokes.meanings import Context, Meaning, Outcome
from physsim_ros.drawing.strokes.plain_forms import DISC, POLYGON, RECTANGLE
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.transform import Point

# The least aspect of the corners of a polygon that may be a small circle.
_LEAST_ROUND = Limit(0.4, 0.03)
# The size of an axle or a weld, in shares of the greatest.
_SMALL = Limit(1.0, 0.06)
# The greatest diameter of an axle, and side of a weld, in side lengths of a square of the lesser
# body's area: with its middle on one body, or in a gap; on two that overlap.
_LARGEST, _LARGEST_ON_TWO = 0.5, 0.75
# The least number of corners of a polygon that may be a small circle; one of four may be a square.
_LEAST_CORNERS = 5


def disc_meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield axle and disc."""
    points = form.points
    circle = point_of(points[0]), math.dist(*points)
    share = _axle_share(*circle, context)
    build = partial(outcomes.disc, points, context)
    yield from _axle_or_body(form, share, circle, context, meaning=DISC, build=build)


def oval_meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield axle and polygon, which is not regularised."""
    points = form.points
    circle = point_of(points.mean(axis=0)), size_of(points) / 3
    share = _axle_share(*circle, context)
    build = partial(outcomes.smooth_polygon, points, context)
    yield from _axle_or_body(form, share, circle, context, meaning=POLYGON, build=build)


def polygon_meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield a polygon, and axle or weld: small circles are drawn with corners, squares askew."""
    points = form.points
    build = partial(outcomes.polygon, points, context)
    if len(points) < _LEAST_CORNERS:
        yield from _weld_or_body(form, context, meaning=POLYGON, build=build)
        return
    middle = points.mean(axis=0)
    center = point_of(middle)
    _, along, across = principal_axis(points - middle)
    share = _axle_share(center, size_of(points) / 3, context)
    share *= _LEAST_ROUND.above(math.sqrt(across / along))
    circle = center, math.dist(middle, points[0])
    yield from _axle_or_body(form, share, circle, context, meaning=POLYGON, build=build)


def rectangle_meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield a weld and a rectangle."""
    build = partial(outcomes.rectangle, form.points, context)
    yield from _weld_or_body(form, context, meaning=RECTANGLE, build=build)


def _axle_or_body(
    form: Form,
    share: float,
    circle: tuple[Point, float],
    context: Context,
    *,
    meaning: str,
    build: Callable[[], Outcome],
) -> Iterator[Meaning]:
    """
    Yield an axle and a body, which share the weight of an outline.

    :param share: of the axle, 0 .. 1
    :param circle: centre and radius that the preview of the axle shows [m]
    :param meaning: of the body
    :param build: returns its outcome
    """
    axle = partial(_build_axle, *circle, context)
    yield Meaning(name='axle', weight=form.weight * share, build=axle)
    yield Meaning(name=meaning, weight=form.weight * (1.0 - share), build=build)


def _weld_or_body(
    form: Form, context: Context, *, meaning: str, build: Callable[[], Outcome]
) -> Iterator[Meaning]:
    """Yield a weld and a body, which share the weight of an outline of few corners."""
    center = point_of(form.points.mean(axis=0))
    under = bodies_under.crossed_pair(center, context)
    share = 0.0
    if len(form.points) == 4 and len(under) == 2:
        side = max(map(math.dist, form.points[:2], form.points[1:3]))
        share = _SMALL.below(side / _largest_joint(center, under, context))
    weld = partial(_weld_bodies, center, under, context)
    yield Meaning(name='pin', weight=form.weight * share, build=weld)
    yield Meaning(name=meaning, weight=form.weight * (1.0 - share), build=build)


def _axle_share(center: Point, radius: float, context: Context) -> float:
    """
    Return the share of a closed shape's weight that is an axle's, 0 .. 1.

    :param radius: of the shape [m]
    """
    scene = context.scene
    # In a gap, an axle joins the bodies on either side.
    under = bodies_under.crossed_pair(center, context)
    if not under or not any(scene.body(name).dynamic for name in under):
        return 0.0
    limit = _largest_joint(center, under, context)
    if len(under) == 1:
        rim = circle_outline(center, radius, sides=8)[:-1]
        inside = np.count_nonzero(scene.covers(under[0], rim))
        # A circle over the edge is a body of its own, unless it is as small as a hand can draw.
        if inside < len(rim) - 1:
            limit = min(2 * context.settings.snap, 0.9 * limit / _LARGEST)
    return _SMALL.below(2 * radius / limit)


def _largest_joint(center: Point, under: Sequence[str], context: Context) -> float:
    """Return the greatest diameter of an axle of some bodies, or side of a weld [m]."""
    least = min(math.sqrt(context.scene.body(name).shape.form.area) for name in under)
    on_two = len(context.scene.bodies_at(center)) > 1
    return least * (_LARGEST_ON_TWO if on_two else _LARGEST)


def _build_axle(center: Point, radius: float, context: Context) -> Outcome:
    point, pairs = bodies_under.axle_pairs(center, context)
    names = [pairs[0][0], *('the background' if b == WORLD else b for _, b in pairs)]
    return Outcome(
        requests=tuple(outcomes.joins_at(JointKind.AXLE, point, pairs, context)),
        subject=names[0],
        message=f'an axle between {", ".join(names[:-1])} and {names[-1]}',
        outline=circle_outline(point, radius),
    )


def _weld_bodies(point: Point, under: tuple[str, ...], context: Context) -> Outcome:
    a, b = under
    return Outcome(
        requests=tuple(outcomes.joins_at(JointKind.PIN, point, [(a, b)], context)),
        subject=a,
        message=f'a pin between {a} and {b}',
        outline=context.drawn.points,
    )
