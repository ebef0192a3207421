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
The joints of a space: made, taken out, prepared for a step and corrected after it.

Pymunk solves its constraints together with contacts. Its bias, a velocity that closes gaps, is
replaced: for the centripetal term alone (J v = - dt / 2 dJ/dt v), without which what swings loses
(w dt)^2 / 2 of its energy a step; gaps are closed in positions (`projection`). No gap becomes a
velocity, so joints that contradict each other or contacts give no energy.

Laws: a joint goes with either of its bodies; a body whose engine objects are made anew keeps its
joints; a joint that gives more than it can bear is gone after that step; impulses are those of the
engine; `max_force` that is not reached changes nothing.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
import itertools
import math

import numpy as np
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.islands import Rows
from physsim_ros.engine.joints import (
    axle,
    engine_memory,
    gear,
    motor,
    pin,
    rod,
    rope,
    slider,
    spring,
)
from physsim_ros.engine.joints.kind import Batch, Ends, EngineJoint, Kind, Motion
from physsim_ros.engine.joints.projection import Projection
from physsim_ros.engine.step_context import StepContext
from physsim_ros.model.arrays import Flags, Floats
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.scene import Body, Joint
from physsim_ros.model.snapshot import Springs
from physsim_ros.model.transform import Pose
import pymunk

# ruff: noqa: SLF001

_KINDS: dict[JointKind, Kind] = {
    JointKind.PIN: pin.KIND,
    JointKind.AXLE: axle.KIND,
    JointKind.MOTOR: motor.KIND,
    JointKind.SPRING: spring.KIND,
    JointKind.ROD: rod.KIND,
    JointKind.ROPE: rope.KIND,
    JointKind.SLIDER: slider.KIND,
    JointKind.GEAR: gear.KIND,
}
# Share of its greatest force that a joint gives where it gives all of it, by rounding.
_ALL = 1.0 - 1e-9
# A faster turn in a step has no centripetal term [rad]: 60 rad/s at 240 Hz.
_FAST_TURN = 0.25


