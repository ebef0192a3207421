# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The arrow: in free space the new direction of gravity, from a body its velocity."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import partial
import math

import numpy as np
from physsim_ros.drawing.strokes import regularisation
from physsim_ros.drawing.strokes.corner_detection import ARM
from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.hypothesis import falls, Hypothesis, LEAST, rises
from physsim_ros.drawing.strokes.meanings import (
    Context,
    GRAVITY,
    Interpretation,
    MISPLACED,
    Outcome,
)
from physsim_ros.drawing.strokes.polyline import path_length, point_of, smoothed, turns
from physsim_ros.drawing.strokes.signs.cross import absence as no_x
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import NotRecognised
from physsim_ros.model.requests import Command, Configure
from physsim_ros.model.transform import cross, dots, norms

PRIMITIVE = 'arrow'
# The least gap between the ends of an arrow, in shares of its length.
_LEAST_GAP = 0.1
# The greatest distance of the pen from the tip of an arrow at which it is there, in lengths.
_AT_TIP = 0.1


def hypothesis(features: Features) -> Hypothesis:
    """Return the hypothesis of a shaft and a head, in either order; points: tail and tip."""
    stroke = features.stroke
    # Shaft and barbs are four swings at most.
    absence = falls(features.swings.count, 4.5, 0.25) * _sharpness(stroke.points)
    if absence < LEAST or stroke.gap < _LEAST_GAP:
        return Hypothesis(primitive=PRIMITIVE, weight=0.0, points=stroke.points[[0, -1]])
    orders = stroke.points, stroke.points[::-1]
    best = max((_arrow_from_tail(points) for points in orders), key=lambda each: each.weight)
    return replace(best, weight=best.weight * absence * no_x(features))


def _sharpness(points: Floats) -> float:
    """Return the weight of two sharp turns, 0 .. 1: of the tip and of a barb, in any order."""
    turn = np.abs(turns(smoothed(points, 1.0, closed=False), ARM, closed=False))
    first = int(turn.argmax())
    apart = np.abs(np.arange(len(turn)) - first) > ARM
    return rises(float(turn[first]), 1.6, 0.1) * rises(float(turn[apart].max()), 1.0, 0.1)


def _arrow_from_tail(points: Floats) -> Hypothesis:
    """Return the hypothesis of an arrow whose tail is the first point."""
    tail = points[0]
    tip = points[int(((points - tail) ** 2).sum(axis=1).argmax())]
    frame = _in_frame(points, tail, tip)
    x, y = frame.T
    # The shaft ends at the point at which the pen turns back or aside.
    ahead = x[4:] - x[:-4]
    over = (ahead < 0.55 * np.median(ahead[:40])) & (x[:-4] > 0.4)
    end = int(over.argmax()) if over.any() else len(points) - 1
    # The head is symmetric about the last half of the shaft, which may be bowed.
    head = _in_frame(points[end:], points[end // 2], tip) - (1.0, 0.0)
    head *= float(norms(tip - points[end // 2]) / norms(tip - tail))
    left, right = int(head[:, 1].argmax()), int(head[:, 1].argmin())
    up, down = float(head[left, 1]), -float(head[right, 1])
    path = path_length(head)
    # The pen leaves the tip again, unlike at the end of a zigzag.
    at_tip = int((np.hypot(x - 1.0, y) < _AT_TIP).argmax())
    after = path_length(frame[at_tip:])
    factors = (
        falls(float(np.abs(y[:end]).max(initial=0.0)), 0.2, 0.015),
        rises(min(up, down) / max(up, down, 1e-12), 0.2, 0.03),
        rises(up + down, 0.09, 0.012),
        falls(up + down, 0.85, 0.04),
        rises(float(head[:, 0].min()), -0.58, 0.025),
        falls(float(max(head[left, 0], head[right, 0])), -0.015, 0.012),
        rises(path, 0.22, 0.02),
        rises(after, 1.8 * _AT_TIP, 0.015),
        falls(path, 2.6, 0.12),
    )
    weight = math.prod(factors)
    return Hypothesis(primitive=PRIMITIVE, weight=weight, points=np.array((tail, tip)))


def _in_frame(points: Floats, origin: Floats, one: Floats) -> Floats:
    """Return points in the frame in which one point is (0, 0) and another (1, 0)."""
    along = one - origin
    away = points - origin
    local = np.column_stack((dots(away, along), cross(along, away)))
    return local / max(float(dots(along, along)), 1e-300)


def interpretations(hypothesis: Hypothesis, context: Context) -> Iterator[Interpretation]:
    """Yield a velocity where the tail lies on a body that can move, else a turn of gravity."""
    points = hypothesis.points
    under = context.scene.bodies_at(point_of(points[0]))
    moving = next((name for name in under if not context.scene.body(name).anchored), None)
    if moving is not None:
        yield Interpretation(
            meaning='velocity',
            weight=hypothesis.weight,
            build=partial(_set_velocity, moving, points, context),
        )
        return
    free = not under
    yield Interpretation(
        meaning=GRAVITY,
        weight=hypothesis.weight * (1.0 if free else MISPLACED),
        build=partial(_turn_gravity, points, context),
    )


def _set_velocity(name: str, points: Floats, context: Context) -> Outcome:
    """Set the velocity of a body: 1 m of the arrow for 1 m/s; its spin stays."""
    x, y = (points[1] - points[0]).tolist()
    twist = x, y, context.scene.twist(name)[2]
    return Outcome(
        requests=(Command(names=(name,), twists=np.array((twist,))),),
        subject=name,
        message=f'{name} moves with ({x:.3g}, {y:.3g}) m/s',
        outline=context.drawn.points,
    )


def _turn_gravity(points: Floats, context: Context) -> Outcome:
    """Turn gravity into the direction from tail to tip; its magnitude stays."""
    tail = context.scene.bodies_at(point_of(points[0]))
    if tail:
        raise NotRecognised(
            f'an arrow in free space turns gravity; this one begins on {tail[0]}', field='poses'
        )
    strength = context.scene.gravity_strength()
    ends = regularisation.line(points, context.settings.beautify)
    x, y = (ends[1] - ends[0]).tolist()
    length = math.hypot(x, y)
    gravity = strength * x / length, strength * y / length
    return Outcome(
        requests=(Configure(changes={'gravity': gravity}),),
        subject='',
        message=f'gravity towards ({gravity[0]:.3g}, {gravity[1]:.3g}) m/s²',
        outline=context.drawn.points,
    )
