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
velocity, but for what gravity or a wrench gave on the way that is taken back, unless there are
joints: else what falls would gain energy by each bounce. Of a crowd in which there is more to
look at than a step allows, the rest may pass.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import dataclass
import math

import numpy as np
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.ccd.time_of_impact import (
    body_of,
    Looks,
    Move,
    Pair,
    skin_of,
    Start,
    touch_straight,
    touch_turning,
)
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Body
from physsim_ros.model.shapes import Chain
import pymunk
from pymunk import Vec2d

# Overlap that the engine leaves standing [m]; its own 0.1 is 10 cm in a metre world.
SLOP = 0.005
# A body that moves less than this share of its inner radius a step is safe without a sweep: where
# two such bodies meet, each keeps its centre well on the side it came from.
SAFE_SHARE = 0.25
# Who is stopped may stand in the way of who follows: so many in a row, touching, at most.
ROUNDS = 16
# A tip that goes less far than this in a step [m] is no propeller: what it overlaps, the engine
# still pushes back out.
SLOW_TIP = 0.02


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
    move: Move
    depth: float
    skin: float
    reach: float
    outer: float

    @property
    def turns(self) -> bool:
        """Whether its outermost point turns so fast that the turn counts too."""
        return abs(self.move.turn) * self.reach > max(self.depth, SLOW_TIP)


@dataclass(frozen=True, slots=True)
class _Stop:
    """
    Where a move ends.

    :param at: share of the way
    :param move: what is made of the move
    """

    at: float
    move: Move


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
            rigid = rigid_of(body_of(pair.other))
            if rigid is not None and not rigid.body.fixed and rigid.engine not in movers:
                movers[rigid.engine] = mover_of(rigid)
    near = {engine: list(_near(space, mover, reach)) for engine, mover in movers.items()}
    moves = {engine: mover.move for engine, mover in (pushers | movers).items()}
    stopped: Collection[pymunk.Body] = movers
    looks = Looks(space)
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
            way, back = mover.move.way, move.way - mover.move.way
            engine.position += back
            engine.angle += move.turn - mover.move.turn
            if not _joined(space, engine):
                # As far as a kinematic body carries it, that is none of its own way.
                share = -way.dot(back) / max(way.dot(way), 1e-300)
                _slow(space, engine, -way * min(max(share, 0.0), 1.0), dt)


def relieve(arbiter: pymunk.Arbiter, contact: pymunk.ContactPointSet, space: pymunk.Space) -> None:
    """At a first touch, take back what the bodies overshot in this step, along the normal."""
    point = min(contact.points, key=lambda point: point.distance, default=None)
    if point is None or -point.distance <= SLOP:
        return
    depth = -point.distance
    one, other = arbiter.shapes
    if one.sensor or other.sensor:
        return
    a, b = body_of(one), body_of(other)
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
    for body, give, ahead in ((a, -give_a * share, ahead_a), (b, give_b * share, ahead_b)):
        if give:
            body.position += normal * give
            own = min(abs(give), max(ahead, 0.0))
            if not (_joined(space, a) or _joined(space, b)):
                _slow(space, body, normal * math.copysign(own, give), dt)
            # Further shapes of it, and further contacts, are found where it is now.
            for shape in body.shapes:
                shape.cache_bb()


def _joined(space: pymunk.Space, body: pymunk.Body) -> bool:
    """Tell whether a body hangs on joints: what it gains they take, and it does not fly."""
    return body.body_type == pymunk.Body.DYNAMIC and any(_joints(space, body))


def _joints(space: pymunk.Space, body: pymunk.Body) -> Iterator[pymunk.Constraint]:
    """Yield the joints of a body."""
    # It lists those that have left the space for as long as anything refers to them.
    return (joint for joint in body.constraints if joint in space.constraints)


def _slow(space: pymunk.Space, body: pymunk.Body, back: Vec2d, dt: float) -> None:
    """
    Give a body that is put back the speed that it had there, as it flew.

    :param back: its way [m]
    :param dt: of a step [s]
    """
    pull = space.gravity + body.force / body.mass
    work = pull.dot(back)
    if not work:
        return
    along = back.normalized()
    # The engine's velocity is that of half a step before.
    speed = body.velocity.dot(along) + pull.dot(along) * dt / 2
    square = speed * speed + 2.0 * work
    body.velocity += along * (math.copysign(math.sqrt(max(square, 0.0)), speed) - speed)
    if square < 0.0:
        # It has come so far by turning.
        spin = body.angular_velocity
        left = max(spin * spin + square * body.mass / body.moment, 0.0)
        body.angular_velocity = math.copysign(math.sqrt(left), spin)


def _mover(rigid: RigidBody, dt: float, depth: float) -> _Mover:
    engine = rigid.engine
    return _Mover(
        engine=engine,
        move=Move(engine.velocity * dt, engine.angular_velocity * dt),
        depth=depth,
        skin=min(SLOP, depth),
        reach=arm(rigid.body),
        outer=rigid.body.shape.form.outer,
    )


def _near(space: pymunk.Space, mover: _Mover, reach: float) -> Iterator[Pair]:
    """Yield what a body could meet in the coming step."""
    engine, way = mover.engine, mover.move.way
    apart = {
        joint.b if joint.a is engine else joint.a
        for joint in _joints(space, engine)
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
        at_start = Start(space, own)
        for other in space.bb_query(around, own.filter):
            if not (other.sensor or body_of(other) is engine or body_of(other) in apart):
                yield Pair(own, other, at_start, skin_of(own, other, mover.skin))


def _changed(
    engine: pymunk.Body, pairs: list[Pair], stopped: Collection[pymunk.Body]
) -> list[Pair]:
    """Return the pairs of a body that meet otherwise than before some were stopped."""
    return pairs if engine in stopped else [it for it in pairs if body_of(it.other) in stopped]


def _stop(
    looks: Looks,
    mover: _Mover,
    near: list[Pair],
    moves: dict[pymunk.Body, Move],
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
        other, body = pair.other, body_of(pair.other)
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
            touch_turning(looks, pair, move, theirs, reach=mover.reach, depth=mover.depth)
            if turning
            else touch_straight(looks, pair, relative)
        )
        if touch is None:
            continue
        at, approach = touch
        if (1.0 - at) * approach <= mover.depth or (first is not None and first.at <= at):
            continue
        made = move * at
        if pusher:
            rest = theirs * (1.0 - at)
            made = Move(made.way + rest.way + arm.rotated(rest.turn) - arm, made.turn)
        first = _Stop(at, made)
    return first


def _move_of(shape: pymunk.Shape, moves: dict[pymunk.Body, Move], dt: float) -> Move:
    """Return what a shape does in the coming step; a disc does not turn."""
    body = body_of(shape)
    move = moves.get(body)
    if move is None:
        move = moves[body] = Move(body.velocity * dt, body.angular_velocity * dt)
    if move.turn and isinstance(shape, pymunk.Circle) and shape.offset == (0.0, 0.0):
        return Move(move.way, 0.0)
    return move


def _gap(point: Vec2d, box: pymunk.BB) -> float:
    """Return how far a point is from a box [m]."""
    x, y = point
    left, bottom, right, top = box
    return math.hypot(max(left - x, 0.0, x - right), max(bottom - y, 0.0, y - top))


class ContinuousCollision:
    def __init__(self, *_):
        pass

    def clamp_moves(self, context):
        pass
