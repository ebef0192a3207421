# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Small closed shapes on bodies: a circle is an axle, a square over two bodies welds them (a pin).

An axle joins a body to the one behind it, or to the background.
"""

from __future__ import annotations

from functools import partial
import math

import numpy as np
from physsim_ros.drawing.strokes import bodies_under, outcomes
from physsim_ros.drawing.strokes.evidence import falls
from physsim_ros.drawing.strokes.meanings import Context, Meaning, Outcome
from physsim_ros.model.arrays import Floats
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.transform import Point

# The greatest diameter of an axle, in side lengths of a square of the body's area: on one body;
# on two that overlap.
_LARGEST, _LARGEST_ON_TWO = 0.5, 0.75
# The least number of corners of a polygon that may be a small circle.
_LEAST_CORNERS = 5
# The greatest side of a weld, in side lengths of a square of the lesser body's area.
_LARGEST_WELD = 0.5


def axle_share(
    center: Point, radius: float, context: Context, *, corners: int = _LEAST_CORNERS
) -> float:
    """
    Return the share of a closed shape's weight that is an axle's, 0 .. 1.

    :param radius: of the shape [m]
    :param corners: number of its corners, where it is a polygon
    """
    scene = context.scene
    under = scene.bodies_at(center)[:2]
    if not under or corners < _LEAST_CORNERS:
        return 0.0
    least = min(math.sqrt(scene.body(name).shape.form.area) for name in under)
    limit = (_LARGEST if len(under) == 1 else _LARGEST_ON_TWO) * least
    if len(under) == 1:
        angles = np.arange(8) * math.pi / 4
        rim = np.array(center) + radius * np.column_stack((np.cos(angles), np.sin(angles)))
        inside = np.count_nonzero(scene.covers(under[0], rim))
        # A circle over the edge is a body of its own, unless it is as small as a hand can draw.
        if inside < len(rim) - 1:
            limit = min(2 * context.settings.snap, 0.9 * least)
    return falls(2 * radius / limit, 1.0, 0.06)


def axle_meaning(center: Point, radius: float, context: Context, *, weight: float) -> Meaning:
    """
    Return the meaning of a closed shape as an axle.

    :param radius: of the circle that the preview shows [m]
    """
    return Meaning(name='axle', weight=weight, build=partial(_build_axle, center, radius, context))


def _build_axle(center: Point, radius: float, context: Context) -> Outcome:
    point, pairs = bodies_under.axle_pairs(center, context)
    names = [pairs[0][0], *('the background' if b == WORLD else b for _, b in pairs)]
    return Outcome(
        requests=tuple(outcomes.joins_at(JointKind.AXLE, point, pairs, context)),
        subject=names[0],
        message=f'an axle between {", ".join(names[:-1])} and {names[-1]}',
        outline=outcomes.circle_outline(point, radius),
    )


def weld_meaning(corners: Floats, context: Context, *, weight: float) -> Meaning:
    """
    Return the meaning of a rectangle as a weld.

    :param corners: (4, 2) float64 [m]
    :param weight: of the rectangle; the weld has a share of it
    """
    x, y = corners.mean(axis=0).tolist()
    under = bodies_under.crossed_pair((x, y), context)
    return Meaning(
        name='pin',
        weight=weight * _weld_share(corners, under, context),
        build=partial(_weld_bodies, (x, y), under, context),
    )


def _weld_share(corners: Floats, under: tuple[str, ...], context: Context) -> float:
    if len(under) < 2:
        return 0.0
    least = min(math.sqrt(context.scene.body(name).shape.form.area) for name in under)
    side = max(math.dist(corners[0], corners[1]), math.dist(corners[1], corners[2]))
    return falls(side / (_LARGEST_WELD * least), 1.0, 0.06)


def _weld_bodies(point: Point, under: tuple[str, ...], context: Context) -> Outcome:
    a, b = under
    return Outcome(
        requests=tuple(outcomes.joins_at(JointKind.PIN, point, [(a, b)], context)),
        subject=a,
        message=f'a pin between {a} and {b}',
        outline=context.drawn.points,
    )
