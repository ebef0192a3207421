# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The small circle on a body: an axle to the body behind that one, or to the background."""

from __future__ import annotations

from functools import partial
import math

import numpy as np
from physsim_ros.drawing.strokes import request_builder, snapping
from physsim_ros.drawing.strokes.hypothesis import falls
from physsim_ros.drawing.strokes.meanings import Context, Interpretation, Outcome
from physsim_ros.model.joints import JointKind
from physsim_ros.model.transform import Point

# The greatest diameter of an axle, in side lengths of a square of the body's area: on one body;
# on two that overlap.
_LARGEST, _LARGEST_ON_TWO = 0.5, 0.75
# The least number of corners of a polygon that may be a small circle.
_LEAST_CORNERS = 5


def share_of(
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


def interpretation(
    center: Point, radius: float, context: Context, *, weight: float
) -> Interpretation:
    """
    Return the interpretation of a closed shape as an axle.

    :param radius: of the circle that the preview shows [m]
    """
    return Interpretation(
        meaning='axle', weight=weight, build=partial(_build_axle, center, radius, context)
    )


def _build_axle(center: Point, radius: float, context: Context) -> Outcome:
    point, under = snapping.axle_pivot(center, context)
    request = request_builder.join_at(JointKind.AXLE, point, under, context)
    between = ' and '.join(under) if len(under) == 2 else f'{under[0]} and the background'
    return Outcome(
        requests=(request,),
        subject=under[0],
        message=f'an axle between {between}',
        outline=request_builder.circle_outline(point, radius),
    )
