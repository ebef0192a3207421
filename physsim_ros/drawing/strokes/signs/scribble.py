# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The scribble: deletes the bodies under it, or is a tangled spring between two bodies."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from physsim_ros.drawing.strokes import overlap, request_builder, snapping
from physsim_ros.drawing.strokes.evidence import Candidate
from physsim_ros.drawing.strokes.features import Features
from physsim_ros.drawing.strokes.hypothesis import falls, Hypothesis
from physsim_ros.drawing.strokes.meanings import (
    Context,
    DELETION,
    Interpretation,
    MISPLACED,
    Outcome,
)
from physsim_ros.model.errors import NothingThere
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import Delete

PRIMITIVE = 'scribble'
# The least number of swings: people make six and more.
_FEWEST = 6
# The greatest spread of swings: those of zigzags lie farther apart.
_FARTHEST = 1.15
# The greatest share of the middle half of a spring that lies on the bodies at its ends: a scribble
# over two bodies side by side has 0.3 and more.
_MIDDLE_ON_ENDS = 0.15


def candidates(features: Features) -> Iterator[Candidate]:
    """Yield swings, or loops, that hardly advance; the points are all of it."""
    if features.swings.count >= _FEWEST and features.swings.spread < _FARTHEST:
        yield Candidate(measures=features.measures, points=features.stroke.points)


def interpretations(hypothesis: Hypothesis, context: Context) -> Iterator[Interpretation]:
    """Yield spring and deletion."""
    ends = snapping.joint_ends(hypothesis.points, context)
    crossed = overlap.crossed_bodies(context.drawn.points, context.scene)
    covered = overlap.covered_bodies(context.drawn.points, crossed, context.scene)
    spring = 0.0
    # The ends of a deletion may lie on two bodies too, but then its middle also lies on bodies.
    if ends is not None and ends[1].body != WORLD:
        others = set(covered) - {end.body for end in ends}
        middle = 1.0 if others else overlap.middle_share_on(crossed, ends)
        spring = falls(middle, _MIDDLE_ON_ENDS, 0.03)
    yield Interpretation(
        meaning='spring',
        weight=hypothesis.weight * spring,
        build=partial(request_builder.join, JointKind.SPRING, hypothesis.points, context),
    )
    yield Interpretation(
        meaning=DELETION,
        weight=hypothesis.weight * (1.0 - spring) * (1.0 if covered else MISPLACED),
        build=partial(_delete_bodies, covered, context),
    )


def _delete_bodies(covered: tuple[str, ...], context: Context) -> Outcome:
    if not covered:
        raise NothingThere('a scribble deletes the bodies under it; there are none', field='poses')
    return Outcome(
        requests=tuple(Delete(name=name) for name in covered),
        subject=covered[0] if len(covered) == 1 else '',
        message=f'delete {", ".join(covered)}',
        outline=context.drawn.points,
    )
