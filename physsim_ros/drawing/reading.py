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

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from enum import StrEnum
import math

import numpy as np
from physsim_ros.core.errors import BadProperty, NothingThere, NotRecognised
from physsim_ros.core.joint_properties import JointKind
from physsim_ros.core.names import WORLD
from physsim_ros.core.outlines import cross
from physsim_ros.core.requests import Anchor, Axle, Configure, Delete, Join, Request
from physsim_ros.core.shapes import Point
from physsim_ros.core.snapshot import Floats
from physsim_ros.drawing import beautifying, bodies, recogniser, scribbling, snapping
from physsim_ros.drawing.recogniser import Candidate, falls, Primitive
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.drawing.stroke import bends_of, simplified, Stroke, stroke
from physsim_ros.drawing.view import DRAWN, View

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
# From so many corners on a small polygon may be a circle.
EDGED = 5
# Points of the outline of a disc that is shown.
_SHOWN = 48


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


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Drawn:
    """What is to be made of a stroke, as in `Reading`."""

    requests: tuple[Request, ...]
    subject: str
    message: str
    outline: Floats


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Sense:
    """
    A meaning that a stroke may have.

    :param meaning: what
    :param weight: how likely, before all are compared
    :param make: makes of it what it means, or raises a Refusal
    """

    meaning: Meaning
    weight: float
    make: Callable[[], Drawn]


