# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The zigzag: a spring between the bodies at its ends, else a bent wall."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial

from physsim_ros.drawing.strokes import overlap, request_builder, snapping
from physsim_ros.drawing.strokes.corner_detection import bends_of
from physsim_ros.drawing.strokes.evidence import Candidate
from physsim_ros.drawing.strokes.features import Features, FEWEST
from physsim_ros.drawing.strokes.hypothesis import falls, Hypothesis
from physsim_ros.drawing.strokes.meanings import Context, Interpretation
from physsim_ros.drawing.strokes.signs import hatching
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD

PRIMITIVE = 'zigzag'
# The height of the swings of a trembling hand, in shares of the size.
_TREMOR = 0.05
# The least spread of swings: those of scribbles lie closer.
_CLOSEST = 0.9
# The share of the stroke that lies on the bodies at its ends from which on it is no spring.
_ON_ENDS = 0.6


def candidates(features: Features) -> Iterator[Candidate]:
    """Yield teeth in a row, sharp or round; the points are the two ends."""
    swings, stroke = features.swings, features.stroke
    high = swings.height > _TREMOR * stroke.size
    if swings.count >= FEWEST and high and swings.spread > _CLOSEST:
        yield Candidate(measures=features.measures, points=stroke.points[[0, -1]])


def interpretations(hypothesis: Hypothesis, context: Context) -> Iterator[Interpretation]:
    """Yield hatching, spring and wall."""
    drawn, weight = context.drawn, hypothesis.weight
    ends = snapping.joint_ends(hypothesis.points, context)
    spring = 0.0
    if ends is not None:
        # A spring leaves the bodies that it joins.
        crossed = overlap.crossed_bodies(drawn.points, context.scene)
        share = overlap.share_on(crossed, ends)
        spring = falls(share, _ON_ENDS, 0.03) if ends[1].body != WORLD else 1.0 - share
    body = hatching.hatched_body(context)
    if body is not None and (ends is None or ends[1].body == WORLD):
        lines = len(bends_of(drawn.points)) - 1
        yield hatching.interpretation(body, lines, context, weight=weight)
        return
    yield Interpretation(
        meaning='spring',
        weight=weight * spring,
        build=partial(request_builder.join, JointKind.SPRING, hypothesis.points, context),
    )
    yield Interpretation(
        meaning='wall',
        weight=weight * (1.0 - spring),
        build=lambda: request_builder.wall(bends_of(drawn.points), context),
    )
