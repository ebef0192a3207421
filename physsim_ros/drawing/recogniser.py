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
What a stroke looks like: every primitive that it could be, with a weight.

Law: nothing is decided here. A stroke is told by what it looks like and by where it lies, and the
second is for `reading`.

A weight is a product of soft conditions, each half fulfilled at its limit. The limits lie between
what hands draw; `make evaluate` shows how well.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from enum import StrEnum
import itertools
import math

import numpy as np
from physsim_ros.core import outlines
from physsim_ros.core.outlines import cross
from physsim_ros.core.snapshot import Floats
from physsim_ros.drawing import stroke as strokes
from physsim_ros.drawing.stroke import Stroke

# Weights below are not worth telling.
LEAST = 0.04
# No arrow's ends come so near to each other, in shares of its length.
CLOSED = 0.1
# The longest loop that is a slip, in shares of the length.
SLIP = 0.15
# So many corners that are all alike are a circle's samples; the weight of an outline of no shape.
MANY, BLOB = 9, 0.8
# Points that do not count where it is asked how far a stroke reaches.
FRINGE = 4
# Fewer swings are not measured.
FEWEST = 3
# Directions in which swings to and fro are looked for.
_ANGLES = np.arange(12) * math.pi / 12
_DIRECTIONS = np.column_stack((np.cos(_ANGLES), np.sin(_ANGLES)))
# The pairs of every third step that may cross: not neighbours, nor their neighbours.
_PAIRS = np.triu_indices(len(range(0, strokes.COUNT, 3)) - 1, 3)

# Where a way crosses itself [m], and after how many points it is there, first and last.
Crossing = tuple[Floats, float, float]


class Primitive(StrEnum):
    """What a stroke can look like."""

    DISC = 'disc'
    RECTANGLE = 'rectangle'
    POLYGON = 'polygon'
    LINE = 'line'
    ZIGZAG = 'zigzag'
    CROSS = 'x'
    ARROW = 'arrow'
    SCRIBBLE = 'scribble'


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Candidate:
    """
    What a stroke could be.

    :param primitive: what
    :param weight: how well it looks like that, 0 .. 1
    :param points: (n, 2) float64, in the world [m]: of a disc, its centre and a point on its rim;
        of a rectangle or polygon, the corners; of a line, ends and bends; of a zigzag, its ends;
        of an x, where its lines cross; of an arrow, tail and tip; of a scribble, its way
    """

    primitive: Primitive
    weight: float
    points: Floats


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Swings:
    """
    How a stroke goes to and fro.

    :param count: of swings
    :param height: of a swing, across the advance, mean [m]; 0 where they are few, as what follows
    :param advance: over all swings, in heights of one
    :param steady: how straight the advance is, 0 .. 1
    """

    count: int
    height: float
    advance: float
    steady: float


def rises(value: float, limit: float, width: float) -> float:
    """Return a soft condition: 0 far below a limit, a half there, 1 far above."""
    return 1.0 / (1.0 + math.exp(min(max((limit - value) / width, -50.0), 50.0)))


def falls(value: float, limit: float, width: float) -> float:
    """Return a soft condition: 1 far below a limit, a half there, 0 far above."""
    return rises(-value, -limit, width)


def recognise(stroke: Stroke) -> tuple[Candidate, ...]:
    """Return all that a stroke could be, the most likely first."""
    swings = swings_of(stroke.points)
    crossings = crossings_of(stroke.points)
    signs = [
        _zigzag(stroke, swings),
        _scribble(stroke, swings),
        _cross(stroke, crossings),
        _arrow(stroke, swings),
    ]
    # Every sign is also some line or outline; what looks like a sign is meant as one.
    plain = 1.0 - max(each.weight for each in signs)
    shapes = [
        *_line(stroke, swings, crossings, plain),
        *_closed(stroke, swings, plain),
    ]
    likely = (each for each in (*signs, *shapes) if each.weight >= LEAST)
    return tuple(sorted(likely, key=lambda each: -each.weight))


