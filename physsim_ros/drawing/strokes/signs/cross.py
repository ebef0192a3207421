# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The x, drawn without lifting the pen: anchors the body under it."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
import math

from physsim_ros.drawing.strokes.features import Features, loop_roundness
from physsim_ros.drawing.strokes.fitting import line
from physsim_ros.drawing.strokes.hypothesis import falls, Hypothesis, rises
from physsim_ros.drawing.strokes.meanings import Context, Interpretation, MISPLACED, Outcome
from physsim_ros.drawing.strokes.polyline import point_of
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import NothingThere
from physsim_ros.model.requests import Anchor
from physsim_ros.model.transform import cross

PRIMITIVE = 'x'
# The greatest area of the loop between the two lines, by its length squared: of a triangle it is
# 0.048 at most and, its corners rounded, 0.058; the loop of a pigtail is a circle, 0.080.
_ROUND = 0.062


def hypothesis(features: Features) -> Hypothesis:
    """Return the hypothesis of two straight lines that cross; the point is their crossing."""
    stroke, crossings = features.stroke, features.crossings
    best = Hypothesis(primitive=PRIMITIVE, weight=0.0, points=stroke.points[:1])
    count = len(stroke.points) - 1
    for crossing in crossings:
        at, first, last = crossing
        before, loop, after = first / count, (last - first) / count, 1.0 - last / count
        # Each line reaches half as far beyond the crossing as its end lies before it.
        until, since = int(1.5 * first) + 1, int(1.5 * last - 0.5 * count)
        one, other = stroke.points[:until], stroke.points[since:]
        if min(len(one), len(other)) < 5:
            continue
        (_, along, bent), (_, beside, curved) = line(one), line(other)
        weight = (
            rises(min(before, after) / max(before, after), 0.4, 0.05)
            * rises(min(before, after), 0.08, 0.015)
            * rises(loop, 0.4, 0.04)
            * falls(loop, 0.82, 0.02)
            * falls(max(bent, curved) / stroke.size, 0.06, 0.008)
            * rises(abs(float(cross(along, beside))), 0.5, 0.06)
            * falls(len(crossings), 2.5, 0.3)
            * falls(loop_roundness(stroke.points, crossing), _ROUND, 0.002)
        )
        if weight > best.weight:
            best = Hypothesis(primitive=PRIMITIVE, weight=weight, points=at[None])
    return best


def absence(features: Features) -> float:
    """
    Return the weight of the stroke being no x, 0 .. 1.

    The second line of an x looks like the head of an arrow, but the barbs of an arrow do not go on
    beyond its shaft.
    """
    return falls(hypothesis(features).weight, 0.5, 0.1)


def interpretations(hypothesis: Hypothesis, context: Context) -> Iterator[Interpretation]:
    """Yield an anchor."""
    points = hypothesis.points
    under = context.scene.bodies_at(point_of(points[0]), context.settings.snap)
    yield Interpretation(
        meaning='anchor',
        weight=hypothesis.weight * (1.0 if under else MISPLACED),
        build=partial(_anchor_body, points, context),
    )


def _anchor_body(points: Floats, context: Context) -> Outcome:
    """Anchor the topmost body at the crossing, or the one beside it that the x touches."""
    scene, drawn = context.scene, context.drawn.points
    point = point_of(points[0])
    under = scene.bodies_at(point)
    if not under:
        # The crossing lies beside a thin body: the point of the stroke on it is taken instead.
        under = scene.bodies_at(point, context.settings.snap)
        near = drawn[scene.covers(under[0], drawn)] if under else ()
        if not len(near):
            x, y = point
            raise NothingThere(
                f'an x anchors the body under it; there is none at ({x:.3g}, {y:.3g})',
                field='poses',
            )
        point = min(map(point_of, near), key=lambda each: math.dist(each, point))
    return Outcome(
        requests=(Anchor(point=point),),
        subject=under[0],
        message=f'anchor {under[0]}',
        outline=drawn,
    )
