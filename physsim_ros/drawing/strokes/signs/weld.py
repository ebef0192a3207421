# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The small square over two bodies: welds them (a pin)."""

from __future__ import annotations

from functools import partial
import math

from physsim_ros.drawing.strokes import request_builder, snapping
from physsim_ros.drawing.strokes.hypothesis import falls
from physsim_ros.drawing.strokes.meanings import Context, Interpretation, Outcome
from physsim_ros.model.arrays import Floats
from physsim_ros.model.joints import JointKind
from physsim_ros.model.transform import Point

# The greatest side of a weld, in side lengths of a square of the lesser body's area.
_LARGEST = 0.5


def interpretation(corners: Floats, context: Context, *, weight: float) -> Interpretation:
    """
    Return the interpretation of a rectangle as a weld.

    :param corners: (4, 2) float64 [m]
    :param weight: of the rectangle; the weld has a share of it
    """
    x, y = corners.mean(axis=0).tolist()
    under = snapping.crossed_pair((x, y), context)
    return Interpretation(
        meaning='pin',
        weight=weight * _share_of(corners, under, context),
        build=partial(_weld_bodies, (x, y), under, context),
    )


def _share_of(corners: Floats, under: tuple[str, ...], context: Context) -> float:
    if len(under) < 2:
        return 0.0
    least = min(math.sqrt(context.scene.body(name).shape.form.area) for name in under)
    side = max(math.dist(corners[0], corners[1]), math.dist(corners[1], corners[2]))
    return falls(side / (_LARGEST * least), 1.0, 0.06)


def _weld_bodies(point: Point, under: tuple[str, ...], context: Context) -> Outcome:
    a, b = under
    return Outcome(
        requests=(request_builder.join_at(JointKind.PIN, point, under, context),),
        subject=a,
        message=f'a pin between {a} and {b}',
        outline=context.drawn.points,
    )
