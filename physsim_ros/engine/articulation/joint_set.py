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
The joints of a space: made, taken apart and held together.

Laws: a joint goes with either of its bodies; a body whose engine objects are made anew keeps its
joints; a joint that gives more than it can bear is gone after that step, and told of.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
import math
import operator
from typing import NamedTuple

import numpy as np
from physsim_ros.engine import joints
from physsim_ros.engine.articulation.contact_coupling import Loads
from physsim_ros.engine.articulation.energy_limiter import Balance
from physsim_ros.engine.articulation.solver import Linkage
from physsim_ros.engine.batch_io import EngineArrays
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.islands import Rows
from physsim_ros.engine.joints import EngineJoint
from physsim_ros.model.arrays import Floats
from physsim_ros.model.joints import JointKind
from physsim_ros.model.names import WORLD
from physsim_ros.model.scene import Body, Joint
from physsim_ros.model.snapshot import Springs
import pymunk

# The roughest that the engine's own attempt may be with all bodies together [m/s²].
_ROUGHEST = 60.0


class _Known(NamedTuple):
    """
    What holds joints, and what it was made of.

    :ivar parts: the joints, each followed by its bodies
    :ivar linkage: knows these by their numbers alone, so that it serves any space
    """

    parts: tuple[Joint | Body | None, ...]
    linkage: Linkage

    def is_of(self, parts: tuple[Joint | Body | None, ...]) -> bool:
        """Tell whether it was made of the same, not only of what is alike."""
        return len(self.parts) == len(parts) and all(map(operator.is_, self.parts, parts))


