# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
What a stroke means where it lies: requests that make the world as it was drawn.

Law: reading changes nothing; what it returns are ordinary requests, for somebody to submit.

What a stroke looks like has a weight, and the world around it divides that weight among what it
may mean there. The confidence in a meaning is its share of all weights and of a doubt.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from enum import StrEnum
import math

import numpy as np
from physsim_ros.drawing import snapping
from physsim_ros.drawing.scene_query import View
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.strokes import overlap, recogniser, request_builder
from physsim_ros.drawing.strokes.hypothesis import Candidate, falls, LEAST, Primitive
from physsim_ros.drawing.strokes.request_builder import Make, point_of
from physsim_ros.drawing.strokes.stroke import Stroke, stroke
from physsim_ros.model.arrays import Floats
from physsim_ros.model.errors import NotRecognised
from physsim_ros.model.names import WORLD
from physsim_ros.model.requests import Request
from physsim_ros.model.transform import cross, Point

# The weight of its being nothing of all this.
DOUBT = 0.12
# Of what does not fit where it was drawn: it yields to any other reading of nearly that weight.
MISPLACED = 0.5
# What is smaller than these shares of a body, the side of a square as large, is a sign upon it:
# on one body; on two that overlap.
SMALL, SMALL_ON_TWO = 0.5, 0.75
# The share of a line between two bodies that is a joint, not a wall; how straight a rod is, by its
# ends' distance and its length; and how often a line turns to be a spring.
BETWEEN, STRAIGHT, FEWEST_TEETH = 0.9, 0.95, 3
# What lies on the bodies at its ends by more than that share is no spring between them.
LEAVING = 0.6
# From so many corners on a small polygon may be a circle.
EDGED = 5


class Meaning(StrEnum):
    """What a stroke can mean."""

    DISC = 'disc'
    RECTANGLE = 'rectangle'
    POLYGON = 'polygon'
    WALL = 'wall'
    ROD = 'rod'
    SPRING = 'spring'
    ANCHOR = 'anchor'
    AXLE = 'axle'
    GRAVITY = 'gravity'
    DELETION = 'deletion'


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reading:
    """
    What a stroke was read as.

    :param what: the meaning
    :param confidence: in it, 0 .. 1
    :param runner_up: the next likely meaning; None where there is no other
    :param runner_up_confidence: in that, 0 .. 1
    :param requests: what to submit, in this order
    :param subject: the body or joint concerned; '' where there is none or there are several
    :param message: a sentence that says what is to be done
    :param outline: (n, 2) float64: the beautified stroke, to be shown; the first point repeated
        where it is closed [m]
    """

    what: Meaning
    confidence: float
    runner_up: Meaning | None
    runner_up_confidence: float
    requests: tuple[Request, ...]
    subject: str
    message: str
    outline: Floats

    @property
    def values(self) -> tuple[tuple[str, str], ...]:
        """Return what was read, and what else it may have been, as pairs of key and value."""
        ranked = [(self.what, self.confidence)]
        if self.runner_up is not None:
            ranked.append((self.runner_up, self.runner_up_confidence))
        return _values(ranked)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Sense:
    """
    A meaning that a stroke may have.

    :param meaning: what
    :param weight: how likely, before all are compared
    :param make: makes of it what it means, or raises a Refusal
    :param points: that it is made of
    """

    meaning: Meaning
    weight: float
    make: Make
    points: Floats


