# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The arrow: in free space the new direction of gravity, from a body its velocity."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
import math

import numpy as np
from physsim_ros.drawing.geometry import point_of
from physsim_ros.drawing.strokes import regularisation
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
from physsim_ros.drawing.strokes.stroke import SHARP
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import NotRecognised
from physsim_ros.model.requests import Command, Configure
from physsim_ros.model.transform import cross, dots, norms, segment_distances
from physsim_ros.model.translation import Text

# The least distance between the ends of an arrow, in shares of its size: barbs reach back to the
# tail's side, if they are as long as the shaft.
_LEAST_CHORD = 0.15
# The part of a shaft that shows how it is bowed, from its tail on, and the part of an arrow in
# which its head is, before its tip; in shares of the distance between both.
_SHAFT, _HEAD = 0.6, 0.9
# The length of the shaft behind its head that still counts to the head, in lengths of that.
_NECK = 0.2
# The shares of a barb at which the pen passes.
_ALONG = np.linspace(0.15, 1.0, 8)[:, None]


def _candidates(features: Features) -> Iterator[Candidate]:
    """Yield a shaft and a head, in either order; points: tail and tip."""
    stroke, measures = features.stroke, features.measures
    if measures['chord'] >= _LEAST_CHORD and measures['sharpest'] >= SHARP:
        for points in (stroke.points, stroke.points[::-1]):
            yield _from_tail(points, features)


def _from_tail(points: Floats, features: Features) -> Candidate:
    """
    Return the arrow whose tail is the first point.

    The order in which shaft, barbs and the side between these are drawn does not matter: the pen
    goes along all of both barbs, and nowhere but along a triangle and its axis.
    """
    tail = points[0]
    tip = points[int(((points - tail) ** 2).sum(axis=1).argmax())]
    frame, bow = _unbowed(_in_frame(points, tail, tip))
    near = frame[np.maximum.accumulate(frame[:, 0]) > 1.0 - _HEAD] - (1.0, 0.0)
    left, right = near[int(near[:, 1].argmax())], near[int(near[:, 1].argmin())]
    shorter, longer = sorted((float(norms(left)), float(norms(right))))
    # The angles of both barbs with the shaft.
    less, more = sorted(math.atan2(side * y, -x) for side, (x, y) in ((1, left), (-1, right)))
    neck = np.array(((1.0 + _NECK) * min(left[0], right[0], 0.0), 0.0))
    head = near[near[:, 0] >= neck[0]]
    # Both barbs, the side between these, and the neck.
    middle = np.zeros(2)
    start, end = np.array((middle, middle, left, middle)), np.array((left, right, right, neck))
    off = segment_distances(head, start[:, None], end[:, None]).min(axis=0)
    missed = [norms((barb * _ALONG)[:, None] - head).min(axis=1).max() for barb in (left, right)]
    steps = np.diff(head, axis=0)
    shaft = frame[frame[:, 0] < 1.0 + neck[0], 1]
    size = max(longer, 1e-12)
    return Candidate(
        measures={
            **features.measures,
            'bow': bow,
            'shaft': math.sqrt(float((shaft**2).sum()) / max(len(shaft), 1)),
            # The pen does not go beyond the tail.
            'behind': float(frame[:, 0].min()),
            'less': less,
            'more': more,
            'symmetry': less / max(more, 1e-12),
            'balance': shorter / size,
            'longer': longer,
            'off': math.sqrt(float((off**2).mean())) / size,
            'missed': float(max(missed)) / size,
            # It goes back, and farther than along one barb.
            'back': float(np.maximum(-steps[:, 0], 0.0).sum()) / size,
            'head': float(norms(steps).sum()) / size,
        },
        points=np.array((tail, tip)),
    )


def _unbowed(frame: Floats) -> tuple[Floats, float]:
    """
    Return an arrow whose shaft is straightened, and the height of its bow [lengths].

    :param frame: (n, 2) float64: the arrow from (0, 0) to (1, 0), its shaft a parabola
    """
    x, y = frame.T
    parabola = x * (1.0 - x)
    shaft = slice(0, int((x > _SHAFT).argmax()))
    fitted = parabola[shaft]
    bend = float((fitted * y[shaft]).sum()) / max(float((fitted**2).sum()), 1e-300)
    return np.column_stack((x, y - bend * parabola)), abs(bend) / 4


def _in_frame(points: Floats, origin: Floats, one: Floats) -> Floats:
    """Return points in the frame in which one point is (0, 0) and another (1, 0)."""
    along = one - origin
    away = points - origin
    local = np.column_stack((dots(away, along), cross(along, away)))
    return local / max(float(dots(along, along)), 1e-300)


def _meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield a velocity where the tail is at a body that can move, else a turn of gravity."""
    points, scene = form.points, context.scene
    tail = point_of(points[0])
    near = scene.bodies_near(tail, context.settings.snap)
    moving = next((name for name in near if not scene.body(name).anchored), None)
    if moving is not None:
        yield Meaning(
            kind=MeaningKind.VELOCITY,
            weight=form.weight,
            build=partial(_set_velocity, moving, points, context),
        )
        return
    free = not scene.bodies_at(tail)
    yield Meaning(
        kind=MeaningKind.GRAVITY,
        weight=form.weight * (1.0 if free else MISPLACED),
        build=partial(_turn_gravity, points, context),
    )


def _set_velocity(name: str, points: Floats, context: Context) -> Outcome:
    """Set the velocity of a body: 1 m of the arrow for 1 m/s; its spin stays."""
    x, y = (points[1] - points[0]).tolist()
    twist = x, y, context.scene.twist(name)[2]
    return Outcome(
        requests=(Command(names=(name,), twists=np.array((twist,))),),
        subject=name,
        message=Text('{body} moves with ({x:.3g}, {y:.3g}) m/s', body=name, x=x, y=y),
        outline=context.drawn.points,
    )


def _turn_gravity(points: Floats, context: Context) -> Outcome:
    """Turn gravity into the direction from tail to tip; its magnitude stays."""
    tail = context.scene.bodies_at(point_of(points[0]))
    if tail:
        template = 'an arrow in free space turns gravity; this one begins on {body}'
        raise NotRecognised(template, field='poses', body=tail[0])
    strength = context.scene.gravity_strength()
    ends = regularisation.line(points, context.settings.beautify)
    x, y = (ends[1] - ends[0]).tolist()
    length = math.hypot(x, y)
    gravity = strength * x / length, strength * y / length
    return Outcome(
        requests=(Configure(changes={'gravity': gravity}),),
        subject='',
        message=Text('gravity towards ({x:.3g}, {y:.3g}) m/s²', x=gravity[0], y=gravity[1]),
        outline=context.drawn.points,
    )


ARROW = Sign(name='arrow', candidates=_candidates, meanings=_meanings)
