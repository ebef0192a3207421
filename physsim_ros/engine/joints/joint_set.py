# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The joints of a space: added, removed, and read after a step; the core solves them.

Laws: a joint is removed with either of its bodies; a body whose engine objects are made anew keeps
its joints; a joint that exceeds its break force is removed after that step; impulses are those of
the engine; a `max_force` that is not reached changes nothing.
"""

from __future__ import annotations

from collections.abc import Generator, Iterable, Mapping
from dataclasses import replace
import itertools
import math

import numpy as np
from numpy.typing import NDArray
from physsim_ros.engine.bodies import RigidBody
from physsim_ros.engine.coming import ComingCommands
from physsim_ros.engine.core import lib
from physsim_ros.engine.core_world import CoreWorld
from physsim_ros.engine.joints import stiffness
from physsim_ros.engine.joints.joint_table import check_joint, JointTable, slices_of_records
from physsim_ros.engine.joints.kinds import build_joint, EngineJoint
from physsim_ros.model.arrays import Flags, Floats
from physsim_ros.model.motor_command import MotorCommand, TimedCommand
from physsim_ros.model.scene import Joint
from physsim_ros.model.shapes import LARGEST
from physsim_ros.model.snapshot import Springs
from physsim_ros.model.transform import Pose
from physsim_ros.runtime.slices import finish
import pymunk

# The report of no joints, which frames share (`JointSet.report`).
NO_REPORT = np.empty(0), np.empty((0, 2)), np.empty(0, np.bool_)


class JointSet:
    """
    Joints in the engine.

    :param pm_space: of the engine
    :param bodies: the bodies of the space by name
    :param core: of the space
    :param dt: length of a sub-step [s]

    :ivar by_name: the joints, by name, in the order in which they were made
    :ivar commands: the last command of each motor, by the name of its joint, and its step
    :ivar coming: commands that motors do not obey yet, by the names of their joints
    """

    def __init__(
        self,
        pm_space: pymunk.Space,
        bodies: Mapping[str, RigidBody],
        core: CoreWorld,
        dt: float,
    ) -> None:
        self.by_name: dict[str, EngineJoint] = {}
        self._pm_space = pm_space
        self._bodies = bodies
        self._dt = dt
        # Names of the joints of each body.
        self._on: dict[str, dict[str, None]] = {}
        # Number of each joint, in the order of `by_name`.
        self._serials: dict[str, int] = {}
        self._next_serial = 0
        self._table: JointTable | None = None
        self._core = core
        self._springs: Springs | None = None
        # Names of the joints whose first step was to come when the table was dropped.
        self._unstepped: set[str] = set()
        # The impulses of each joint in the step before, by name, from the same table.
        self._totals: dict[str, Floats] = {}
        self.commands: dict[str, TimedCommand] = {}
        self.coming: ComingCommands[TimedCommand] = ComingCommands()
        # The bounds of the rows of each joint that has one which moves, by name, likewise.
        self._bounds: dict[str, NDArray[np.void]] = {}

    def names_on(self, body: str) -> tuple[str, ...]:
        """Return the names of a body's joints, in the order in which they were made."""
        return tuple(sorted(self._on.get(body, ()), key=self._serials.__getitem__))

    def has_joints(self, body: str) -> bool:
        """Return whether a body has joints."""
        return body in self._on

    def count_on(self, body: str, joint: Joint) -> int:
        """Return the count of a body's joints after a joint on it is added or replaced."""
        names = self._on.get(body, {})
        return len(names) + (joint.name not in names)

    def with_turns(self, rigid: RigidBody, pose: Pose) -> Pose:
        """Return a pose with the whole turns that a jointed body has made, which joints count."""
        if not self.has_joints(rigid.body.name):
            return pose
        turns = round((rigid.pm_body.angle - pose[2]) / math.tau)
        return pose[0], pose[1], pose[2] + turns * math.tau

    def add(self, joint: Joint) -> None:
        """Add a joint; it replaces one of that name in its place."""
        old = self.by_name.get(joint.name)
        if old is not None:
            self._remove_constraints(old)
            if (old.joint.kind, old.joint.a, old.joint.b) != (joint.kind, joint.a, joint.b):
                self._totals.pop(joint.name, None)
                self._drop_commands(joint.name)
            if _reference(old.joint) != _reference(joint):
                self._bounds.pop(joint.name, None)
        self._add_constraints(joint)
        for body in joint.bodies:
            self._on.setdefault(body, {})[joint.name] = None
        self._serials.setdefault(joint.name, self._next_serial)
        self._next_serial += 1

    def remove(self, name: str) -> None:
        """Remove a joint for good."""
        self._remove_constraints(self.by_name[name])
        self._totals.pop(name, None)
        self._drop_commands(name)
        self._bounds.pop(name, None)
        del self.by_name[name], self._serials[name]

    def take_out(self, count: int) -> None:
        """Remove about a number of the last constraints, before the bodies are used elsewhere."""
        self._drop_table()
        while self.by_name and count > 0:
            constraints = self.by_name.popitem()[1].constraints
            self._pm_space.remove(*reversed(constraints))
            count -= max(1, len(constraints))

    def __del__(self) -> None:
        """Remove all joints before Pymunk frees the space: it takes the square of their number."""
        # The last one first, which is the first in Chipmunk's list of those of the background.
        self._pm_space.remove(*reversed(self._constraints()))

    def check(self, names: Iterable[str]) -> None:
        """Make what steps need of joints, so that an error in it refuses the request for them."""
        for name in names:
            joint = self.by_name[name].joint
            ends = [end for end in (joint.a, joint.b) if end in self._bodies]
            bodies = {end: self._bodies[end].body for end in ends}
            check_joint(self.by_name[name], bodies, self._dt)

    def detach(self, body: str) -> None:
        """Remove the joints of a body from the engine, before its engine objects are replaced."""
        for name in self.names_on(body):
            engine_joint = self.by_name[name]
            self._pm_space.remove(*engine_joint.constraints)
            self.by_name[name] = EngineJoint(engine_joint.joint, engine_joint.ends, ())
        self._drop_table()

    def attach(self, body: str) -> None:
        """Put the joints of a body back into the engine."""
        for name in self.names_on(body):
            self._add_constraints(self.by_name[name].joint)

    def slices_of_table(self) -> Generator[None]:
        """Make the table that the core is to step, if there is none; yield after each slice."""
        if self._table is not None or not self.by_name:
            return
        joints, slices = list(self.by_name.values()), []
        for some in slices_of_records(joints, self._unstepped, self._soft_springs(), self._dt):
            slices.append(some)
            yield
        self._table = JointTable(joints, slices, self._totals)
        self._table.set_bounds(self._bounds)
        for command, begun in self.commands.values():
            self._table.command(command, begun)

    def use_places(self, places: Mapping[pymunk.Body, int]) -> None:
        """
        Have the core step these joints.

        :param places: of bodies in the table of bodies, the background among them
        """
        finish(self.slices_of_table())
        if self._table is None:
            return
        self._table.place_ends(places)
        table = self._table
        # The core marks the bodies that motors hold as it takes over the joints.
        self._core.use(motors=table.motors)
        self._core.use_joints(table.joints, table.parts, table.rows, table.guides)

    def command(self, command: MotorCommand, begun: int) -> None:
        """
        Have the motor of a joint obey a command, in place of its last one.

        :param begun: step at which the command began
        """
        self.commands[command.joint] = TimedCommand(command, begun)
        if self._table is not None:
            self._table.command(command, begun)

    @property
    def all_commands(self) -> tuple[TimedCommand, ...]:
        """Return the command that each motor obeys, then those on their way to it."""
        return tuple(
            command
            for name in self.by_name
            for command in (*filter(None, [self.commands.get(name)]), *self.coming.of(name))
        )

    def set_commands(self, commands: Iterable[TimedCommand], step: int) -> None:
        """
        Set the commands that motors obey or, where they do not begin before a step, are to obey.

        :param step: count of steps that the world has made
        """
        self.coming = ComingCommands()
        for command in commands:
            if command.begun < step:
                self.command(*command)
            else:
                self.coming.add(command.command.joint, command)

    def _drop_commands(self, name: str) -> None:
        self.commands.pop(name, None)
        self.coming.put(name, ())

    def _soft_springs(self) -> dict[str, float]:
        """Return the dampings of the springs that Chipmunk does not solve, by name."""
        springs = [
            each.joint for each in self.by_name.values() if each.joint.is_elastic and each.parts
        ]
        bodies = {name: rigid.body for name, rigid in self._bodies.items()}
        dampings = stiffness.dampings_of(springs, bodies, self._dt)
        named = zip(springs, dampings, strict=True)
        return {spring.name: damping for spring, damping in named if damping > 0.0}

    def report(self) -> tuple[Floats, Floats, Flags]:
        """
        Return what joints did in the last step.

        :return: (j,) float64: force of each [N]; (j, 2) float64: force on its body b [N]; (j,)
            bool: whether it pushed its bodies apart
        """
        if not self.by_name:
            return NO_REPORT
        impulses, pulls, pressing = self._core.read_joints()
        step = self._dt * lib.SUB_STEPS
        return impulses / step, pulls / step, pressing

    def impulses(self) -> Floats:
        """Return (c, 2) float64: impulses from which the next step starts, of all constraints."""
        return self._core.read_impulses()

    def set_impulses(self, impulses: Floats) -> None:
        """Set (c, 2) float64: impulses from which the next step starts; none of another number."""
        if len(impulses) == len(self._constraints()):
            self._core.write_impulses(impulses)

    def totals(self) -> Floats:
        """Return (c, 2) float64: impulses of the last step, of all constraints."""
        return np.empty((0, 2)) if self._table is None else self._table.parts['total'].copy()

    def set_totals(self, totals: Floats) -> None:
        """Set (c, 2) float64: impulses of the last step; none of another number."""
        if self._table is not None and len(totals) == len(self._table.parts):
            self._table.parts['total'] = totals

    def bounds(self) -> dict[str, NDArray[np.void]]:
        """Return `lower` and `upper` of the rows of each joint that has one which moves."""
        return dict(self._bounds) if self._table is None else self._table.bounds

    def set_bounds(self, bounds: Mapping[str, NDArray[np.void]]) -> None:
        """Set the bounds of joints, by name."""
        self._drop_table()
        self._bounds = dict(bounds)

    def drawn_now(self) -> tuple[Joint, ...]:
        """Return the joints as they would be drawn now: a winch has its present length."""
        bounds = self.bounds()
        return tuple(
            replace(
                joint,
                # Drawn between bodies far away, it may be longer than a length that is set.
                properties=replace(
                    joint.properties, length=min(float(bounds[name]['upper'][-1]), LARGEST)
                ),
            )
            if name in bounds
            else joint
            for name, each in self.by_name.items()
            for joint in (each.joint,)
        )

    def unstepped(self) -> frozenset[str]:
        """Return the names of the joints whose first step is to come."""
        unstepped = self._unstepped if self._table is None else self._table.unstepped
        return frozenset(unstepped & self.by_name.keys())

    def set_unstepped(self, names: Iterable[str]) -> None:
        """Set the names of the joints whose first step is to come."""
        self._drop_table()
        self._unstepped = set(names)

    def springs(self) -> Springs:
        """Return the springs among the joints."""
        if self._springs is None:
            self._springs = stiffness.springs_of(list(self.by_name.values()))
        return self._springs

    def broken(self) -> list[tuple[str, float]]:
        """Return the joints that broke in the last step, and the force of each in it [N]."""
        if self._table is None or not (broken := self._table.broken):
            return []
        names, forces = self._table.names, self.report()[0].tolist()
        return [(names[number], forces[number]) for number in broken]

    def _constraints(self) -> list[pymunk.Constraint]:
        return [
            *itertools.chain(*(engine_joint.constraints for engine_joint in self.by_name.values()))
        ]

    def _add_constraints(self, joint: Joint) -> None:
        engine_joint = build_joint(joint, self._bodies, self._pm_space.static_body)
        self._pm_space.add(*engine_joint.constraints)
        self._drop_table()
        self.by_name[joint.name] = engine_joint
        self._unstepped.add(joint.name)

    def _remove_constraints(self, engine_joint: EngineJoint) -> None:
        self._pm_space.remove(*engine_joint.constraints)
        for body in engine_joint.joint.bodies:
            self._on[body].pop(engine_joint.joint.name, None)
            if not self._on[body]:
                del self._on[body]
        self._drop_table()

    def _drop_table(self) -> None:
        """Drop the table of all joints, as one of them comes or goes."""
        if self._table is not None:
            self._unstepped, self._totals = self._table.unstepped, self._table.totals
            self._bounds = self._table.bounds
        self._table = self._springs = None
        self._core.drop_joints()


def _reference(joint: Joint) -> tuple[object, ...]:
    """Return the fields of a joint from which its bounds, where they move, began."""
    return joint.kind, joint.a, joint.b, joint.seat, joint.guides, joint.rest_length
