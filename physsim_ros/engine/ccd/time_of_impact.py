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
Touches: when two shapes that move come to overlap, by the engine's queries and by algebra.

Law: nothing is moved for good; after `MOST_LOOKS` looks at shapes in a step no other begins.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
import math
from typing import cast, NamedTuple

import numpy as np
from physsim_ros.model.arrays import Floats
import pymunk
from pymunk import Vec2d

# What overlaps by this share of the skin is in it, whichever way the sweep to the skin rounded.
ALREADY = 0.99
# Of a body that turns fast so many poses along its way are looked at, at most, and so often is the
# part between the last clear one and the next halved. Each costs as much as a query: a stick that
# is spun like a propeller may miss what is thinner than a share of its way.
MOST_POSES = 24
HALVINGS = 5
# So often are shapes looked at in a step, at most: a hundred sticks that spin through each other
# would take minutes. Whoever comes later is left to the engine.
MOST_LOOKS = 3000


def body_of(shape: pymunk.Shape) -> pymunk.Body:
    """Return the body of a shape; one in a space always has one."""
    return cast('pymunk.Body', shape.body)


@dataclass(frozen=True, slots=True)
class Move:
    """
    What a body does in the coming step.

    :param way: of the centre of mass [m]
    :param turn: [rad]
    """

    way: Vec2d
    turn: float

    def __mul__(self, share: float) -> Move:
        return Move(self.way * share, self.turn * share)


@dataclass(frozen=True, slots=True)
class Pair:
    """
    Two shapes that could meet in the coming step.

    :param own: of the body that is swept
    :param other: of another body
    :param start: what the first overlaps at the start
    :param skin: how far they are let into each other [m]
    """

    own: pymunk.Shape
    other: pymunk.Shape
    start: Start
    skin: float


class Start:
    """
    What a shape of a body that is swept overlaps at the start; found when it is first wanted.

    :param space: of the engine
    :param own: the shape
    """

    def __init__(self, space: pymunk.Space, own: pymunk.Shape) -> None:
        self._space = space
        self._own = own

    @cached_property
    def _contacts(self) -> dict[pymunk.Shape, pymunk.ContactPointSet]:
        return _contacts(self._space, self._own)

    def overlap(self, other: pymunk.Shape) -> tuple[float, Vec2d]:
        """Return how deep another shape lies in it [m], and the normal that leads there."""
        contact = self._contacts.get(other)
        return (0.0, Vec2d.zero()) if contact is None else (_depth(contact), contact.normal)


class _Outline(NamedTuple):
    """
    A convex polygon in the world.

    :ivar corners: (n, 2) float64 [m]
    :ivar normals: (n, 2) float64: of length 1, on each side
    """

    corners: Floats
    normals: Floats


class Looks:
    """
    Looks at shapes, as often as a step allows.

    :param space: of the engine
    """

    def __init__(self, space: pymunk.Space) -> None:
        self._space = space
        self._left = MOST_LOOKS
        self._outlines: dict[pymunk.Poly, _Outline] = {}

    def at(self, pairs: list[Pair]) -> Iterator[Pair]:
        """Yield the pairs that can still be looked at."""
        for pair in pairs:
            if self._left <= 0:
                return
            yield pair

    def count(self) -> None:
        """Count one look."""
        self._left -= 1

    def outline(self, shape: pymunk.Poly) -> _Outline:
        """Return the outline of a polygon where the step begins."""
        outline = self._outlines.get(shape)
        if outline is None:
            outline = self._outlines[shape] = _outline(shape)
        return outline

    def contacts(self, shape: pymunk.Shape) -> dict[pymunk.Shape, pymunk.ContactPointSet]:
        """Return what a shape overlaps where it is now."""
        self.count()
        return _contacts(self._space, shape)


def touch_straight(looks: Looks, pair: Pair, way: Vec2d) -> tuple[float, float] | None:
    """
    Return when shapes come to overlap by the skin, if they do, neither turning.

    :param way: of the first, seen from the second [m]
    :return: share of the way until then, and the length of the way along the normal there
    """
    own, other, skin = pair.own, pair.other, pair.skin
    overlap, normal = pair.start.overlap(other)
    if overlap > ALREADY * skin:
        approach = way.dot(normal)
        return (0.0, approach) if approach > 0.0 else None
    if isinstance(own, pymunk.Poly) and isinstance(other, pymunk.Poly):
        return _touch_convex(looks.outline(own), looks.outline(other), np.array(way), skin)
    # What is round meets with a corner, an end or a centre, on one of the two sides.
    touches = [*_cast(own, other, way, skin), *_cast(other, own, -way, skin)]
    return min(touches, default=None)


