# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Meanings of open lines: a wall, a joint between two bodies, or hatching.

Laws: a line is a joint only between two different bodies, one of which moves. Lines inside a body
make it heavier.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
import math

import numpy as np
from physsim_ros.drawing.geometry import path_length, point_of
from physsim_ros.drawing.strokes import bodies_under, outcomes
from physsim_ros.drawing.strokes.bodies_under import hangs_from, stands_on
from physsim_ros.drawing.strokes.evidence import LEAST
from physsim_ros.drawing.strokes.features import Features, FEWEST_SWINGS
from physsim_ros.drawing.strokes.resampled import ARM, COUNT
from physsim_ros.drawing.strokes.stages import (
    BETWEEN,
    Context,
    End,
    Form,
    Meaning,
    MeaningKind,
    Outcome,
)
from physsim_ros.model.arrays import Floats
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import ChangeBody
from physsim_ros.model.transform import cross
from physsim_ros.model.translation import Text

# The least straightness of a rod and of the advance of round teeth, the greatest of a rope: the
# distance of the ends by the length. An arc as high as a seventh of its chord has 0.95.
_STRAIGHT = 0.95
# Factor on the density of a body by each line of its hatching.
_HEAVIER = 1.25


def meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield hatching, or a rod, spring or rope, with that a chain, and a wall."""
    points, ends = form.points, context.ends
    kind = None if ends is None else _joint_along(points, ends, context)
    body = bodies_under.hatched_body(context.drawn.points, context.scene)
    if kind is None and body is not None:
        lines = len(points) - 1
        yield hatching_meaning(body, lines, context, weight=form.weight)
        return
    if ends is not None and kind is not None:
        yield Meaning(
            kind=MeaningKind(kind),
            weight=form.weight * BETWEEN,
            build=partial(outcomes.join, kind, ends, context),
        )
        if kind is JointKind.ROPE:
            # No stroke tells a chain from a rope: it is offered, and never the first guess.
            build = partial(outcomes.chain, ends, context)
            yield Meaning(kind=MeaningKind.CHAIN, weight=LEAST, build=build)
    yield Meaning(
        kind=MeaningKind.WALL,
        weight=form.weight * (1.0 if kind is None else 1.0 - BETWEEN),
        build=partial(outcomes.wall, points, context),
    )


def rope_around_wheels(context: Context) -> Meaning | None:
    """Return the meaning of a line from body to body, or to the background, around a wheel."""
    start, end = context.drawn.points[[0, -1]]
    if (
        context.ends is None
        or not context.wheels
        or math.dist(start, end) <= context.settings.snap
    ):
        return None
    build = partial(outcomes.join, JointKind.ROPE, context.ends, context)
    return Meaning(kind=MeaningKind.ROPE, weight=BETWEEN, build=build)


def _joint_along(points: Floats, ends: tuple[End, End], context: Context) -> JointKind | None:
    """
    Return the kind of joint that a line would be between the bodies at its ends, if any.

    :param points: ends and bends of the line, (k, 2) float64 [m]
    """
    drawn = context.drawn.points
    distance = math.dist(drawn[0], drawn[-1])
    between = ends[1].body != WORLD
    if between and _is_toothed(context.features, points):
        return JointKind.SPRING
    if not between and not _is_held(ends[0].body, context):
        return None
    if distance < _STRAIGHT * _cubic_length(drawn):
        return JointKind.ROPE
    return JointKind.ROD if distance > _STRAIGHT * path_length(points) else None


def _is_held(body: str, context: Context) -> bool:
    """
    Return whether a line that ends on one body alone holds it.

    A line on whose end it stands is a wall, and so is one beside it, unless it hangs from that.
    """
    drawn, scene = context.drawn.points, context.scene
    for points in (drawn, drawn[::-1]):
        before, end = map(point_of, points[[-ARM, -1]])
        if body in scene.bodies_at(end):
            if not stands_on(body, end, scene):
                return True
        elif hangs_from(body, (before, end), scene, context.settings.snap):
            return True
    return False


def _is_toothed(features: Features, points: Floats) -> bool:
    """
    Return whether a line goes to and fro across its direction: sharp teeth, or round ones.

    :param points: its ends and bends
    """
    # Bends of a brace are all on one side of the straight line between its ends.
    side = np.sign(cross(points[-1] - points[0], points[1:-1] - points[0]))
    if len(side) >= FEWEST_SWINGS and bool((side[1:] == -side[:-1]).all()):
        return True
    swings = features.swings
    return swings.count > FEWEST_SWINGS and features.has_teeth and swings.steady > _STRAIGHT


def _cubic_length(points: Floats) -> float:
    """Return the length of the cubic nearest to a stroke: of the stroke without tremor [m]."""
    cubic = sum(each[:, None] * (each[:, None] * points).sum(axis=0) for each in _CUBICS)
    return path_length(np.asarray(cubic))


def _gram_polynomials(degree: int, count: int) -> list[Floats]:
    """Return polynomials that are orthonormal on evenly spaced points (Gram, 1883)."""
    share = np.linspace(-1.0, 1.0, count)
    found: list[Floats] = []
    for _ in range(degree + 1):
        power = share * found[-1] if found else np.ones(count)
        for each in found:
            power = power - each * float((each * power).sum())
        found.append(power / math.sqrt(float((power * power).sum())))
    return found


# All polynomials of at most the third degree, along a resampled stroke.
_CUBICS = _gram_polynomials(3, COUNT)


def hatching_meaning(body: str, lines: int, context: Context, *, weight: float) -> Meaning:
    """
    Return the meaning of a line as hatching.

    :param body: that the stroke lies on
    :param lines: number of lines of the hatching
    """
    return Meaning(
        kind=MeaningKind.HATCHING,
        weight=weight,
        build=partial(_make_heavier, body, lines, context),
    )


def _make_heavier(name: str, lines: int, context: Context) -> Outcome:
    body = context.scene.body(name)
    density = body.total_mass / body.shape.form.area * _HEAVIER**lines
    heavier = ChangeBody(name=name, properties=Properties(density=density))
    return Outcome(
        requests=(heavier,),
        subject=name,
        message=Text(
            '{body} is heavier by {share:.0%}: {density:.3g} kg/m²',
            body=name,
            share=_HEAVIER**lines - 1.0,
            density=density,
        ),
        outline=context.drawn.points,
    )