class JointSet:
    """
    Joints in the engine.

    :param space: of the engine
    :param bodies: by name; kept by the space
    :param dt: of a step [s]
    """

    def __init__(self, space: pymunk.Space, bodies: Mapping[str, RigidBody], dt: float) -> None:
        self.by_name: dict[str, EngineJoint] = {}
        self._space = space
        self._bodies = bodies
        self._dt = dt
        # Names of the joints of each body.
        self._on: dict[str, dict[str, None]] = {}
        self._table: _Table | None = None
        self._springs: Springs | None = None
        # Whether a joint or a body has come or gone since the last step, and before that.
        self._changed = self._was_changed = True

    def of(self, body: str) -> tuple[str, ...]:
        """Return the names of a body's joints, in the order in which they were made."""
        return tuple(name for name in self.by_name if name in self._on.get(body, ()))

    def has(self, body: str) -> bool:
        """Tell whether a body has joints."""
        return body in self._on

    def near(self, bodies: Iterable[str], joint: Joint | None) -> list[Joint]:
        """
        Return the joints on some bodies, in the order in which they were made.

        :param bodies: names of these
        :param joint: one that is to come, or to replace one of its name, and counts with all
            joints on its bodies; None is none
        """
        names = {*bodies, *(() if joint is None else (joint.a, joint.b))} - {WORLD}
        on = {name for body in names for name in self._on.get(body, ())}
        joints = [held.joint for name, held in self.by_name.items() if name in on]
        if joint is not None:
            joints = [each for each in joints if each.name != joint.name] + [joint]
        return joints

    def check_springs(self, bodies: Mapping[str, Body], joint: Joint | None = None) -> None:
        """
        Refuse what would leave springs too stiff for the steps.

        :param bodies: that are to change, as they will be
        :param joint: that is to come; None is none
        :raises BadProperty: of the greatest stiffness that can be had
        """
        known = {name: rigid.body for name, rigid in self._bodies.items()} | dict(bodies)
        spring.check_stiffness(self.near(bodies, joint), known, self._dt)

    def with_turns(self, rigid: RigidBody, pose: Pose) -> Pose:
        """Return a pose with as many whole turns as a jointed body has made: joints count them."""
        if not self.has(rigid.body.name):
            return pose
        turns = round((rigid.engine.angle - pose[2]) / math.tau)
        return pose[0], pose[1], pose[2] + turns * math.tau

    def put(self, joint: Joint) -> None:
        """Add a joint; it replaces one of that name in its place."""
        old = self.by_name.get(joint.name)
        if old is not None:
            self._take(old)
        self._build(joint)
        for body in (joint.a, joint.b):
            self._on.setdefault(body, {})[joint.name] = None

    def remove(self, name: str) -> None:
        """Remove a joint for good."""
        self._take(self.by_name[name])
        del self.by_name[name]

    def clear(self) -> None:
        """Take all joints out of the engine, before its bodies serve another space."""
        self._space.remove(*self._constraints())
        self._forget()
        self.by_name.clear()
        self._on.clear()

    def detach(self, body: str) -> None:
        """Take the joints of a body out of the engine, before its engine objects go."""
        for name in self.of(body):
            held = self.by_name[name]
            self._space.remove(*held.constraints)
            self.by_name[name] = EngineJoint(held.joint, held.ends, ())
        self._forget()

    def attach(self, body: str) -> None:
        """Put the joints of a body back into the engine."""
        for name in self.of(body):
            self._build(self.by_name[name].joint)

    def set_targets(self, context: StepContext) -> None:
        """Set the velocities that constraints are solved for in the coming step."""
        if self.by_name:
            table = context.table
            states = np.concatenate((table.state[:, :3], context.twists), axis=1)
            self._tabulated().aim(_with_background(states)[self._rows(table.bodies)])
        self._was_changed, self._changed = self._changed, False

    def close_gaps(self, context: StepContext) -> None:
        """Correct the positions of jointed bodies after the step."""
        if not self.by_name:
            return
        table, rows = context.table, self._rows(context.table.bodies)
        poses = _with_background(table.state[:, :3])[rows]
        self._tabulated().correct(poses)
        table.write_poses(rows[:-1], poses[:-1])

    def forces(self) -> Floats:
        """Return (j,) float64: what each joint gave in the last step [N]."""
        return np.array([held.impulse for held in self.by_name.values()]) / self._dt

    def compressed(self) -> Flags:
        """Return (j,) bool: whether each joint pushed its bodies apart in the last step."""
        return np.array([held.is_compressed for held in self.by_name.values()], dtype=bool)

    def impulses(self) -> Floats:
        """Return (c, 2) float64: impulses from which the next step starts, of all constraints."""
        return engine_memory.impulses(self._constraints())

    def go_on_from(self, impulses: Floats) -> None:
        """Have the next step start from impulses, (c, 2) float64; from none if they do not fit."""
        if len(impulses) == len(self._constraints()):
            engine_memory.set_impulses(self._constraints(), impulses)

    def springs(self) -> Springs:
        """Return the springs among the joints."""
        if self._springs is None:
            self._springs = spring.springs_of(list(self.by_name.values()))
        return self._springs

    def broken(self) -> list[tuple[str, float]]:
        """Return the joints that have given more than they can bear, and how much [N]."""
        # A body that flew leads by half a step, which the first step of its joint takes back: that
        # is no load.
        if self._table is None or self._was_changed:
            return []
        return [
            (held.joint.name, given / self._dt)
            for held, most in self._table.breakable
            if (given := held.impulse) > most
        ]

    def _constraints(self) -> list[pymunk.Constraint]:
        return [*itertools.chain(*(held.constraints for held in self.by_name.values()))]

    def _build(self, joint: Joint) -> None:
        other = None if joint.b == WORLD else self._bodies[joint.b]
        held = build(joint, self._bodies[joint.a], other, self._space.static_body)
        self._space.add(*held.constraints)
        self._forget()
        self.by_name[joint.name] = held

    def _take(self, held: EngineJoint) -> None:
        self._space.remove(*held.constraints)
        for body in (held.joint.a, held.joint.b):
            self._on[body].pop(held.joint.name, None)
            if not self._on[body]:
                del self._on[body]
        self._forget()

    def _forget(self) -> None:
        """Give up what is known of all joints together, as one of them comes or goes."""
        self._table = self._springs = None
        self._changed = True

    def _tabulated(self) -> _Table:
        if self._table is None:
            held = list(self.by_name.values())
            self._table = _Table(held, self._space.static_body, self._dt)
        return self._table

    def _rows(self, listed: Sequence[RigidBody | None]) -> Rows:
        return self._tabulated().rows(listed)


def _with_background(rows: Floats) -> Floats:
    """Return a row for each body and a row of zeros for the background."""
    return np.concatenate((rows, np.zeros((1, rows.shape[1]))))


