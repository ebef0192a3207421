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
Where the ends of what is drawn belong: on the bodies that they were drawn to.

Law: a point moves by no more than `snap`, and only onto something that is there.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
import math

import numpy as np
from physsim_ros.drawing.scene_query import on_segment, View
from physsim_ros.drawing.settings import DrawingSettings
from physsim_ros.model.arrays import Floats
from physsim_ros.model.names import WORLD
from physsim_ros.model.shapes import Capsule, Chain, Circle, Convex, Disc, Piece
from physsim_ros.model.transform import Point

# What so much of a circle lies on, it was drawn across the edge of.
_ACROSS = 0.25


@dataclass(frozen=True, slots=True)
class End:
    """
    An end of something that joins bodies.

    :param point: in the world [m]
    :param body: a body's name, or 'world' for the background
    """

    point: Point
    body: str


def ends_on(
    start: Point, end: Point, view: View, settings: DrawingSettings
) -> tuple[End, End] | None:
    """
    Return the ends of what joins the bodies at two points, the first one on a body that moves.

    :return: None where there is nothing to join: no body that moves, or one body at both ends
    """
    first, last = _bodies(start, view, settings), _bodies(end, view, settings)
    pairs = [(a, b) for a in first or (WORLD,) for b in last or (WORLD,) if a != b]
    for a, b in pairs:
        ends = End(_onto(start, a, view, settings), a), End(_onto(end, b, view, settings), b)
        if a != WORLD and not view.body(a).fixed:
            return ends
        if b != WORLD and not view.body(b).fixed:
            return ends[::-1]
    return None


def pivot(
    center: Point, drawn: Floats, view: View, settings: DrawingSettings
) -> tuple[Point, tuple[str, ...]]:
    """
    Return where an axle belongs, and the one or two bodies that it joins, the topmost first.

    :param center: of the circle, on a body
    :param drawn: (k, 2) float64: the circle [m]
    """
    under = view.bodies_at(center)[:2]
    if len(under) == 1:
        under = _with_what_it_crosses(under[0], center, drawn, view)
    for name in under:
        if isinstance(view.body(name).shape, Disc):
            x, y, _ = view.pose(name)
            if math.dist((x, y), center) > settings.snap:
                continue
            # In the middle of a wheel, where that is on the same bodies, or near the other one.
            near = view.bodies_at((x, y), settings.snap)
            if view.bodies_at((x, y))[:2] == under or (len(under) == 2 and set(under) <= {*near}):
                return (x, y), under
    return center, under


def _with_what_it_crosses(name: str, center: Point, drawn: Floats, view: View) -> tuple[str, ...]:
    """Return a body, and another one whose edge a circle on it was drawn across, topmost first."""
    radius = float(np.hypot(*(drawn - center).T).max())
    near = view.bodies_at(center, radius)
    shares = {each: float(view.covers(each, drawn).mean()) for each in near if each != name}
    beside = max(shares, key=shares.__getitem__, default=name)
    if shares.get(beside, 0.0) < _ACROSS:
        return (name,)
    return tuple(each for each in near if each in (name, beside))


def wall_end(point: Point, view: View, settings: DrawingSettings) -> Point:
    """Return where the end of a wall belongs: at the end of another, or on a body's surface."""
    near = view.bodies_at(point, settings.snap)
    for name in near:
        shape = view.body(name).shape
        if isinstance(shape, Chain):
            for end in (shape.points[0], shape.points[-1]):
                there = view.in_world(name, end)
                if math.dist(there, point) <= settings.snap:
                    return there
    covering = view.bodies_at(point)
    return point if covering or not near else _surface(point, near[0], view)


def _bodies(point: Point, view: View, settings: DrawingSettings) -> tuple[str, ...]:
    """Return the bodies that a point belongs to, topmost first: those that cover it, or near."""
    return view.bodies_at(point) or view.bodies_at(point, settings.snap)


def _onto(point: Point, name: str, view: View, settings: DrawingSettings) -> Point:
    """Return where on a body an end belongs: in its middle, where it was drawn, or nearest."""
    if name == WORLD:
        return point
    body = view.body(name)
    # What is hung up in its middle does not turn for a slip of the hand.
    middle = view.in_world(name, body.shape.form.centroid)
    if not body.fixed and math.dist(point, middle) <= min(settings.snap, body.shape.form.inner):
        return middle
    return point if name in view.bodies_at(point) else _surface(point, name, view)


def _surface(point: Point, name: str, view: View) -> Point:
    """Return the point of a body that is nearest to a point outside it."""
    local = view.local(name, point)
    pieces = view.body(name).shape.form.pieces
    nearest = (near for piece in pieces for near in _nearest(piece, local))
    return view.in_world(name, min(nearest, key=lambda each: math.dist(each, local)))


def _nearest(piece: Piece, point: Point) -> Iterator[Point]:
    """Yield points of a piece, that nearest to a point outside it among them."""
    match piece:
        case Circle(center, radius):
            yield _towards(center, point, radius)
        case Capsule(start, end, radius):
            yield _towards(on_segment(start, end, point), point, radius)
        case Convex(vertices):
            for start, end in zip(vertices, (*vertices[1:], vertices[0]), strict=True):
                yield on_segment(start, end, point)


def _towards(start: Point, end: Point, length: float) -> Point:
    """Return the point that lies so far from one point towards another."""
    distance = max(math.dist(start, end), 1e-12)
    share = length / distance
    return start[0] + share * (end[0] - start[0]), start[1] + share * (end[1] - start[1])
