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
Fast bodies: the engine looks only at where a step ends, this looks at the way there.

Law: a body that moves more than a quarter of its inner radius a step, or one of several pieces
more than a quarter of that of the smallest body, is swept along its way first; where it would
enter something, the step ends there. The engine then finds the contact and resolves it with the
full velocity. What a kinematic body would run over is carried along to where the step ends. What
a slower body overshoots at a first touch is taken back in `relieve`. None of these changes a
velocity. A step looks at shapes `MOST_LOOKS` times at most: of a crowd that takes more, the rest
may pass.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
import math
from typing import cast, NamedTuple

import numpy as np
from physsim_ros.core.rigid_body import RigidBody
from physsim_ros.core.shapes import Chain
from physsim_ros.core.snapshot import Body, Floats
import pymunk
from pymunk import Vec2d

# Overlap that the engine leaves standing [m]; its own 0.1 is 10 cm in a metre world.
SLOP = 0.005
# A body that moves less than this share of its inner radius a step is safe without a sweep: where
# two such bodies meet, each keeps its centre well on the side it came from.
SAFE_SHARE = 0.25
# Who is stopped may stand in the way of who follows: so many in a row, touching, at most.
ROUNDS = 16
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
# A tip that goes less far than this in a step [m] is no propeller: what it overlaps, the engine
# still pushes back out.
SLOW_TIP = 0.02


@dataclass(frozen=True, slots=True)
class _Move:
    """
    What a body does in the coming step.

    :param way: of the centre of mass [m]
    :param turn: [rad]
    """

    way: Vec2d
    turn: float

    def __mul__(self, share: float) -> _Move:
        return _Move(self.way * share, self.turn * share)


@dataclass(frozen=True, slots=True)
class _Mover:
    """
    A body that is swept.

    :param engine: it
    :param move: as the engine would make it
    :param depth: how far it may enter something before the engine mistakes the side [m]
    :param skin: how far it is let in, for the engine to see the contact [m]; what overlaps less
        on its way, as a body that slides over tiles does, is not in the way
    :param reach: greatest distance of a point of it from its centre [m]; 0 for a disc
    :param outer: the same, for a disc too
    """

    engine: pymunk.Body
    move: _Move
    depth: float
    skin: float
    reach: float
    outer: float

    @property
    def turns(self) -> bool:
        """Whether its outermost point turns so fast that the turn counts too."""
        return abs(self.move.turn) * self.reach > max(self.depth, SLOW_TIP)


class _Start:
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


@dataclass(frozen=True, slots=True)
class _Pair:
    """
    Two shapes that could meet in the coming step.

    :param own: of the body that is swept
    :param other: of another body
    :param start: what the first overlaps at the start
    :param skin: how far they are let into each other [m]
    """

    own: pymunk.Shape
    other: pymunk.Shape
    start: _Start
    skin: float


class _Outline(NamedTuple):
    """
    A convex polygon in the world.

    :ivar corners: (n, 2) float64 [m]
    :ivar normals: (n, 2) float64: of length 1, on each side
    """

    corners: Floats
    normals: Floats


class _Looks:
    """
    Looks at shapes, as often as a step allows.

    :param space: of the engine
    """

    def __init__(self, space: pymunk.Space) -> None:
        self._space = space
        self._left = MOST_LOOKS
        self._outlines: dict[pymunk.Poly, _Outline] = {}

    def at(self, pairs: list[_Pair]) -> Iterator[_Pair]:
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


@dataclass(frozen=True, slots=True)
class _Stop:
    """
    Where a move ends.

    :param at: share of the way
    :param move: what is made of the move
    """

    at: float
    move: _Move


def safe_depths(bodies: Sequence[Body]) -> Floats:
    """
    Return how far each body may move in a step without a sweep, (n,) [m].

    One piece of a body would swallow what is smaller, and push it on into the next piece.
    """
    own = np.array([body.shape.form.inner * SAFE_SHARE for body in bodies])
    thin = np.array([isinstance(body.shape, Chain) for body in bodies], dtype=np.bool_)
    pieces = np.array([len(body.shape.form.pieces) for body in bodies])
    least = max(SLOP, float(own[~thin].min(initial=np.inf)))
    return np.where((pieces > 1) & ~thin, np.minimum(own, least), own)


def arm(body: Body) -> float:
    """Return how far out a body's turning counts [m]: a disc covers the same ground anyway."""
    form = body.shape.form
    return 0.0 if form.inner >= form.outer else form.outer