def swings_of(points: Floats) -> Swings:
    """Return how a way goes to and fro, in the direction in which it does so most often."""
    across = points @ _DIRECTIONS.T
    ordered = np.sort(across, axis=0)
    # The outermost points may be slips.
    low, high = ordered[FRINGE], ordered[-1 - FRINGE]
    extent = np.maximum(high - low, 1e-12)
    place = (across - low) / extent
    side = np.where(place > 0.64, 1, np.where(place < 0.36, -1, 0))
    # Between the sides it belongs to the one that it was on last.
    rows = np.maximum.accumulate(np.where(side != 0, np.arange(len(points))[:, None], 0), axis=0)
    side = np.take_along_axis(side, rows, axis=0)
    changes = side[1:] * side[:-1] < 0
    # Of directions in which it swings as often, that in which it does so least far.
    best = int((changes.sum(axis=0) - extent / extent.max() / 2).argmax())
    if changes[:, best].sum() < FEWEST:
        return Swings(count=int(changes[:, best].sum()), height=0.0, advance=0.0, steady=0.0)
    bounds = [0, *(np.flatnonzero(changes[:, best]) + 1).tolist(), len(points)]
    out = place[:, best] * side[:, best]
    peaks = [a + int(out[a:b].argmax()) for a, b in itertools.pairwise(bounds)]
    strides = np.diff(points[peaks], axis=0)
    # Two swings are one to and one fro; what remains of them is advance.
    advances = strides[1:] + strides[:-1]
    way = advances.sum(axis=0)
    whole, steps = float(np.hypot(*way)), float(np.hypot(*advances.T).sum())
    height = float(np.abs(cross(strides, way / max(whole, 1e-12))).mean())
    return Swings(
        count=len(strides),
        height=height,
        advance=whole / 2 / len(advances) * len(strides) / max(height, 1e-12),
        steady=whole / max(steps, 1e-12),
    )


def _closed(stroke: Stroke, swings: Swings, plain: float) -> Iterator[Candidate]:
    """Yield disc, rectangle and polygon."""
    closed = plain * falls(stroke.gap, 0.13, 0.01) * falls(swings.count, 4.5, 0.25)
    if stroke.outline is None or closed < LEAST:
        return
    center, radius, error, aspect = roundness(stroke.outline)
    outline, narrow = strokes.widened(stroke.outline)
    at = strokes.corners(outline, closed=True, gap=stroke.gap)
    found = strokes.vertices(outline, at, closed=True) @ narrow
    simple = len(at) >= 3 and not outlines.crosses_itself(found)
    # What sides leave unexplained, beside what a circle does; a hexagon's is a fifth.
    size = float(np.hypot(*np.ptp(outline, axis=0)))
    left = strokes.side_error(outline, at) / size if len(at) >= 3 else 1.0
    once = _once_around(outline)
    bend = strokes.turns(strokes.smoothed(outline, 2.5, closed=True), 6, closed=True)
    sharpness = float(np.sort(np.abs(bend))[-8:].mean() / np.abs(bend).mean())
    ratio = math.log(max(left, 1e-6) / max(error, 1e-6) / 0.19)
    evidence = ratio + 1.5 * math.log(2.25 / sharpness)
    round_ = rises(evidence, 0.0, 0.3) * rises(aspect, 0.55, 0.04)
    if len(at) >= MANY and outlines.is_convex(_counterclockwise(found)):
        # Nobody draws so many equal corners: they are the samples of a quick circle.
        round_ = max(round_, falls(error, 0.04, 0.004))
    disc = closed * once * round_ * falls(error, 0.085, 0.015)
    sided = closed * (1.0 - round_) * falls(left, 0.022, 0.003) if simple else 0.0
    # Thinner than that it is a line, drawn to and fro.
    broad = rises(aspect, 0.02, 0.003)
    square = squareness(found) if len(at) == 4 else 0.0
    rim = center + np.array((radius, 0.0))
    yield Candidate(primitive=Primitive.DISC, weight=disc, points=np.array((center, rim)))
    yield Candidate(primitive=Primitive.RECTANGLE, weight=broad * sided * square, points=found)
    blob = BLOB * (closed - disc - sided) * once
    sided *= 1.0 - square
    if blob > max(sided, LEAST):
        # Neither round nor sided: any other outline, as it was drawn.
        found = strokes.traced(stroke.outline)
        sided = 0.0 if outlines.crosses_itself(found) else blob
    yield Candidate(primitive=Primitive.POLYGON, weight=broad * sided, points=found)


def _counterclockwise(found: Floats) -> Floats:
    return found if outlines.signed_area(found) > 0 else found[::-1]