Make = Callable[[Floats, Stroke, View, DrawingSettings], Drawn]


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
    best: Sense | None = None
    for candidate in recogniser.recognise(drawn):
        for sense in _senses(candidate, drawn, view, settings):
            weights[sense.meaning] = weights.get(sense.meaning, 0.0) + sense.weight
            if best is None or sense.weight > best.weight:
                best = sense
    total = sum(weights.values()) + DOUBT
    ranked = sorted(weights, key=lambda meaning: -weights[meaning])
    confidences = [(meaning, weights[meaning] / total) for meaning in ranked]
    if best is None or confidences[0][1] < settings.sketch_confidence:
        raise NotRecognised(_doubt(confidences[:2]), field='poses')
    made = best.make()
    following = next(
        ((other, share) for other, share in confidences if other != best.meaning), None
    )
    return Reading(
        what=best.meaning,
        confidence=weights[best.meaning] / total,
        runner_up=following[0] if following else None,
        runner_up_confidence=following[1] if following else 0.0,
        requests=made.requests,
        subject=made.subject,
        message=made.message,
        outline=made.outline,
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
    weight, points = candidate.weight, candidate.points

    def sense(meaning: Meaning, share: float, make: Callable[[], Drawn]) -> Sense:
        return Sense(meaning=meaning, weight=weight * share, make=make)

    match candidate.primitive:
        case Primitive.DISC:
            small = _smallness(_point(points[0]), math.dist(*points), view, settings)
            yield sense(Meaning.AXLE, small, lambda: _axle(points, view, settings))
            yield sense(Meaning.DISC, 1.0 - small, lambda: _disc(points, view, settings))
        case Primitive.RECTANGLE:
            yield sense(Meaning.RECTANGLE, 1.0, lambda: _rectangle(points, view, settings))
        case Primitive.POLYGON:
            center, radius = points.mean(axis=0), float(np.hypot(*np.ptp(points, axis=0))) / 3
            # Small circles come out edged.
            small = len(points) >= EDGED and _smallness(_point(center), radius, view, settings)
            yield sense(Meaning.AXLE, small, lambda: _axle(center[None], view, settings))
            yield sense(Meaning.POLYGON, 1.0 - small, lambda: _polygon(points, view, settings))
        case Primitive.LINE:
            joint = _joint_along(points, view, settings)
            if joint is not None:
                meaning, make = joint
                yield sense(meaning, BETWEEN, lambda: make(points, drawn, view, settings))
            share = 1.0 - BETWEEN if joint else 1.0
            yield sense(Meaning.WALL, share, lambda: _wall(points, drawn, view, settings))
        case Primitive.ZIGZAG | Primitive.SCRIBBLE:
            yield from _to_and_fro(candidate, drawn, view, settings)
        case Primitive.CROSS:
            under = view.bodies_at(_point(points[0]), settings.snap)
            share = 1.0 if under else MISPLACED
            yield sense(Meaning.ANCHOR, share, lambda: _anchor(points, drawn, view, settings))
        case Primitive.ARROW:
            free = not view.bodies_at(_point(points[0]))
            share = 1.0 if free else MISPLACED
            yield sense(Meaning.GRAVITY, share, lambda: _gravity(points, drawn, view, settings))


def _to_and_fro(
    candidate: Candidate, drawn: Stroke, view: View, settings: DrawingSettings
) -> Iterator[Sense]:
    """Yield what a zigzag or scribble means: a spring, a wall in the open, the end of bodies."""
    ends = drawn.points[[0, -1]]
    joined = snapping.ends_on(_point(ends[0]), _point(ends[1]), view, settings)
    over = scribbling.passed(drawn.points, view)
    covered = scribbling.bodies_under(drawn.points, over, view)
    zigzag = candidate.primitive is Primitive.ZIGZAG
    spring = 0.0
    if joined is not None and (zigzag or joined[1].body != WORLD):
        # A spring leaves the bodies that it joins; a scribble stays on them.
        spring = 1.0 - scribbling.share_under(over, joined)
        if zigzag and joined[1].body != WORLD:
            spring = max(spring, BETWEEN)
    wall = BETWEEN if zigzag and not spring and not covered else 0.0
    yield Sense(
        meaning=Meaning.SPRING,
        weight=candidate.weight * spring,
        make=lambda: _spring(ends, drawn, view, settings),
    )
    yield Sense(
        meaning=Meaning.WALL,
        weight=candidate.weight * wall,
        make=lambda: _wall(bends_of(drawn), drawn, view, settings),
    )
    yield Sense(
        meaning=Meaning.DELETION,
        weight=candidate.weight * (1.0 - spring - wall) * (1.0 if covered else MISPLACED),
        make=lambda: _deletion(covered, drawn),
    )


def _smallness(center: Point, radius: float, view: View, settings: DrawingSettings) -> float:
    """Return how much a circle looks like a sign upon the bodies under it, 0 .. 1."""
    under = view.bodies_at(center)[:2]
    if not under:
        return 0.0
    least = min(math.sqrt(view.body(name).shape.form.area) for name in under)
    limit = (SMALL if len(under) == 1 else SMALL_ON_TWO) * least
    if len(under) == 1:
        angles = np.arange(8) * math.pi / 4
        rim = np.array(center) + radius * np.column_stack((np.cos(angles), np.sin(angles)))
        inside = sum(under[0] in view.bodies_at(_point(place)) for place in rim)
        # What hangs over is a body of its own, unless it is as small as hands can draw.
        if inside < len(rim) - 1:
            limit = min(2 * settings.snap, 0.9 * least)
    return falls(2 * radius / limit, 1.0, 0.06)


def _joint_along(
    points: Floats, view: View, settings: DrawingSettings
) -> tuple[Meaning, Make] | None:
    """Return which joint a line is: a rod or a spring between bodies; None is a wall."""
    start, end = _point(points[0]), _point(points[-1])
    ends = snapping.ends_on(start, end, view, settings)
    if ends is None:
        return None
    first, last = ends
    sides = np.diff(points, axis=0)
    if math.dist(start, end) > STRAIGHT * float(np.hypot(*sides.T).sum()):
        # What only comes near to a body and ends nowhere is a wall beside it.
        if last.body != WORLD or first.body in view.bodies_at(start) + view.bodies_at(end):
            return Meaning.ROD, _rod
        return None
    turns = np.sign(cross(sides[:-1], sides[1:]))
    alternates = len(turns) >= FEWEST_TEETH and bool((turns[1:] == -turns[:-1]).all())
    return (Meaning.SPRING, _spring) if alternates and last.body != WORLD else None


def _disc(points: Floats, view: View, settings: DrawingSettings) -> Drawn:
    center, radius = _point(points[0]), math.dist(*points)
    name = f'{DRAWN}/{view.next_drawn()}'
    return Drawn(
        requests=(bodies.disc(name, center, radius, settings),),
        subject=name,
        message=f'a disc of radius {radius:.3g} m',
        outline=_circle(center, radius),
    )


def _rectangle(points: Floats, view: View, settings: DrawingSettings) -> Drawn:
    if settings.beautify == 0.0:
        return _polygon(points, view, settings)
    name = f'{DRAWN}/{view.next_drawn()}'
    pose, width, height = beautifying.rectangle(points, settings.beautify)
    x, y, yaw = pose
    along = np.array((math.cos(yaw), math.sin(yaw))) * width / 2
    across = np.array((-math.sin(yaw), math.cos(yaw))) * height / 2
    corners = np.array((-along - across, along - across, along + across, across - along))
    return Drawn(
        requests=(bodies.rectangle(name, pose, width, height, settings),),
        subject=name,
        message=f'a rectangle of {width:.3g} m by {height:.3g} m',
        outline=_around(np.array((x, y)) + corners),
    )


def _polygon(points: Floats, view: View, settings: DrawingSettings) -> Drawn:
    name = f'{DRAWN}/{view.next_drawn()}'
    corners = beautifying.polygon(points, settings.beautify)
    return Drawn(
        requests=(bodies.polygon(name, list(map(_point, corners)), settings),),
        subject=name,
        message=f'a polygon of {len(corners)} corners',
        outline=_around(corners),
    )


def _wall(points: Floats, drawn: Stroke, view: View, settings: DrawingSettings) -> Drawn:
    name = f'{DRAWN}/{view.next_drawn()}'
    # What sides do not explain is a curve, and is kept as one.
    curved = simplified(drawn, points)
    way = beautifying.line(points, settings.beautify) if curved is None else curved
    corners = list(map(_point, way))
    corners[0] = snapping.wall_end(corners[0], view, settings)
    corners[-1] = snapping.wall_end(corners[-1], view, settings)
    length = sum(map(math.dist, corners, corners[1:]))
    return Drawn(
        requests=(bodies.wall(name, corners, settings),),
        subject=name,
        message=f'a wall of {length:.3g} m',
        outline=np.array(corners),
    )


def _rod(points: Floats, _drawn: Stroke, view: View, settings: DrawingSettings) -> Drawn:
    return _join(JointKind.ROD, points, None, view, settings)


def _spring(ends: Floats, drawn: Stroke, view: View, settings: DrawingSettings) -> Drawn:
    return _join(JointKind.SPRING, ends, drawn, view, settings)


def _join(
    kind: JointKind, points: Floats, drawn: Stroke | None, view: View, settings: DrawingSettings
) -> Drawn:
    """Join what lies at both ends; show the stroke, or a straight line where there is none."""
    joined = snapping.ends_on(_point(points[0]), _point(points[-1]), view, settings)
    if joined is None:
        raise NothingThere(
            f'a {kind} joins two bodies, one of which moves; there are none at its ends',
            field='poses',
        )
    first, last = joined
    name = f'{DRAWN}/{view.next_joint()}'
    ends = first.point, last.point
    return Drawn(
        requests=(Join(name=name, kind=kind, points=ends, a=first.body, b=last.body),),
        subject=name,
        message=f'a {kind} from {first.body} to {last.body}',
        outline=np.array(ends) if drawn is None else drawn.points,
    )


def _axle(points: Floats, view: View, settings: DrawingSettings) -> Drawn:
    center = snapping.pivot(_point(points[0]), view, settings)
    under = view.bodies_at(center)[:2]
    between = ' and '.join(under) if len(under) == 2 else f'{under[0]} and the background'
    return Drawn(
        requests=(Axle(point=center),),
        subject=under[0],
        message=f'an axle between {between}',
        outline=_circle(center, settings.snap / 2 if len(points) < 2 else math.dist(*points)),
    )


def _anchor(points: Floats, drawn: Stroke, view: View, settings: DrawingSettings) -> Drawn:
    point = _point(points[0])
    under = view.bodies_at(point)
    if not under:
        # Drawn a little beside a thin body; the nearest thing that is under the pen.
        under = view.bodies_at(point, settings.snap)
        way = map(_point, drawn.points if under else ())
        near = [each for each in way if under[0] in view.bodies_at(each)]
        if not near:
            x, y = point
            raise NothingThere(
                f'an x anchors the body under it; there is none at ({x:.3g}, {y:.3g})',
                field='poses',
            )
        point = min(near, key=lambda each: math.dist(each, point))
    return Drawn(
        requests=(Anchor(point=point),),
        subject=under[0],
        message=f'anchor {under[0]}',
        outline=drawn.points,
    )


def _gravity(points: Floats, drawn: Stroke, view: View, settings: DrawingSettings) -> Drawn:
    tail = view.bodies_at(_point(points[0]))
    if tail:
        raise NotRecognised(
            f'an arrow in free space turns gravity; this one begins on {tail[0]}', field='poses'
        )
    strength = math.hypot(*view.settings.gravity)
    if strength == 0.0:
        raise BadProperty(
            'there is no gravity to turn; set the parameter gravity first', field='gravity'
        )
    tip = beautifying.line(points, settings.beautify)
    x, y = (tip[1] - tip[0]).tolist()
    length = math.hypot(x, y)
    gravity = strength * x / length, strength * y / length
    return Drawn(
        requests=(Configure(changes={'gravity': gravity}),),
        subject='',
        message=f'gravity towards ({gravity[0]:.3g}, {gravity[1]:.3g}) m/s²',
        outline=drawn.points,
    )


def _deletion(covered: tuple[str, ...], drawn: Stroke) -> Drawn:
    if not covered:
        raise NothingThere('a scribble deletes the bodies under it; there are none', field='poses')
    return Drawn(
        requests=tuple(Delete(name=name) for name in covered),
        subject=covered[0] if len(covered) == 1 else '',
        message=f'delete {", ".join(covered)}',
        outline=drawn.points,
    )


def _circle(center: Point, radius: float) -> Floats:
    angles = np.linspace(0.0, 2 * math.pi, _SHOWN + 1)
    circle: Floats = np.array(center) + radius * np.column_stack((np.cos(angles), np.sin(angles)))
    return circle


def _around(corners: Floats) -> Floats:
    return np.vstack((corners, corners[:1]))


def _point(row: Floats) -> Point:
    x, y = row.tolist()
    return x, y
