# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The pipeline: one step of the engine, stage by stage in this order.

1. Wrenches: the forces of commands are set for the step.
2. Half-step velocity: bodies that have lost their support fall freely, without old impulses.
3. Mouse joints: the forces of hands are added.
4. Resting damping: the solver's error is removed from what friction locks in place.
5. Continuous collision: fast bodies are advanced to where they first touch something.
6. Tight boxes: the engine's broad phase is told where fast bodies of a crowd will be.
7. Joints: constraints are put where the step needs them.
8. Pymunk's step: positions, narrow phase, solver, sleeping. In the middle of it: false contacts
   are rejected, contact normal at impact, internal edges and contact projection as two shapes
   begin to touch, and impact propagation and the block solver before the solver runs.
9. Joints: rows of joints and of contacts on jointed bodies are solved together, in velocities
   and positions.
10. Half-step velocity: free flight is found, and does not fall asleep.
11. Contact report: impulses are added up.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping

from physsim_ros.engine.batch_io import BatchIO
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.ccd.continuous import ContinuousCollision
from physsim_ros.engine.ccd.hulls import Hulls
from physsim_ros.engine.contacts.contact import read_contact, write_contact
from physsim_ros.engine.contacts.contact_report import ContactReport
from physsim_ros.engine.contacts.side import read_sides
from physsim_ros.engine.joints.joint_set import JointSet
from physsim_ros.engine.stages.block_solver import BlockSolver
from physsim_ros.engine.stages.contact_normal import contact_at_impact
from physsim_ros.engine.stages.contact_projection import project_contact
from physsim_ros.engine.stages.false_contacts import FalseContacts
from physsim_ros.engine.stages.half_step import HalfStep
from physsim_ros.engine.stages.impact_propagation import ImpactPropagation
from physsim_ros.engine.stages.internal_edges import InternalEdges
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

    :param engine: Pymunk's space
    :param io: of it
    :param shapes: numbers of its shapes
    :param bodies: in it, by name
    :param joints: in it
    :param dt: of a step [s]
    """

    def __init__(
        self,
        engine: pymunk.Space,
        io: BatchIO,
        shapes: ShapeIds,
        bodies: Mapping[str, RigidBody],
        joints: JointSet,
        *,
        dt: float,
    ) -> None:
        self.wrenches = Wrenches()
        self.mouse_joints = MouseJoints(bodies)
        self.half_step = HalfStep(engine, io)
        self.resting_damping = RestingDamping(io, dt)
        hulls = Hulls()
        self.continuous_collision = ContinuousCollision(engine, hulls)
        self.impact_propagation = ImpactPropagation(engine, io)
        self._block_solver = BlockSolver(engine)
        self.contact_report = ContactReport(io)
        self._false_contacts = FalseContacts(hulls)
        self._internal_edges = InternalEdges(hulls)
        self._joints = joints
        self._engine = engine
        self._shapes = shapes
        # The step that is being made; None between steps.
        self._context: StepContext | None = None
        # Pieces of bodies that contact projection has placed anew in this step.
        self._placed: Counter[pymunk.Body] = Counter()
        engine.on_collision(begin=self._begin_contact)

    def step(self, context: StepContext) -> None:
        """Make a step."""
        table = context.table
        self.wrenches.apply_wrenches()
        unsupported = self.half_step.begin_step(table)
        if unsupported:
            clear_impulses(self._shapes, [table.bodies[row] for row in unsupported])
        context.poses, context.twists = table.state[:, :3], table.state[:, 3:]
        self.mouse_joints.apply_forces(context)
        self.resting_damping.damp_resting(context)
        self.continuous_collision.clamp_moves(context)
        tighten_boxes(context)
        self._joints.begin_step(context)
        self._context, self.impact_propagation.table = context, table
        self._placed.clear()
        self._false_contacts.begin_step()
        self._engine.step(context.dt)
        self._context = self.impact_propagation.table = None
        table.forget_state()
        self._joints.end_step(context)
        self.half_step.find_free(context)
        keep_flying_awake(context)
        keep_swinging_awake(context)
        if context.watching:
            self.contact_report.add_step(table)
        else:
            self.contact_report.skip_step()

    def forget_body(self, engine_id: int) -> None:
        """Drop the state of a removed body, or of the background where its walls are replaced."""
        self.contact_report.forget_body(engine_id)

    def _begin_contact(self, arbiter: pymunk.Arbiter, space: pymunk.Space, _: object) -> None:
        """Handle two shapes that begin to touch, before the solver runs."""
        if self._context is None:
            return
        contact, sides = read_contact(arbiter), read_sides(arbiter)
        if self._false_contacts.reject(arbiter, contact, sides):
            return
        if not (sides[0].shape.sensor or sides[1].shape.sensor):
            found = contact
            contact = contact_at_impact(contact, sides, self._context) or contact
            contact = self._internal_edges.slide_over(contact, sides) or contact
            if contact is not found:
                write_contact(arbiter, contact)
            project_contact(contact, sides, space, self._placed)
            self._block_solver.add_contact(arbiter, contact, sides)
        if self._context.watching:
            self.contact_report.add_first_touch(contact, sides)
