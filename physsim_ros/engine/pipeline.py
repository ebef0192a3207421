# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The pipeline: one step of the engine, stage by stage in this order.

1. Wrenches: the forces of commands are set for the step.
2. Half-step velocity: bodies that have lost their support fall freely, without old impulses.
3. Mouse joints: the forces of hands are added.
4. Resting damping: the solver's error is removed from what friction locks in place.
5. Floor: bodies are pulled to the velocity of the floor under them; robots drive.
6. Continuous collision: fast bodies are advanced to where they first touch something.
7. Tight boxes: fast bodies keep small boxes in the engine's broad phase, so that only nearby pairs
   are listed.
8. Joints: constraints are prepared for the poses of the step.
9. Pymunk moves bodies, and finds contacts (broad and narrow phase).
10. First touch: contacts that begin get the normal and the depth of their impact.
11. Impact propagation: elastic contacts next to a faster impact are deferred.
12. Block solver: points that are hit at once are solved together.
13. Pymunk solves velocities, and puts islands to sleep.
14. Joints: rows of joints and of contacts on jointed bodies are solved together, in velocities
    and positions.
15. Floor: the push of contacts and joints is kept for the next step; odometry.
16. Half-step velocity: bodies in free flight are found.
17. Sleeping: bodies that fly or swing slowly stay awake.
18. Contact report: impulses are added up.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

from physsim_ros.engine.batch_io import BatchIO
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.ccd.continuous import ContinuousCollision
from physsim_ros.engine.ccd.hulls import Hulls
from physsim_ros.engine.contacts.contact_report import ContactReport
from physsim_ros.engine.core_world import CoreWorld
from physsim_ros.engine.stages.block_solver import BlockSolver
from physsim_ros.engine.stages.first_touch import correct_first_touches
from physsim_ros.engine.stages.floor import Floor
from physsim_ros.engine.stages.half_step import HalfStep
from physsim_ros.engine.stages.impact_propagation import ImpactPropagation
from physsim_ros.engine.stages.mouse_joints import MouseJoints
from physsim_ros.engine.stages.resting_damping import RestingDamping
from physsim_ros.engine.stages.sleeping import keep_flying_awake, keep_swinging_awake
from physsim_ros.engine.stages.tight_boxes import tighten_boxes
from physsim_ros.engine.stages.wrenches import Wrenches
from physsim_ros.engine.step_context import StepContext
from physsim_ros.engine.warm_start import clear_impulses, ShapeIds
import pymunk


class Pipeline:
    """
    The stages of a space.

    :param pm_space: Pymunk's space
    :param io: reads and writes its arrays
    :param shapes: numbers of its shapes
    :param bodies: the bodies in it, by name
    :param core: the core's part of it
    :param dt: length of a step [s]
    """

    def __init__(
        self,
        pm_space: pymunk.Space,
        io: BatchIO,
        shapes: ShapeIds,
        bodies: Mapping[str, RigidBody],
        core: CoreWorld,
        *,
        dt: float,
    ) -> None:
        self.wrenches = Wrenches()
        self.mouse_joints = MouseJoints(bodies)
        self.half_step = HalfStep(pm_space, io)
        self.resting_damping = RestingDamping(io, dt)
        self.floor = Floor(dt)
        self.continuous_collision = ContinuousCollision(pm_space, Hulls())
        self._impact_propagation = ImpactPropagation(pm_space, io)
        self._block_solver = BlockSolver(pm_space)
        self.contact_report = ContactReport(io)
        self._core = core
        self._pm_space = pm_space
        self._hook = PreSolveHook(pm_space)
        self._shapes = shapes
        self._dt = dt

    def step(
        self,
        table: BodyTable,
        *,
        number: int,
        age: int,
        reports_contacts: bool,
    ) -> None:
        """
        Make a step.

        :param table: the bodies
        :param number: number of steps that the world has made
        :param age: count of steps since the space was built
        :param reports_contacts: whether contacts are reported
        """
        self.wrenches.apply_wrenches()
        unsupported = self.half_step.begin_step(table)
        if unsupported:
            clear_impulses(self._shapes, [table.bodies[row] for row in unsupported])
        state = table.state.copy()
        context = StepContext(
            table, self._dt, number, age, reports_contacts, state[:, :3], state[:, 3:]
        )
        self.mouse_joints.apply_forces(context)
        self.resting_damping.damp_resting(context)
        self.floor.pull_bodies(context)
        self.continuous_collision.clamp_moves(context)
        tighten_boxes(context)
        self._core.prepare_joints()
        self._hook.step(self._dt, lambda: self._before_solving(context))
        table.forget_state()
        self._core.solve_joints()
        self.floor.end_step(context)
        self.half_step.find_free(context)
        keep_flying_awake(context)
        keep_swinging_awake(context)
        if reports_contacts:
            self.contact_report.add_step(table)
        else:
            self.contact_report.skip_step()

    def _before_solving(self, context: StepContext) -> None:
        """Correct the contacts that the engine has found, before it solves them."""
        touches = correct_first_touches(self._pm_space, context)
        self._impact_propagation.defer_contacts(context.table)
        if touches is None:
            return
        self._block_solver.solve_impacts(touches)
        if context.reports_contacts:
            self.contact_report.add_first_touches(touches)


class PreSolveHook:
    """
    A step of the engine with a call between its narrow phase and its solver.

    At that moment all contacts of the step are known, with their target velocities, and none has
    been solved. Pymunk 7.3.1 has no hook there: `Space.on_collision(pre_solve=...)` calls Python
    once a pair of shapes, while pairs are still being found, which doubles the time of a step.
    Constraints have one: `cpSpaceStep` calls `Constraint.pre_solve` after `cpArbiterPreStep` of
    all contacts. The hook is a constraint that does nothing else; it can go once Pymunk has a
    callback of the space there.

    :param pm_space: of the engine
    """

    def __init__(self, pm_space: pymunk.Space) -> None:
        self._pm_space = pm_space
        # A massive body outside the space, whose angle stays 0 and within the limits.
        body = pymunk.Body(1.0, 1.0)
        constraint = pymunk.RotaryLimitJoint(pm_space.static_body, body, -1.0, 1.0)
        constraint.pre_solve = lambda *_: self._before_solving()
        pm_space.add(constraint)
        self._before_solving: Callable[[], None] = _do_nothing

    def step(self, dt: float, before_solving: Callable[[], None]) -> None:
        """
        Make a step of the engine, with a call before its contacts are solved.

        Steps that are made elsewhere, as for a warm start, have no such call.
        """
        self._before_solving = before_solving
        self._pm_space.step(dt)
        self._before_solving = _do_nothing


def _do_nothing() -> None:
    pass