def touch_turning(
    looks: Looks, pair: Pair, move: Move, theirs: Move, *, reach: float, depth: float
) -> tuple[float, float] | None:
    """
    Return when shapes come to overlap by the skin, if they do, one or both turning fast.

    :return: share of the way until then, and the length of the way of the outermost point
    """
    # The first moves as it is seen from the second, which stays as the space knows it.
    shape, body, pivot = pair.own, body_of(pair.own), body_of(pair.other).position
    place, angle = body.position, body.angle
    way, turn = move.way - theirs.way, move.turn - theirs.turn
    arm = place - pivot
    # What overlaps from the start may leave; only deeper is a touch.
    overlap, _ = pair.start.overlap(pair.other)
    limit = max(pair.skin, overlap + (1.0 - ALREADY) * pair.skin)

    def touches(share: float) -> bool:
        body.position = pivot + (arm + way * share).rotated(-theirs.turn * share)
        body.angle = angle + turn * share
        contact = looks.contacts(shape).get(pair.other)
        return contact is not None and _depth(contact) > limit

    length = way.length + abs(turn) * reach + abs(theirs.turn) * arm.length
    count = min(MOST_POSES, math.ceil(length / depth))
    at = next((number / count for number in range(1, count + 1) if touches(number / count)), None)
    if at is not None:
        clear = at - 1.0 / count
        for _ in range(HALVINGS):
            middle = (clear + at) / 2
            clear, at = (clear, middle) if touches(middle) else (middle, at)
    body.position, body.angle = place, angle
    shape.cache_bb()
    return None if at is None else (at, length)


def skin_of(own: pymunk.Shape, other: pymunk.Shape, skin: float) -> float:
    """Return how far shapes are let into each other; never so far that middle lines meet."""
    rounding = _radius(own) + _radius(other)
    return min(skin, rounding / 2) if rounding > 0.0 else skin


def _cast(
    own: pymunk.Shape, other: pymunk.Shape, way: Vec2d, skin: float
) -> Iterator[tuple[float, float]]:
    """Yield when the corners, ends or centre of a shape meet another."""
    place = body_of(own).local_to_world
    radius = _radius(own) - skin
    if isinstance(own, pymunk.Circle):
        points = [place(own.offset)]
    elif isinstance(own, pymunk.Segment):
        points = [place(own.a), place(own.b)]
    else:
        points = [place(corner) for corner in own.get_vertices()]
    for point in points:
        hit = other.segment_query(point, point + way, radius)
        # At 0 the engine tells of a start inside, and that with a normal of either sign.
        if hit is not None and hit.alpha > 0.0:
            approach = -way.dot(hit.normal)
            if approach > 0.0:
                yield hit.alpha, approach


def _radius(shape: pymunk.Shape) -> float:
    """Return the radius by which a shape surrounds its centre, its middle line or its corners."""
    return shape.radius if isinstance(shape, pymunk.Circle | pymunk.Segment) else 0.0


def _contacts(
    space: pymunk.Space, shape: pymunk.Shape
) -> dict[pymunk.Shape, pymunk.ContactPointSet]:
    """Return what a shape overlaps where it is now, with normals that lead away from it."""
    # Not `shapes_collide`: it asserts that there is a contact.
    hits = space.shape_query(shape)
    return {hit.shape: hit.contact_point_set for hit in hits if hit.shape is not None}


def _depth(contact: pymunk.ContactPointSet) -> float:
    """Return how deep shapes lie in each other [m]."""
    # A query gives the distance of a polygon from what is round with the wrong sign.
    return max(abs(point.distance) for point in contact.points)


def _outline(shape: pymunk.Poly) -> _Outline:
    """Return the outline of a polygon where it is now."""
    place = body_of(shape).local_to_world
    corners = np.array([place(corner) for corner in shape.get_vertices()])
    edges = np.roll(corners, -1, axis=0) - corners
    normals = np.column_stack((edges[:, 1], -edges[:, 0]))
    normals /= np.hypot(edges[:, 0], edges[:, 1])[:, None]
    return _Outline(corners, normals)


def _touch_convex(
    a: _Outline, b: _Outline, way: Floats, skin: float
) -> tuple[float, float] | None:
    """
    Return when convex outlines come to overlap by the skin, by separating axes.

    Two convex outlines overlap when their shadows on every side's normal do, so they meet when
    the last pair of shadows does.
    """
    normals = np.concatenate((a.normals, b.normals))
    shadow_a, shadow_b = a.corners @ normals.T, b.corners @ normals.T
    speed = normals @ way
    ahead = shadow_b.min(axis=0) - shadow_a.max(axis=0) + skin
    behind = shadow_b.max(axis=0) - shadow_a.min(axis=0) - skin
    still = speed == 0.0
    if (still & ((ahead > 0) | (behind < 0))).any():
        return None
    with np.errstate(divide='ignore', invalid='ignore'):
        first, last = ahead / speed, behind / speed
    enter = np.where(still, -math.inf, np.minimum(first, last))
    leave = np.where(still, math.inf, np.maximum(first, last))
    axis = int(enter.argmax())
    at = float(enter[axis])
    if not 0.0 <= at < 1.0 or at > leave.min():
        return None
    return at, abs(float(speed[axis]))