class Machine:
    """
    Joints in the engine.

    :param space: of the engine
    :param arrays: of it
    :param bodies: by name; kept by the space
    :param dt: of a step [s]
    :param before: of another space, whose joints may be the same; None is none
    """

    def __init__(
        self,
        space: pymunk.Space,
        arrays: EngineArrays,
        bodies: Mapping[str, RigidBody],
        dt: float,
        *,
        before: Machine | None = None,
    ) -> None:
        self.joints: dict[str, EngineJoint] = {}
        self._space = space
        self._arrays = arrays
        self._bodies = bodies
        self._dt = dt
        # Names of the joints of each body.
        self._on: dict[str, dict[str, None]] = {}
        self._linkage: Linkage | None = None
        # Those of the joints, where they are known.
        self._springs: Springs | None = None
        # What holds the joints, or held those of the space before.
        self.known: _Known | None = None if before is None else before.known
        # The bodies that are joined, and their places in the listing, the background's last.
        self._members: dict[pymunk.Body, int] = {}
        self._places: Rows = np.empty(0, np.intp)
        # What each joint gave beside the engine in the last step [N s].
        self._impulses: Floats = np.empty(0)
        self._loads: Loads | None = None
        self._balance: Balance | None = None
        self._listed: Sequence[RigidBody | None] = ()
        # What each joint gave [N] in a step that another space has made, until this one makes one.
        self._given: dict[str, float] | None = None
        # What each gave beside the engine in the last step [N s], before others came or went.
        self._beside: dict[str, float] = {}
        # Whether the linkage has not been through a step, and whether the last one was its first.
        self._fresh = self._first_step = True
        # Numbers of the joints that can break, and what each may give [N s].
        self._breakable: list[tuple[int, float]] = []

    def of(self, body: str) -> tuple[str, ...]:
        """Return the names of a body's joints, in the order in which they were made."""
        return tuple(name for name in self.joints if name in self._on.get(body, ()))

    def has(self, body: str) -> bool:
        """Tell whether a body has joints."""
        return body in self._on

    def put(self, joint: Joint) -> None:
        """Take in a joint; it replaces one of that name in its place."""
        old = self.joints.get(joint.name)
        if old is not None:
            self._take(old)
        self._build(joint)
        for body in (joint.a, joint.b):
            self._on.setdefault(body, {})[joint.name] = None

    def remove(self, name: str) -> None:
        """Take a joint out for good."""
        held = self.joints[name]
        self._take(held)
        del self.joints[name]

    def clear(self) -> None:
        """Take all joints out of the engine, before its bodies serve another one."""
        for held in self.joints.values():
            self._space.remove(*held.constraints)
        self._unlink()
        self.joints.clear()
        self._on.clear()

    def detach(self, body: str) -> None:
        """Take the joints of a body out of the engine, before its engine objects go."""
        for name in self.of(body):
            held = self.joints[name]
            self._space.remove(*held.constraints)
            self.joints[name] = EngineJoint(held.joint, held.ends, ())
        self._unlink()

    def attach(self, body: str) -> None:
        """Put the joints of a body back into the engine."""
        for name in self.of(body):
            self._build(self.joints[name].joint)

    def hold(
        self,
        listed: Sequence[RigidBody | None],
        states: Floats,
        before: Floats,
        *,
        driven: bool,
    ) -> bool:
        """
        Hold after a step what the engine has not held in it.

        :param listed: the bodies in the engine's listing
        :param states: (m + 1, 6) float64: their poses and velocities, then the background; kept
            up to date
        :param before: (m + 1, 3) float64: their velocities before the step
        :param driven: whether anything has given them energy since the last step, or in it
        :return: whether velocities have been moved
        """
        linkage = self._linked(listed)
        engine = states[:, 3:].copy()
        rows = states[self._places]
        moved = linkage.hold(rows)
        states[self._places, 3:] = rows[:, 3:]
        # Both made with the linkage.
        assert self._balance is not None and self._loads is not None  # noqa: S101, PT018
        if driven:
            self._balance.drive()
        moved |= self._balance.limit_energy(states)
        moved |= self._loads.carry(linkage, states, before, engine, self._space.static_body)
        self._impulses[:] = 0.0
        linkage.write_impulses(self._impulses)
        return moved

    def prepare(self, listed: Sequence[RigidBody | None], read: Callable[[], Floats]) -> None:
        """
        Get ready for a step, where something has changed since the last one.

        :param read: returns poses and velocities in the engine's listing, then the background,
            (m + 1, 6) float64
        """
        self._given = None
        linkage = self._linked(listed)
        self._first_step = self._fresh
        if self._fresh:
            self._spare(linkage.redundant(read()[self._places]))
            self._fresh = False

    def _spare(self, redundant: set[tuple[int, int]]) -> None:
        """
        Leave out of the engine's own attempt what says nothing new, and bound the rest.

        Near where joints say the same, as at the dead centre of a crank, the engine's impulses
        grow out of all measure; what it has not given, the linkage gives.
        """
        masses = (rigid.engine.mass for rigid in self._bodies.values() if not rigid.body.fixed)
        most = _ROUGHEST * math.fsum(masses)
        for number, held in enumerate(self.joints.values()):
            if held.exact:
                for place, constraint in enumerate(held.constraints):
                    if not isinstance(constraint, pymunk.SimpleMotor):
                        # Not removed: it also keeps the two bodies from colliding.
                        constraint.max_force = 0.0 if (number, place) in redundant else most

    def forces(self, listed: Sequence[RigidBody | None]) -> Floats:
        """Return (j,) float64: what each joint gave in the last step [N]."""
        if self._given is not None:
            return np.array([self._given.get(name, 0.0) for name in self.joints])
        if not self.joints:
            return np.empty(0)
        self._linked(listed)
        return (self._given_by_engine() + self._impulses) / self._dt

    def springs(self) -> Springs:
        """Return the springs, as the engine has them."""
        if self._springs is None:
            self._soften()
            self._springs = joints.springs_of(list(self.joints.values()))
        return self._springs

    def go_on_from(self, forces: Floats) -> None:
        """Take over what each joint gave in a step that another space has made, (j,) [N]."""
        self._given = dict(zip(self.joints, forces.tolist(), strict=True))

    def broken(self) -> list[tuple[str, float]]:
        """Return the joints that have given more than they can bear, and how much [N]."""
        # What was just let go of flies half a step ahead, which the first step takes back: that
        # is no load.
        if not self._breakable or self._linkage is None or self._first_step:
            return []
        held, beside = list(self.joints.values()), self._impulses
        return [
            (held[number].joint.name, given / self._dt)
            for number, most in self._breakable
            if (given := held[number].impulse + float(beside[number])) > most
        ]

    def _given_by_engine(self) -> Floats:
        """Return (j,) float64: what the engine's constraints gave in the last step [N s]."""
        return np.array([held.impulse for held in self.joints.values()])

    def _build(self, joint: Joint) -> None:
        other = None if joint.b == WORLD else self._bodies[joint.b]
        held = joints.build(joint, self._bodies[joint.a], other, self._space.static_body, self._dt)
        self._space.add(*held.constraints)
        self._forget(joint.name)
        self.joints[joint.name] = held

    def _take(self, held: EngineJoint) -> None:
        self._space.remove(*held.constraints)
        for body in (held.joint.a, held.joint.b):
            self._on[body].pop(held.joint.name, None)
            if not self._on[body]:
                del self._on[body]
        self._forget(held.joint.name)

    def _forget(self, name: str) -> None:
        """Forget what a joint gave, and what all of them hold: it has come or gone."""
        self._unlink()
        self._beside.pop(name, None)
        if self._given is not None:
            self._given.pop(name, None)

    def _unlink(self) -> None:
        """Give up what holds the joints, before one of them comes or goes."""
        if self._linkage is not None:
            self._beside = dict(zip(self.joints, self._impulses.tolist(), strict=True))
        self._linkage = self._springs = None

    def _linked(self, listed: Sequence[RigidBody | None]) -> Linkage:
        """Return what holds the joints, made anew where a body or a joint has come or gone."""
        if self._linkage is None:
            self._linkage = self._link()
            self._place(listed)
        elif self._listed is not listed:
            self._place(listed)
        return self._linkage

    def _link(self) -> Linkage:
        """Return what holds the joints: what is known already, where they are as they were."""
        self._soften()
        held = list(self.joints.values())
        parts = tuple(
            part
            for each in held
            for part in (each.joint, self._body(each.joint.a), self._body(each.joint.b))
        )
        ends = (body for each in held for body in (each.ends.a, each.ends.b))
        members = dict.fromkeys(body for body in ends if body is not self._space.static_body)
        self._members = {body: place for place, body in enumerate(members)}
        known = self.known
        if known is None or not known.is_of(parts):
            linkage = Linkage(held, self._members, len(members), self._dt)
            self.known = known = _Known(parts, linkage)
        self._impulses = np.array([self._beside.get(name, 0.0) for name in self.joints])
        self._fresh = True
        self._breakable = [
            (number, most * self._dt)
            for number, each in enumerate(held)
            if (most := each.joint.properties.break_force) is not None
        ]
        return known.linkage

    def _body(self, name: str) -> Body | None:
        """Return a body; None is the background."""
        return None if name == WORLD else self._bodies[name].body

    def _place(self, listed: Sequence[RigidBody | None]) -> None:
        """Find where in the engine's listing the bodies are."""
        places = {rigid.engine: place for place, rigid in enumerate(listed) if rigid is not None}
        count = len(listed)
        self._places = np.array([*(places[body] for body in self._members), count], np.intp)
        self._loads = Loads(self._arrays, listed, self._places)
        before, held = self._balance, list(self.joints.values())
        self._balance = Balance(held, places, count, gravity=self._space.gravity, dt=self._dt)
        same = len(self._listed) == count
        if before and same and all(map(operator.is_, self._listed, listed)):
            self._balance.follow(before)
        self._listed = listed

    def _soften(self) -> None:
        """Let no spring be stiffer than steps can follow."""
        springs = [
            held
            for held in self.joints.values()
            if held.joint.kind is JointKind.SPRING and held.constraints
        ]
        count = Counter(body for held in springs for body in (held.ends.a, held.ends.b))
        for held in springs:
            most = joints.stiffest(held.ends, count, self._dt)
            (spring,) = held.constraints
            assert isinstance(spring, pymunk.DampedSpring)  # noqa: S101 - what the table makes
            spring.stiffness = min(held.joint.stiffness, most)