def read(samples: Floats, view: View, settings: DrawingSettings) -> Reading:
    """
    Read a stroke.

    :param samples: (n, 2) float64: the pen's positions in the world, in order [m]; or (n, 3), the
        third column the time of each, which puts them in order where it differs
    :param view: the world it was drawn in
    :param settings: of drawing
    :raises Malformed: there are no samples, or one is not finite
    :raises BadSize: the stroke is too small to be anything, or too large
    :raises BadOutline: what it means cannot be simulated
    :raises NothingThere: it is a sign for a body, and there is none
    :raises NotRecognised: it might be anything; the sentence says what was thought of
    """
    drawn = stroke(samples)
    weights: dict[Meaning, float] = {}
    # The likeliest sense of each meaning.
    best: dict[Meaning, Sense] = {}
    for candidate in recogniser.recognise(drawn):
        for sense in _senses(candidate, drawn, view, settings):
            if sense.weight < LEAST:
                continue
            weights[sense.meaning] = weights.get(sense.meaning, 0.0) + sense.weight
            if sense.meaning not in best or sense.weight > best[sense.meaning].weight:
                best[sense.meaning] = sense
    total = sum(weights.values()) + DOUBT
    ranked = sorted(weights, key=lambda meaning: -weights[meaning])
    confidences = [(meaning, weights[meaning] / total) for meaning in ranked]
    if not confidences or confidences[0][1] < settings.sketch_confidence:
        raise NotRecognised(
            _doubt(confidences[:2]), field='poses', values=_values(confidences[:2])
        )
    (what, confidence), *others = confidences
    sense = best[what]
    made = sense.make(sense.points, drawn, view, settings)
    runner_up, runner_up_confidence = others[0] if others else (None, 0.0)
    return Reading(
        what=what,
        confidence=confidence,
        runner_up=runner_up,
        runner_up_confidence=runner_up_confidence,
        requests=made.requests,
        subject=made.subject,
        message=made.message,
        outline=made.outline,
    )


def _values(ranked: Sequence[tuple[Meaning, float]]) -> tuple[tuple[str, str], ...]:
    """Return meanings and confidences in them, the likeliest first, as pairs of key and value."""
    keys = (('reading', 'confidence'), ('runner_up', 'runner_up_confidence'))
    return tuple(
        pair
        for (name, share), (meaning, confidence) in zip(keys, ranked, strict=False)
        for pair in ((name, str(meaning)), (share, f'{confidence:.3f}'))
    )


def _doubt(confidences: list[tuple[Meaning, float]]) -> str:
    """Return the sentence about a stroke that was not recognised."""
    if not confidences:
        return 'the stroke looks like nothing that can be drawn'
    words = ' or '.join(f'{meaning} ({share:.0%})' for meaning, share in confidences)
    return f'the stroke is not clear enough; it might be: {words}. Nothing was drawn'


def _senses(
    candidate: Candidate, drawn: Stroke, view: View, settings: DrawingSettings
) -> Iterator[Sense]:
    """Yield what a candidate may mean, its weight divided among the meanings."""
    points = candidate.points

    def sense(meaning: Meaning, share: float, make: Make, of: Floats = points) -> Sense:
        return Sense(meaning=meaning, weight=candidate.weight * share, make=make, points=of)

    match candidate.primitive:
        case Primitive.DISC:
            small = _smallness(point_of(points[0]), math.dist(*points), view, settings)
            yield sense(Meaning.AXLE, small, request_builder.axle)
            yield sense(Meaning.DISC, 1.0 - small, request_builder.disc)
        case Primitive.RECTANGLE:
            yield sense(Meaning.RECTANGLE, 1.0, request_builder.rectangle)
        case Primitive.POLYGON:
            center, radius = points.mean(axis=0), float(np.hypot(*np.ptp(points, axis=0))) / 3
            # Small circles come out edged.
            small = _smallness(point_of(center), radius, view, settings, corners=len(points))
            yield sense(Meaning.AXLE, small, request_builder.axle, np.array((center, points[0])))
            yield sense(Meaning.POLYGON, 1.0 - small, request_builder.polygon)
        case Primitive.LINE:
            meaning, make, share = _joint_along(points, view, settings)
            yield sense(meaning, share, make)
            yield sense(Meaning.WALL, 1.0 - share, request_builder.wall)
        case Primitive.ZIGZAG | Primitive.SCRIBBLE:
            zigzag = candidate.primitive is Primitive.ZIGZAG
            spring, wall, deletion = _to_and_fro(drawn, view, settings, zigzag=zigzag)
            yield sense(Meaning.SPRING, spring, request_builder.spring, drawn.points[[0, -1]])
            yield sense(Meaning.WALL, wall, request_builder.bent_wall)
            yield sense(Meaning.DELETION, deletion, request_builder.deletion)
        case Primitive.CROSS:
            under = view.bodies_at(point_of(points[0]), settings.snap)
            yield sense(Meaning.ANCHOR, 1.0 if under else MISPLACED, request_builder.anchor)
        case Primitive.ARROW:
            free = not view.bodies_at(point_of(points[0]))
            yield sense(Meaning.GRAVITY, 1.0 if free else MISPLACED, request_builder.gravity)