def arrest(
    space: pymunk.Space,
    fast: list[RigidBody],
    dt: float,
    *,
    reach: float,
    depth_of: Callable[[RigidBody], float],
    rigid_of: Callable[[pymunk.Body], RigidBody | None],
) -> None:
    """
    Shorten the coming step of fast bodies so that it ends where they first enter something.

    :param fast: bodies that would move further than is safe
    :param dt: of the coming step [s]
    :param reach: as far as any body moves in the step [m]
    :param depth_of: how far a body may move without a sweep [m]
    :param rigid_of: finds the body that an engine body plays; None is the background
    """

    def mover_of(rigid: RigidBody) -> _Mover:
        return _mover(rigid, dt, depth_of(rigid))

    pushers = {rigid.engine: mover_of(rigid) for rigid in fast if rigid.body.fixed}
    movers = {rigid.engine: mover_of(rigid) for rigid in fast if not rigid.body.fixed}
    for pusher in pushers.values():
        for pair in _near(space, pusher, reach):
            rigid = rigid_of(_body(pair.other))
            if rigid is not None and not rigid.body.fixed and rigid.engine not in movers:
                movers[rigid.engine] = mover_of(rigid)
    near = {engine: list(_near(space, mover, reach)) for engine, mover in movers.items()}
    moves = {engine: mover.move for engine, mover in (pushers | movers).items()}
    stopped: Collection[pymunk.Body] = movers
    looks = _Looks(space)
    for number in range(ROUNDS):
        # All are measured before the first is stopped, or two would miss each other.
        stops = {
            engine: stop
            for engine, mover in movers.items()
            if (pairs := _changed(engine, near[engine], stopped))
            and (stop := _stop(looks, mover, pairs, moves, dt, carried=number == 0))
        }
        if not stops:
            break
        stopped = stops.keys()
        moves |= {engine: stop.move for engine, stop in stops.items()}
    for engine, mover in movers.items():
        move = moves[engine]
        if move is not mover.move:
            # The engine will add the whole move; put the body back by what it may not go.
            engine.position += move.way - mover.move.way
            engine.angle += move.turn - mover.move.turn


def relieve(arbiter: pymunk.Arbiter, contact: pymunk.ContactPointSet, space: pymunk.Space) -> None:
    """At a first touch, take back what the bodies overshot in this step, along the normal."""
    point = min(contact.points, key=lambda point: point.distance, default=None)
    if point is None or -point.distance <= SLOP:
        return
    depth = -point.distance
    one, other = arbiter.shapes
    if one.sensor or other.sensor:
        return
    a, b = _body(one), _body(other)
    normal = contact.normal
    dt = space.current_time_step
    ahead_a = a.velocity_at_world_point(point.point_a).dot(normal) * dt
    ahead_b = -b.velocity_at_world_point(point.point_b).dot(normal) * dt
    excess = min(depth - SLOP, ahead_a + ahead_b)
    # Each gives back of what it went itself, or what stands would be pushed through what is
    # behind it; a kinematic body gives nothing.
    give_a = max(ahead_a, 0.0) if a.body_type == pymunk.Body.DYNAMIC else 0.0
    give_b = max(ahead_b, 0.0) if b.body_type == pymunk.Body.DYNAMIC else 0.0
    if b.body_type == pymunk.Body.KINEMATIC and a.body_type == pymunk.Body.DYNAMIC:
        give_a, give_b = excess, 0.0
    elif a.body_type == pymunk.Body.KINEMATIC and b.body_type == pymunk.Body.DYNAMIC:
        give_a, give_b = 0.0, excess
    if excess <= 0 or give_a + give_b <= 0:
        return
    share = min(1.0, excess / (give_a + give_b))
    for body, give in ((a, -give_a * share), (b, give_b * share)):
        if give:
            body.position += normal * give
            # Further shapes of it, and further contacts, are found where it is now.
            for shape in body.shapes:
                shape.cache_bb()


def _body(shape: pymunk.Shape) -> pymunk.Body:
    """Return the body of a shape; one in a space always has one."""
    return cast('pymunk.Body', shape.body)


def _mover(rigid: RigidBody, dt: float, depth: float) -> _Mover:
    engine = rigid.engine
    return _Mover(
        engine=engine,
        move=_Move(engine.velocity * dt, engine.angular_velocity * dt),
        depth=depth,
        skin=min(SLOP, depth),
        reach=arm(rigid.body),
        outer=rigid.body.shape.form.outer,
    )


def _near(space: pymunk.Space, mover: _Mover, reach: float) -> Iterator[_Pair]:
    """Yield what a body could meet in the coming step."""
    engine, way = mover.engine, mover.move.way
    apart = {
        joint.b if joint.a is engine else joint.a
        for joint in engine.constraints
        if not joint.collide_bodies
    }
    for own in engine.shapes:
        if own.sensor:
            continue
        start = own.bb
        if mover.turns:
            start = pymunk.BB.newForCircle(engine.position, mover.reach)
        left, right = min(0.0, way.x) - reach, max(0.0, way.x) + reach
        bottom, top = min(0.0, way.y) - reach, max(0.0, way.y) + reach
        around = pymunk.BB(
            start.left + left, start.bottom + bottom, start.right + right, start.top + top
        )
        at_start = _Start(space, own)
        for other in space.bb_query(around, own.filter):
            if not (other.sensor or _body(other) is engine or _body(other) in apart):
                yield _Pair(own, other, at_start, _skin(own, other, mover.skin))


