# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The round arrow about an axle: a motor that turns by the arrow's angle in a second."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
import math

import numpy as np
from physsim_ros.drawing.geometry import angles, least_squares, point_of
from physsim_ros.drawing.scene_query import SceneQuery
from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.stages import (
    Candidate,
    Context,
    Form,
    Meaning,
    MeaningKind,
    MISPLACED,
    Outcome,
    Sign,
)
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import NothingThere
from physsim_ros.model.joints import JointKind, JointProperties
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import Join
from physsim_ros.model.scene import Joint
from physsim_ros.model.shapes import Disc
from physsim_ros.model.transform import norms
from physsim_ros.model.translation import Text

# Distance of the points between which the pen turns at the tip [points].
_STRIDE = 3
# The least turn of the pen at the tip [rad]: barbs point back.
_TURN = 1.5


def _candidates(features: Features) -> Iterator[Candidate]:
    """Yield an arc and a head, from either end; points: the arc's centre, then the arc."""
    path = features.path
    sides = path[_STRIDE:] - path[:-_STRIDE]
    bends = np.abs(angles(sides[:-_STRIDE], sides[_STRIDE:]))
    for points, turns in ((path, bends), (path[::-1], bends[::-1])):
        yield from _from_tail(points, turns, features)


def _from_tail(points: Floats, bends: Floats, features: Features) -> Iterator[Candidate]:
    """Yield the round arrow whose tail is the first point, if it has a tip."""
    # Sharp bends before are of the hand, or corners: those are counted below.
    earliest = len(points) // 3
    sharp = earliest + np.flatnonzero(bends[earliest:] > _TURN)
    if len(sharp) == 0:
        return
    # The sharpest point of the first bend is the tip.
    tip = int(sharp[0] + bends[slice(sharp[0], sharp[0] + 2 * _STRIDE)].argmax()) + _STRIDE
    arc, head = points[: tip + 1], points[tip:]
    center, radius, error = _circle(arc)
    # The head, outwards of the arc by the radius.
    out = norms(head - center) / radius - 1.0
    inner, outer = float(-out.min()), float(out.max())
    yield Candidate(
        measures={
            **features.measures,
            'error': error / radius,
            'sweep': abs(_sweep(arc, center)),
            'bend': _sharpest_bend(arc),
            'sides': min(inner, outer) / max(inner, outer, 1e-12),
            'head': inner + outer,
        },
        points=np.vstack((center, arc)),
    )


def _meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield a motor."""
    center, arc = form.points[0], form.points[1:]
    axle = _nearest_axle(center, arc, context.scene)
    yield Meaning(
        kind=MeaningKind.MOTOR,
        weight=form.weight * (1.0 if axle is not None else MISPLACED),
        build=partial(_drive_axle, axle, _sweep(arc, center), context),
    )


def _drive_axle(axle: Joint | None, sweep: float, context: Context) -> Outcome:
    scene = context.scene
    if axle is None:
        raise NothingThere('a round arrow drives the axle inside; there is none', field='poses')
    a, b = axle.a, axle.b
    if b != WORLD and isinstance(scene.body(b).shape, Disc) > isinstance(
        scene.body(a).shape, Disc
    ):
        # The wheel turns as it was drawn.
        a, b = b, a
    request = Join(
        name=scene.motor_between(a, b) or scene.next_joint(),
        kind=JointKind.MOTOR,
        points=(scene.pivot(axle),),
        a=a,
        b=b,
        properties=JointProperties(rate=sweep),
    )
    return Outcome(
        requests=(request,),
        subject=request.name,
        message=Text('a motor turns {body} by {rate:.3g} rad/s', body=a, rate=sweep),
        outline=context.drawn.points,
    )


def _nearest_axle(center: Floats, arc: Floats, scene: SceneQuery) -> Joint | None:
    """Return the axle inside an arc that is nearest to its centre."""
    radius = float(norms(arc - center).mean())
    middle = point_of(center)
    inside = scene.axles_at(middle, radius)
    return min(inside, key=lambda each: math.dist(middle, scene.pivot(each)), default=None)


def _sharpest_bend(arc: Floats) -> float:
    """Return the greatest change of direction within an arc, over a twelfth of it [rad]."""
    stride = max(len(arc) // 12, 1)
    sides = arc[stride:] - arc[:-stride]
    # The last sides turn into the head.
    bends = np.abs(angles(sides[:-stride], sides[stride:]))[:-_STRIDE]
    return float(bends.max(initial=0.0))


def _circle(points: Floats) -> tuple[Floats, float, float]:
    """
    Return centre, radius and residual (rms) of the algebraic circle fit, all [m].

    Kasa, "A circle fitting procedure and its error analysis", 1976.
    """
    middle = points.mean(axis=0)
    away = points - middle
    squares = (away**2).sum(axis=1)
    # About their mean, the equations of the centre and that of the radius are independent.
    x, y = least_squares(2.0 * away, squares)
    radius = math.sqrt(max(float(squares.mean()) + x * x + y * y, 1e-300))
    center = middle + np.array((x, y))
    residual = norms(points - center) - radius
    return center, radius, float(np.sqrt((residual**2).mean()))


def _sweep(arc: Floats, center: Floats) -> float:
    """Return the angle by which an arc goes about its centre, counter-clockwise [rad]."""
    away = arc - center
    return float(angles(away[:-1], away[1:]).sum())


ROUND_ARROW = Sign(name='round arrow', candidates=_candidates, meanings=_meanings)
