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
from physsim_ros.drawing.geometry import circle_outline, point_of, size_of
from physsim_ros.drawing.strokes import outcomes
from physsim_ros.drawing.strokes.axles import axle_pairs, crossed_pair
from physsim_ros.drawing.strokes.evidence import Limit
from physsim_ros.drawing.strokes.stages import (
    Context,
    Form,
    Meaning,
    MeaningKind,
    Outcome,
)
from physsim_ros.model.arrays import Floats
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import shown_end
from physsim_ros.model.transform import Point
from physsim_ros.model.translation import Text

# The size of an axle or a weld, in shares of the greatest.
_SMALL = Limit(1.0)
# The greatest diameter of an axle, and side of a weld, in side lengths of a square of the lesser
# body's area: with its middle on one body, or in a gap; on two that overlap.
_LARGEST, _LARGEST_ON_TWO = 0.5, 0.75
# The least number of corners of a polygon that may be a small circle; one of four may be a square.
_LEAST_CORNERS = 5
# The meaning of an outline that is a body, and the function of its points that builds that.
_Body = tuple[MeaningKind, Callable[[Floats, Context], Outcome]]


def disc_meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield axle and disc."""
    circle = point_of(form.points[0]), math.dist(*form.points)
    return _axle_or_body(form, circle, (MeaningKind.DISC, outcomes.disc), context)


def oval_meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield axle and polygon, which is not regularised."""
    return _axle_or_body(
        form, _circle_of(form), (MeaningKind.POLYGON, outcomes.smooth_polygon), context
    )


def polygon_meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield a polygon, and axle or weld: small circles are drawn with corners, squares askew."""
    body = MeaningKind.POLYGON, outcomes.polygon
    if len(form.points) < _LEAST_CORNERS:
        return _weld_or_body(form, body, context)
    return _axle_or_body(form, _circle_of(form), body, context)


def rectangle_meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield a weld and a rectangle."""
    return _weld_or_body(form, (MeaningKind.RECTANGLE, outcomes.rectangle), context)


def _circle_of(form: Form) -> tuple[Point, float]:
    """Return centre and radius of the axle that an outline of several corners may be [m]."""
    return point_of(form.points.mean(axis=0)), size_of(form.points) / 3


def _axle_or_body(
    form: Form, circle: tuple[Point, float], body: _Body, context: Context
) -> Iterator[Meaning]:
    """
    Yield an axle and a body.

    :param circle: centre and radius of the axle [m]
    """
    share = _axle_share(*circle, context)
    return _either(
        form, share, (MeaningKind.AXLE, partial(_build_axle, *circle, context)), body, context
    )


def _weld_or_body(form: Form, body: _Body, context: Context) -> Iterator[Meaning]:
    """Yield a weld of the two bodies under an outline of four corners, and a body."""
    center, share = point_of(form.points.mean(axis=0)), 0.0
    under = crossed_pair(center, context)
    if len(form.points) == 4 and len(under) == 2:
        side = max(map(math.dist, form.points[:2], form.points[1:3]))
        share = _SMALL.below(side / _largest_joint(center, under, context))
    weld = partial(_weld_bodies, center, under, context)
    return _either(form, share, (MeaningKind.PIN, weld), body, context)


def _either(
    form: Form,
    share: float,
    joint: tuple[MeaningKind, Callable[[], Outcome]],
    body: _Body,
    context: Context,
) -> Iterator[Meaning]:
    """
    Yield a joint and a body, which share the weight of an outline.

    :param share: of the joint, 0 .. 1
    """
    meaning, outcome = body
    yield Meaning(kind=joint[0], weight=form.weight * share, build=joint[1])
    build = partial(outcome, form.points, context)
    yield Meaning(kind=meaning, weight=form.weight * (1.0 - share), build=build)


def _axle_share(center: Point, radius: float, context: Context) -> float:
    """
    Return the share of a closed shape's weight that is an axle's, 0 .. 1.

    :param radius: of the shape [m]
    """
    scene = context.scene
    # In a gap, an axle joins the bodies on either side.
    under = crossed_pair(center, context)
    if not under or not any(scene.body(name).dynamic for name in under):
        return 0.0
    limit = _largest_joint(center, under, context)
    if len(under) == 1:
        rim = circle_outline(center, radius, sides=8)[:-1]
        inside = np.count_nonzero(scene.covers(under[0], rim))
        # A circle over the edge is a body of its own, unless it is as small as a hand can draw.
        if inside < len(rim) - 1:
            limit = min(2 * context.settings.snap, limit)
    return _SMALL.below(2 * radius / limit)


def _largest_joint(center: Point, under: Sequence[str], context: Context) -> float:
    """Return the greatest diameter of an axle of some bodies, or side of a weld [m]."""
    least = min(math.sqrt(context.scene.body(name).shape.form.area) for name in under)
    on_two = len(context.scene.bodies_at(center)) > 1
    return least * (_LARGEST_ON_TWO if on_two else _LARGEST)


def _build_axle(center: Point, radius: float, context: Context) -> Outcome:
    point, pairs = axle_pairs(center, context)
    names = [pairs[0][0], *(shown_end(b) for _, b in pairs)]
    return Outcome(
        requests=tuple(outcomes.joins_at(JointKind.AXLE, point, pairs, context)),
        subject=names[0],
        message=Text('an axle between {a} and {b}', a=', '.join(names[:-1]), b=names[-1]),
        outline=circle_outline(point, radius),
    )


def _weld_bodies(point: Point, under: tuple[str, ...], context: Context) -> Outcome:
    a, b = under
    return Outcome(
        requests=tuple(outcomes.joins_at(JointKind.PIN, point, [(a, b)], context)),
        subject=a,
        message=Text('a pin between {a} and {b}', a=a, b=b),
        outline=context.drawn.points,
    )