class _Table:
    """
    All joints of a set as arrays, until one comes or goes.

    :param joints: of the set
    :param background: of the space
    :param dt: of a step [s]

    :ivar breakable: joints that can break, and the most that each may give [N s]
    """

    def __init__(self, joints: Sequence[EngineJoint], background: pymunk.Body, dt: float) -> None:
        self._dt = dt
        held = [(number, each) for number, each in enumerate(joints) if each.constraints]
        self.breakable = [
            (each, most * dt)
            for _, each in held
            if (most := each.joint.properties.break_force) is not None
        ]
        exact = [(number, each) for number, each in held if _kind(each.joint).rows]
        self._yielding = [
            (number, each, most * dt * _ALL)
            for number, each in exact
            if (most := each.joint.properties.max_force) is not None
        ]
        ends = (body for _, each in exact for body in (each.ends.a, each.ends.b))
        self._members = [each for each in dict.fromkeys(ends) if each is not background]
        dynamic = [each.body_type == pymunk.Body.DYNAMIC for each in self._members]
        self._pushed = np.flatnonzero(dynamic)
        self._numbers = engine_memory.numbers_of(itertools.compress(self._members, dynamic))
        inverse = np.zeros((len(self._members) + 1, 3))
        for row in self._pushed.tolist():
            body = self._members[row]
            inverse[row] = 1.0 / body.mass, 1.0 / body.mass, 1.0 / body.moment
        rows = {body: row for row, body in enumerate((*self._members, background))}
        self._batches = [*_batches(exact, rows)]
        projected = [(batch, kind.rows) for kind, batch in self._batches if kind.rows]
        self._projection = Projection(projected, inverse, dt)
        self._listed: Sequence[RigidBody | None] = ()
        self._places: Rows = np.empty(0, np.intp)

    def rows(self, listed: Sequence[RigidBody | None]) -> Rows:
        """Return the rows of the jointed bodies in the engine's listing, then the background."""
        if self._listed is not listed:
            places = {each.engine: place for place, each in enumerate(listed) if each is not None}
            members = (places[body] for body in self._members)
            self._places, self._listed = np.array([*members, len(listed)], np.intp), listed
        return self._places

    def aim(self, states: Floats) -> None:
        """Set what constraints are solved for; `states` (b, 6) float64, of the jointed bodies."""
        dt = self._dt
        # The engine moves bodies first.
        moved = states.copy()
        moved[:, :3] += states[:, 3:] * dt
        # The term is of first order in w dt: beyond it would be noise that feeds itself.
        moved[:, 5] = np.where(np.abs(states[:, 5] * dt) > _FAST_TURN, 0.0, states[:, 5])
        pull = (1.0 - np.cos(moved[:, 5] * dt)) / dt
        for kind, batch in self._batches:
            if kind.aim is not None:
                a, b = batch.a, batch.b
                both = np.stack((pull[a], pull[b]), axis=1)
                kind.aim(batch, Motion(moved[a], moved[b], both, dt))

    def correct(self, poses: Floats) -> None:
        """Correct (b, 3) float64 poses of the jointed bodies in place."""
        # As the next step would, so that it begins where it was aimed for.
        poses[self._pushed] += engine_memory.take_pushes(self._numbers) * self._dt
        yielded = [number for number, held, most in self._yielding if held.impulse >= most]
        self._projection.close(poses, yielded)


def build(joint: Joint, a: RigidBody, b: RigidBody | None, background: pymunk.Body) -> EngineJoint:
    """
    Make the constraints of a joint, outside any space.

    Pymunk divides by the sum of inverse masses, so that of two bodies neither of which is dynamic
    there are none; such a joint waits until one of them is.

    :param a: the first body
    :param b: the second one; None is the background
    :param background: the engine's own
    """
    seat = joint.seat
    at_b = (seat.bx, seat.by) if b is None else (seat.bx - b.offset[0], seat.by - b.offset[1])
    if joint.kind is JointKind.SLIDER and slider.has_no_way(joint):
        at_b = slider.stop(joint, at_b)
    ends = Ends(
        a=a.engine,
        b=background if b is None else b.engine,
        at_a=(seat.ax - a.offset[0], seat.ay - a.offset[1]),
        at_b=at_b,
    )
    if a.body.fixed and (b is None or b.body.fixed):
        return EngineJoint(joint, ends, ())
    constraints = tuple(_kind(joint).constraints(joint, ends))
    for constraint in constraints:
        most = joint.properties.max_force
        if most is not None and not isinstance(constraint, pymunk.SimpleMotor):
            constraint.max_force = most
        # With the background, which is the walls of `bounds` too, a body always collides.
        constraint.collide_bodies = joint.collide or b is None
    return EngineJoint(joint, ends, constraints)


def _kind(joint: Joint) -> Kind:
    if joint.kind is JointKind.SLIDER and slider.has_no_way(joint):
        return pin.KIND
    return _KINDS[joint.kind]


def _batches(
    joints: Iterable[tuple[int, EngineJoint]], rows: Mapping[pymunk.Body, int]
) -> Iterable[tuple[Kind, Batch]]:
    """Yield joints by kind and number of rows, in an order that depends on these alone."""
    sorts: dict[tuple[int, int], list[tuple[int, EngineJoint]]] = {}
    order = list(_KINDS.values())
    for number, held in joints:
        kind = _kind(held.joint)
        sort = order.index(kind), len(kind.bounds(held.joint))
        sorts.setdefault(sort, []).append((number, held))
    for (kind_number, _), some in sorted(sorts.items()):
        kind = order[kind_number]
        group = [each for _, each in some]
        seats = [(each.joint.seat.ux, each.joint.seat.uy) for each in group]
        bounds = np.array([kind.bounds(each.joint) for each in group], np.float64)
        yield (
            kind,
            Batch(
                numbers=np.array([number for number, _ in some], np.intp),
                a=np.array([rows[each.ends.a] for each in group], np.intp),
                b=np.array([rows[each.ends.b] for each in group], np.intp),
                at_a=np.array([each.ends.at_a for each in group], np.float64),
                at_b=np.array([each.ends.at_b for each in group], np.float64),
                axis=np.array(seats, np.float64),
                ratio=np.array([each.joint.number('ratio') for each in group], np.float64),
                lower=bounds[:, :, 0],
                upper=bounds[:, :, 1],
                constraints=[each.constraints[0]._constraint for each in group],
            ),
        )
