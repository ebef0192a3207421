# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The x, in one stroke or of two lines: anchors the body under it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
import math

from physsim_ros.drawing.geometry import Crossing, intersections, LEAST_SINE, point_of
from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.fitting import line
from physsim_ros.drawing.strokes.resampled import few_points, loop_roundness, straightness
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
from physsim_ros.model.requests import Anchor
from physsim_ros.model.transform import cross, norms, Point
from physsim_ros.model.translation import Text

# The least number of points by which a line is followed beyond the crossing, of `COUNT`.
_BEYOND = 8
# Of two lines that are an x for certain: their least straightness (distance of the ends by
# length), and the least share of either beyond the crossing. Of 2,770 arrows by people in two
# strokes, at most 0.6 % are such lines, and most x's.
_STRAIGHT, _BEYOND_OF_TWO = 0.88, 0.15
# The length of the inner half of an arm, in shares of the size of the x.
_INNER = 0.25


def _candidates(features: Features) -> Iterator[Candidate]:
    """Yield two lines that cross, for the crossing with the longest ends; the point is there."""
    stroke, crossings = features.stroke, features.crossings
    count = len(stroke.points) - 1
    if not crossings:
        return
    crossing = max(crossings, key=lambda each: min(each[1], count - each[2]))
    at, first, last = crossing
    # Each line reaches half as far beyond the crossing as its end lies before it.
    until = int(first + max(0.5 * first, _BEYOND)) + 1
    since = int(last - max(0.5 * (count - last), _BEYOND))
    one, other = stroke.points[:until], stroke.points[since:]
    (_, along, bent), (_, beside, curved) = line(one), line(other)
    before, after = first / count, 1.0 - last / count
    yield Candidate(
        measures={
            **features.measures,
            'shorter end': min(before, after),
            'balance': min(before, after) / max(before, after),
            'loop': (last - first) / count,
            'roundness': loop_roundness(stroke.points, crossing),
            'bent': max(bent, curved) / stroke.size,
            'sine': abs(float(cross(along, beside))),
        },
        points=at[None],
    )


def of_lines(strokes: Sequence[Floats]) -> Form | None:
    """
    Return the x of two straight lines, each of which goes on beyond the other; or None.

    :param strokes: each (n, 2) float64: evenly spaced [m]
    """
    if len(strokes) != 2 or min(map(straightness, strokes)) < _STRAIGHT:
        return None
    one, other = map(few_points, strokes)
    (_, along, _), (_, beside, _) = line(one), line(other)
    if abs(float(cross(along, beside))) < LEAST_SINE:
        return None

    def inside(crossing: Crossing) -> float:
        _, first, last = crossing
        shares = first / (len(one) - 1), last / (len(other) - 1)
        return min(min(share, 1.0 - share) for share in shares)

    crossing = max(intersections(one, other), key=inside, default=None)
    if crossing is None or inside(crossing) < _BEYOND_OF_TWO:
        return None
    return Form(name=CROSS.name, weight=1.0, points=crossing[0][None])


def _meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield an anchor."""
    crossing = point_of(form.points[0])
    under = _body_under(crossing, context)
    yield Meaning(
        kind=MeaningKind.ANCHOR,
        weight=form.weight * (1.0 if under is not None else MISPLACED),
        build=partial(_anchor_body, under, crossing, context),
    )


def _body_under(crossing: Point, context: Context) -> tuple[str, Point] | None:
    """
    Return the topmost body at the crossing, or the movable one beside it that the x touches.

    The crossing often lies beside a thin body, though the inner halves of its arms lie on that.

    :return: its name, and the point of the x on it that is nearest to the crossing [m]
    """
    scene, drawn = context.scene, context.drawn
    under = scene.bodies_at(crossing)
    if under:
        return under[0], crossing
    away = norms(drawn.points - crossing)
    reach = max(context.settings.snap, _INNER * drawn.size)
    inner = drawn.points[away.argsort()][: int((away <= reach).sum())]
    beside = [each for each in scene.bodies_at(crossing, reach) if scene.body(each).dynamic]
    touched = ((name, inner[scene.covers(name, inner)]) for name in beside)
    found = ((name, point_of(points[0])) for name, points in touched if len(points))
    return min(found, key=lambda each: math.dist(each[1], crossing), default=None)


def _anchor_body(under: tuple[str, Point] | None, crossing: Point, context: Context) -> Outcome:
    """Anchor a body at a point."""
    if under is None:
        x, y = crossing
        template = 'an x anchors the body under it; there is none at ({x:.3g}, {y:.3g})'
        raise NothingThere(template, field='poses', x=x, y=y)
    name, point = under
    return Outcome(
        requests=(Anchor(point=point),),
        subject=name,
        message=Text('anchor {thing}', thing=name),
        outline=context.drawn.points,
    )


CROSS = Sign(name='x', candidates=_candidates, meanings=_meanings)