def _to_and_fro(
    drawn: Stroke, view: View, settings: DrawingSettings, *, zigzag: bool
) -> tuple[float, float, float]:
    """Return how much of a zigzag or scribble is a spring, a wall in the open, a deletion."""
    start, end = point_of(drawn.points[0]), point_of(drawn.points[-1])
    joined = snapping.ends_on(start, end, view, settings)
    over = overlap.passed(drawn.points, view)
    covered = overlap.bodies_under(drawn.points, over, view)
    spring = 0.0
    # A scribble may begin on one body and end on another that it is meant for as well.
    if joined is not None and (zigzag or (joined[1].body != WORLD and not covered)):
        # A spring leaves the bodies that it joins; a scribble stays on them.
        share = overlap.share_under(over, joined)
        between = zigzag and joined[1].body != WORLD
        spring = falls(share, LEAVING, 0.03) if between else 1.0 - share
    wall = BETWEEN if zigzag and not spring and not covered else 0.0
    return spring, wall, (1.0 - spring - wall) * (1.0 if covered else MISPLACED)


def _smallness(
    center: Point, radius: float, view: View, settings: DrawingSettings, *, corners: int = EDGED
) -> float:
    """Return how much a circle looks like a sign upon the bodies under it, 0 .. 1."""
    under = view.bodies_at(center)[:2]
    if not under or corners < EDGED:
        return 0.0
    least = min(math.sqrt(view.body(name).shape.form.area) for name in under)
    limit = (SMALL if len(under) == 1 else SMALL_ON_TWO) * least
    if len(under) == 1:
        angles = np.arange(8) * math.pi / 4
        rim = np.array(center) + radius * np.column_stack((np.cos(angles), np.sin(angles)))
        inside = np.count_nonzero(view.covers(under[0], rim))
        # What hangs over is a body of its own, unless it is as small as hands can draw.
        if inside < len(rim) - 1:
            limit = min(2 * settings.snap, 0.9 * least)
    return falls(2 * radius / limit, 1.0, 0.06)


def _joint_along(
    points: Floats, view: View, settings: DrawingSettings
) -> tuple[Meaning, Make, float]:
    """Return which joint a line would be, a rod or a spring, and how likely it is no wall."""
    start, end = point_of(points[0]), point_of(points[-1])
    ends = snapping.ends_on(start, end, view, settings)
    sides = np.diff(points, axis=0)
    between = ends is not None and ends[1].body != WORLD
    if math.dist(start, end) > STRAIGHT * float(np.hypot(*sides.T).sum()):
        # What only comes near to a body and ends nowhere is a wall beside it.
        hung = ends is not None and ends[0].body in view.bodies_at(start) + view.bodies_at(end)
        return Meaning.ROD, request_builder.rod, BETWEEN if between or hung else 0.0
    turns = np.sign(cross(sides[:-1], sides[1:]))
    teeth = len(turns) >= FEWEST_TEETH and bool((turns[1:] == -turns[:-1]).all())
    return Meaning.SPRING, request_builder.spring, BETWEEN if between and teeth else 0.0