def roundness(outline: Floats) -> tuple[Floats, float, float, float]:
    """
    Tell how round a closed way is.

    :return: its centre; its mean radius [m]; how much the radius varies once the ellipse that it
        might be is stretched to a circle, as a share; the ellipse's lesser axis by its greater
    """
    following = np.roll(outline, -1, axis=0)
    base = outline.mean(axis=0)
    weight = cross(outline - base, following - base)
    area = float(weight.sum()) / 2
    center = base
    if abs(area) > 1e-6 * float((np.ptp(outline, axis=0) ** 2).sum()):
        center = base + ((outline + following - 2 * base) * weight[:, None]).sum(axis=0) / 6 / area
    away = outline - center
    squares, axes = np.linalg.eigh(away.T @ away / len(away))
    scales = np.sqrt(np.maximum(squares, 1e-18 * squares[1]))
    radii = np.hypot(*(away @ axes / scales).T)
    radius = math.sqrt(abs(area) / math.pi)
    return center, radius, float(radii.std() / radii.mean()), float(scales[0] / scales[1])


def squareness(found: Floats) -> float:
    """Return how much four corners look like a rectangle's, 0 .. 1."""
    nearest = strokes.rectangle(found)
    sides = np.roll(found, -1, axis=0) - found
    lengths = np.hypot(*(np.roll(nearest, -1, axis=0) - nearest).T)
    off = float(np.hypot(*(nearest - found).T).mean() / lengths.mean())
    slants = np.abs(np.abs(_angles(np.roll(sides, 1, axis=0), sides)) - math.pi / 2)
    # A short side's direction is hard to draw; its ends are not.
    slant = float(slants.mean()) * min(1.0, float(lengths.min() / lengths.max()) / 0.3)
    return falls(off, 0.115, 0.01) * falls(slant, 0.3, 0.02)


def _once_around(outline: Floats) -> float:
    """Return how much a way looks like going round once."""
    steps = np.roll(outline, -4, axis=0) - outline
    turn = float(_angles(steps, np.roll(steps, -4, axis=0)).sum()) / 4 / (2 * math.pi)
    return falls(abs(abs(turn) - 1.0), 0.4, 0.05)


def _line(
    stroke: Stroke, swings: Swings, crossings: list[Crossing], plain: float
) -> Iterator[Candidate]:
    """Yield a line, straight, bent or curved, that does not cross itself."""
    points = stroke.points
    straight = float(np.hypot(*(points[-1] - points[0]))) / stroke.length
    calm = max(
        falls(swings.count, 4.5, 0.25),
        rises(straight, 0.9, 0.02),
        falls(swings.height / stroke.size, 0.06, 0.006),
    )
    # Small loops are slips at a bend, or where the pen was set down.
    loops = sum(last - first > SLIP * len(points) for _, first, last in crossings)
    weight = plain * calm * rises(stroke.gap, 0.13, 0.01) * falls(loops, 0.5, 0.2)
    if weight >= LEAST:
        yield Candidate(primitive=Primitive.LINE, weight=weight, points=strokes.bends_of(stroke))


def _zigzag(stroke: Stroke, swings: Swings) -> Candidate:
    weight = (
        rises(swings.count, 4.4, 0.2)
        * rises(swings.advance, 1.75, 0.1)
        * rises(swings.height / stroke.size, 0.06, 0.006)
        * rises(swings.steady, 0.75, 0.05)
    )
    return Candidate(primitive=Primitive.ZIGZAG, weight=weight, points=stroke.points[[0, -1]])


def _scribble(stroke: Stroke, swings: Swings) -> Candidate:
    weight = (
        rises(swings.count, 4.3, 0.25)
        * falls(swings.advance, 1.75, 0.1)
        * rises(stroke.length / stroke.size, 2.5, 0.1)
    )
    return Candidate(primitive=Primitive.SCRIBBLE, weight=weight, points=stroke.points)


