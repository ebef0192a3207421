# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Swings to and fro: a zigzag is a spring or a bent wall, a scribble deletes the bodies under it.

A scribble between two bodies is a tangled spring.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from physsim_ros.drawing.strokes import bodies_under, open_lines, outcomes
from physsim_ros.drawing.strokes.evidence import Limit
from physsim_ros.drawing.strokes.features import Features, FEWEST_SWINGS
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
from physsim_ros.model.errors import NothingThere
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import Delete
from physsim_ros.model.translation import Text

# The least spread of swings: those of scribbles lie closer.
_CLOSEST = 0.9
# The share of the stroke that lies on the bodies at its ends from which on it is no spring.
_ON_ENDS = Limit(0.6)
# The least number of swings of a scribble: people make six and more.
_FEWEST_OF_SCRIBBLE = 6
# The greatest spread of swings: those of zigzags lie farther apart.
_FARTHEST = 1.15
# The greatest share of the middle half of a spring that lies on the bodies at its ends: a scribble
# over two bodies side by side has 0.3 and more.
_MIDDLE_ON_ENDS = Limit(0.15)


def _zigzag_candidates(features: Features) -> Iterator[Candidate]:
    """Yield teeth in a row, sharp or round; the points are its ends and bends."""
    swings = features.swings
    if swings.count >= FEWEST_SWINGS and features.has_teeth and swings.spread > _CLOSEST:
        yield Candidate(measures=features.measures, points=features.bends)


def _zigzag_meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield hatching, spring and wall."""
    drawn, ends, weight = context.drawn, context.ends, form.weight
    body = bodies_under.hatched_body(drawn.points, context.scene)
    if body is not None and (ends is None or ends[1].body == WORLD):
        lines = len(form.points) - 1
        yield open_lines.hatching_meaning(body, lines, context, weight=weight)
        return
    spring = 0.0
    if ends is not None:
        # A spring leaves the bodies that it joins.
        crossed = bodies_under.crossed_bodies(drawn.points, context.scene)
        share = bodies_under.share_on(crossed, ends)
        spring = _ON_ENDS.below(share) if ends[1].body != WORLD else 1.0 - share
        build = partial(outcomes.join, JointKind.SPRING, ends, context)
        yield Meaning(kind=MeaningKind.SPRING, weight=weight * spring, build=build)
    yield Meaning(
        kind=MeaningKind.WALL,
        weight=weight * (1.0 - spring),
        build=partial(outcomes.wall, form.points, context),
    )


def _scribble_candidates(features: Features) -> Iterator[Candidate]:
    """Yield swings, or loops, that hardly advance; the points are all of it."""
    if features.swings.count >= _FEWEST_OF_SCRIBBLE and features.swings.spread < _FARTHEST:
        yield Candidate(measures=features.measures, points=features.stroke.points)


def _scribble_meanings(form: Form, context: Context) -> Iterator[Meaning]:
    """Yield spring and deletion."""
    ends = context.ends
    crossed = bodies_under.crossed_bodies(context.drawn.points, context.scene)
    covered = bodies_under.covered_bodies(context.drawn.points, crossed, context.scene)
    spring = 0.0
    # The ends of a deletion may lie on two bodies too, but then its middle also lies on bodies.
    if ends is not None and ends[1].body != WORLD:
        others = set(covered) - {end.body for end in ends}
        middle = 1.0 if others else bodies_under.middle_share_on(crossed, ends)
        spring = _MIDDLE_ON_ENDS.below(middle)
        build = partial(outcomes.join, JointKind.SPRING, ends, context)
        yield Meaning(kind=MeaningKind.SPRING, weight=form.weight * spring, build=build)
    yield Meaning(
        kind=MeaningKind.DELETION,
        weight=form.weight * (1.0 - spring) * (1.0 if covered else MISPLACED),
        build=partial(_delete_bodies, covered, context),
    )


def _delete_bodies(covered: tuple[str, ...], context: Context) -> Outcome:
    if not covered:
        raise NothingThere('a scribble deletes the bodies under it; there are none', field='poses')
    return Outcome(
        requests=tuple(Delete(name=name) for name in covered),
        subject=covered[0] if len(covered) == 1 else '',
        message=Text('delete {bodies}', bodies=', '.join(covered)),
        outline=context.drawn.points,
    )


ZIGZAG = Sign(name='zigzag', candidates=_zigzag_candidates, meanings=_zigzag_meanings)
SCRIBBLE = Sign(name='scribble', candidates=_scribble_candidates, meanings=_scribble_meanings)