def _changed(
    engine: pymunk.Body, pairs: list[_Pair], stopped: Collection[pymunk.Body]
) -> list[_Pair]:
    """Return the pairs of a body that meet otherwise than before some were stopped."""
    return pairs if engine in stopped else [it for it in pairs if _body(it.other) in stopped]


def _stop(
    looks: _Looks,
    mover: _Mover,
    near: list[_Pair],
    moves: dict[pymunk.Body, _Move],
    dt: float,
    *,
    carried: bool,
) -> _Stop | None:
    """
    Return where a body's move ends early; None where it does not.

    :param moves: what bodies do as far as it is known; others go on as they are, and are added
    :param carried: whether kinematic bodies carry it along
    """
    engine, move = mover.engine, moves[mover.engine]
    first: _Stop | None = None
    for pair in looks.at(near):
        other, body = pair.other, _body(pair.other)
        pusher = body.body_type == pymunk.Body.KINEMATIC
        if pusher and not carried:
            continue
        theirs = _move_of(other, moves, dt)
        relative = move.way - theirs.way
        arm = engine.position - body.position if theirs.turn or pusher else Vec2d.zero()
        turning = mover.turns or abs(theirs.turn) * arm.length > max(mover.depth, SLOW_TIP)
        # What the engine sees in time is left to it.
        length = relative.length
        if not turning and length <= mover.depth:
            continue
        if turning:
            length += abs(theirs.turn) * arm.length
        if _gap(engine.position, other.bb) > mover.outer + length:
            continue
        looks.count()
        touch = (
            _touch_turning(looks, pair, mover, move, theirs)
            if turning
            else _touch(looks, pair, relative)
        )
        if touch is None:
            continue
        at, approach = touch
        if (1.0 - at) * approach <= mover.depth or (first is not None and first.at <= at):
            continue
        made = move * at
        if pusher:
            rest = theirs * (1.0 - at)
            made = _Move(made.way + rest.way + arm.rotated(rest.turn) - arm, made.turn)
        first = _Stop(at, made)
    return first


def _move_of(shape: pymunk.Shape, moves: dict[pymunk.Body, _Move], dt: float) -> _Move:
    """Return what a shape does in the coming step; a disc does not turn."""
    body = _body(shape)
    move = moves.get(body)
    if move is None:
        move = moves[body] = _Move(body.velocity * dt, body.angular_velocity * dt)
    if move.turn and isinstance(shape, pymunk.Circle) and shape.offset == (0.0, 0.0):
        return _Move(move.way, 0.0)
    return move


def _gap(point: Vec2d, box: pymunk.BB) -> float:
    """Return how far a point is from a box [m]."""
    x, y = point
    left, bottom, right, top = box
    return math.hypot(max(left - x, 0.0, x - right), max(bottom - y, 0.0, y - top))


def _touch(looks: _Looks, pair: _Pair, way: Vec2d) -> tuple[float, float] | None:
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


def _cast(
    own: pymunk.Shape, other: pymunk.Shape, way: Vec2d, skin: float
) -> Iterator[tuple[float, float]]:
    """Yield when the corners, ends or centre of a shape meet another."""
    place = _body(own).local_to_world
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


def _skin(own: pymunk.Shape, other: pymunk.Shape, skin: float) -> float:
    """Return how far shapes are let into each other; never so far that middle lines meet."""
    rounding = _radius(own) + _radius(other)
    return min(skin, rounding / 2) if rounding > 0.0 else skin


def _touch_turning(
    looks: _Looks, pair: _Pair, mover: _Mover, move: _Move, theirs: _Move
) -> tuple[float, float] | None:
    """
    Return when shapes come to overlap by the skin, if they do, one or both turning fast.

    :return: share of the way until then, and the length of the way of the outermost point
    """
    # The first moves as it is seen from the second, which stays as the space knows it.
    shape, body, pivot = pair.own, _body(pair.own), _body(pair.other).position
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

    length = way.length + abs(turn) * mover.reach + abs(theirs.turn) * arm.length
    count = min(MOST_POSES, math.ceil(length / mover.depth))
    at = next((number / count for number in range(1, count + 1) if touches(number / count)), None)
    if at is not None:
        clear = at - 1.0 / count
        for _ in range(HALVINGS):
            middle = (clear + at) / 2
            clear, at = (clear, middle) if touches(middle) else (middle, at)
    body.position, body.angle = place, angle
    shape.cache_bb()
    return None if at is None else (at, length)


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
    place = _body(shape).local_to_world
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