def _cross(stroke: Stroke, crossings: list[Crossing]) -> Candidate:
    """Return two straight lines that cross, the way between them along one side."""
    best = Candidate(primitive=Primitive.CROSS, weight=0.0, points=stroke.points[:1])
    count = len(stroke.points) - 1
    for at, first, last in crossings:
        before, loop, after = first / count, (last - first) / count, 1.0 - last / count
        # Each line half as far beyond the crossing as its end lies before it.
        one = stroke.points[: int(1.5 * first) + 1]
        other = stroke.points[int(1.5 * last - 0.5 * count) :]
        if min(len(one), len(other)) < 5:
            continue
        (_, along, bent), (_, beside, curved) = strokes.line(one), strokes.line(other)
        weight = (
            rises(min(before, after) / max(before, after), 0.4, 0.05)
            * rises(min(before, after), 0.08, 0.015)
            * rises(loop, 0.4, 0.04)
            * falls(loop, 0.82, 0.02)
            * falls(max(bent, curved) / stroke.size, 0.06, 0.008)
            * rises(abs(float(cross(along, beside))), 0.5, 0.06)
            * falls(len(crossings), 2.5, 0.3)
        )
        if weight > best.weight:
            best = Candidate(primitive=Primitive.CROSS, weight=weight, points=at[None])
    return best


def _arrow(stroke: Stroke, swings: Swings) -> Candidate:
    """Return a shaft and a head, whichever was drawn first."""
    calm = falls(swings.count, 4.5, 0.25)
    if calm < LEAST or stroke.gap < CLOSED:
        return Candidate(primitive=Primitive.ARROW, weight=0.0, points=stroke.points[[0, -1]])
    ways = stroke.points, stroke.points[::-1]
    best = max((_arrow_from(way) for way in ways), key=lambda each: each.weight)
    return replace(best, weight=best.weight * calm)


def _arrow_from(points: Floats) -> Candidate:
    """Return an arrow whose tail is the first point."""
    tail = points[0]
    tip = points[int(((points - tail) ** 2).sum(axis=1).argmax())]
    along = tip - tail
    # In shares of its length; the tip lies at (1, 0).
    frame = (points - tail) @ np.column_stack((along, (-along[1], along[0]))) / (along @ along)
    x, y = frame.T
    # The shaft goes on until the pen turns back or aside.
    ahead = x[4:] - x[:-4]
    over = (ahead < 0.55 * np.median(ahead[:40])) & (x[:-4] > 0.4)
    end = int(over.argmax()) if over.any() else len(points) - 1
    head = frame[end:]
    left, right = int(head[:, 1].argmax()), int(head[:, 1].argmin())
    up, down = float(head[left, 1]), -float(head[right, 1])
    path = float(np.hypot(*np.diff(head, axis=0).T).sum())
    weight = (
        falls(float(np.abs(y[:end]).max(initial=0.0)), 0.12, 0.01)
        * rises(min(up, down) / max(up, down, 1e-12), 0.25, 0.03)
        * rises(up + down, 0.09, 0.012)
        * falls(up + down, 0.85, 0.04)
        * rises(float(head[:, 0].min()), 0.47, 0.025)
        * falls(float(max(head[left, 0], head[right, 0])), 0.985, 0.012)
        * falls(float(head[[left, right], 0].max() - head[:, 0].min()), 0.22, 0.02)
        * rises(path, 0.22, 0.02)
        * falls(path, 2.6, 0.12)
    )
    return Candidate(primitive=Primitive.ARROW, weight=weight, points=np.array((tail, tip)))


def _angles(a: Floats, b: Floats) -> Floats:
    """Return by how much one direction turns into another [rad], counter-clockwise."""
    result: Floats = np.arctan2(cross(a, b), (a * b).sum(axis=-1))
    return result


def crossings_of(points: Floats) -> list[Crossing]:
    """Return where a way crosses itself; crossings next to one another are one."""
    coarse = points[::3]
    start, step = coarse[:-1], np.diff(coarse, axis=0)
    # Of every pair of steps, how far along each they meet.
    i, j = _PAIRS
    away, sine = start[j] - start[i], cross(step[i], step[j])
    # Steps along one line do not cross, whatever their rounding says.
    lengths = np.hypot(step[:, 0], step[:, 1])
    near = np.abs(sine) > 1e-6 * lengths[i] * lengths[j]
    i, j, away, sine = i[near], j[near], away[near], sine[near]
    one, other = cross(away, step[j]) / sine, cross(away, step[i]) / sine
    meet = np.flatnonzero((one >= 0) & (one < 1) & (other >= 0) & (other < 1))
    found: list[Crossing] = []
    for pair in meet.tolist():
        first, last = float(i[pair] + one[pair]), float(j[pair] + other[pair])
        place = start[i[pair]] + one[pair] * step[i[pair]]
        if all(abs(3 * first - a) + abs(3 * last - b) > 12 for _, a, b in found):
            found.append((place, 3 * first, 3 * last))
    return found
