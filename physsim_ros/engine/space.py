# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Space: the bodies, joints and walls that are in the engine, and all that can be done to them.

Laws: a Pymunk object never leaves the engine's folder; true velocities do not jump when gravity or
a wrench changes.
"""

from __future__ import annotations

import math

import numpy as np
from physsim_ros.engine import body as rigid_body
from physsim_ros.engine.batch_io import BatchIO
from physsim_ros.engine.body import RigidBody, same_in_engine
from physsim_ros.engine.body_set import BodySet
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.boundary import Boundary
from physsim_ros.engine.core_world import CoreWorld
from physsim_ros.engine.joints.joint_set import JointSet
from physsim_ros.engine.pipeline import Pipeline
from physsim_ros.engine.settings import make_space
from physsim_ros.engine.stages.half_step import StartState
from physsim_ros.engine.stages.sleeping import wake_bodies
from physsim_ros.engine.warm_start import scale_impulses, ShapeIds
from physsim_ros.model.lesson import Lesson
from physsim_ros.model.robot_states import RobotStates
from physsim_ros.model.scene import Body, Joint, Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Grip
from physsim_ros.model.transform import NO_WRENCH, Point, Pose, REST, Twist, Wrench


class Space:
    """
    The bodies, joints and walls in the engine.

    :param settings: of the world
    :param dt: of a step [s]
    :param first_shape: number of the first wall of the boundary
    :param lesson: the task that belongs to the world; None is none

    :ivar pm_space: Pymunk's space
    :ivar bodies: in it
    :ivar joints: between them
    :ivar broken: joints that have broken, with the force at which each did [N]; its reader empties
        it
    :ivar changes: count of changes other than steps
    """

    def __init__(
        self,
        settings: WorldSettings,
        dt: float,
        *,
        first_shape: int = 0,
        lesson: Lesson | None = None,
    ) -> None:
        self.dt = dt
        self._lesson = lesson
        self.pm_space = make_space()
        self.shapes = ShapeIds(self.pm_space)
        self.shapes.following = first_shape
        self.bodies = BodySet(self.pm_space, self.shapes)
        self.boundary = Boundary(self.pm_space, self.shapes)
        self.core = CoreWorld(self.pm_space, dt)
        self.joints = JointSet(self.pm_space, self.bodies.by_name, self.core, dt)
        self._io = BatchIO(self.pm_space)
        self.pipeline = Pipeline(
            self.pm_space, self._io, self.shapes, self.bodies.by_name, self.core, dt=dt
        )
        self.broken: list[tuple[str, float]] = []
        self.changes = 0
        self._age = 0
        self._table: BodyTable | None = None
        self._settings = WorldSettings(gravity=(0.0, 0.0))
        self.configure(settings)

    @property
    def settings(self) -> WorldSettings:
        """Return the settings of the world."""
        return self._settings

    @property
    def age(self) -> int:
        """Return the count of steps made in this space."""
        return self._age

    @property
    def table(self) -> BodyTable:
        """Return the bodies by column."""
        return self._table or self.lay_out(
            Scene(
                bodies=tuple(rigid.body for rigid in self.bodies.by_name.values()),
                settings=self._settings,
                joints=tuple(held.joint for held in self.joints.by_name.values()),
                lesson=self._lesson,
            )
        )

    def lay_out(self, scene: Scene) -> BodyTable:
        """Return a new table of the bodies."""
        rigids, background = self.bodies.by_name.values(), self.pm_space.static_body
        self._table = BodyTable(scene, tuple(rigids), background, self._io, self.dt)
        self.core.use_bodies(self._table.records)
        self.lay_out_joints()
        return self._table

    def lay_out_joints(self) -> None:
        """Have the core step the joints that there are."""
        if self.joints.by_name:
            bodies = (*(rigid.pm_body for rigid in self.table.bodies), self.pm_space.static_body)
            self.joints.use_places({body: place for place, body in enumerate(bodies)})

    @property
    def start_state(self) -> StartState:
        """Return the state that the next step begins with."""
        return self.pipeline.half_step.start_state(self.table)

    def twist_of(self, rigid: RigidBody) -> Twist:
        """Return the true velocity of a body."""
        if rigid.pm_body.is_sleeping:
            return REST
        return rigid.twist(self._settings.gravity, self.dt, free=self._is_free(rigid))

    def configure(self, settings: WorldSettings) -> None:
        """Replace the settings: gravity, damping, iterations, and the walls of `bounds`."""
        self._drop_table()
        old, self._settings = self._settings, settings
        self.changes += old != settings
        if old.gravity != settings.gravity:
            self._change_gravity(old.gravity, settings.gravity)
        self.pm_space.damping = 1.0 - settings.damping
        self.pm_space.iterations = settings.iterations
        walls = (settings.bounds, settings.friction, settings.elasticity)
        if walls != (old.bounds, old.friction, old.elasticity):
            # A rebuilt wall has no cached impulses; bodies on it would lose their warm start.
            self._rebuild_boundary()

    # Bodies

    def add(self, body: Body, pose: Pose, twist: Twist) -> RigidBody:
        """Add a new body, the topmost one."""
        last = next(reversed(self.bodies.by_name.values()), None)
        rigid = rigid_body.build(body, 0 if last is None else last.serial + 1)
        self._insert(rigid, pose, twist)
        return rigid

    def change(self, old: RigidBody, body: Body, pose: Pose, twist: Twist) -> None:
        """
        Replace a body by a changed one, in its place in the spawn order.

        :raises BadProperty: springs on it would be too stiff; nothing is changed
        """
        if self.joints.has_joints(body.name):
            self.joints.check_springs({body.name: body})
        if same_in_engine(old.body, body):
            self._drop_table()
            self.changes += body != old.body
            old.body = body
            if pose != old.pose:
                self.set_pose(old, pose)
            if twist != self.twist_of(old):
                self.set_twist(old, twist)
            return
        rigid = rigid_body.build(body, old.serial)
        pose = self.joints.with_turns(old, pose)
        touching = self.bodies.touching(old.pm_body)
        self.joints.detach(body.name)
        self._take_out(old)
        self._insert(rigid, pose, twist)
        self.joints.attach(body.name)
        if not body.dynamic:
            self.pipeline.mouse_joints.forget_body(body.name)
        self.pipeline.half_step.release_bodies(touching)
        if old.wrench != NO_WRENCH and body.dynamic:
            self.set_wrench(rigid, old.wrench, old.wrench_until)

    def remove(self, name: str) -> None:
        """Remove a body and its joints for good."""
        rigid = self.bodies.by_name[name]
        touching = self.bodies.touching(rigid.pm_body)
        for joint in self.joints.names_on(name):
            self.unjoin(joint)
        self._take_out(rigid)
        self.pipeline.mouse_joints.forget_body(name)
        self.pipeline.floor.drives.forget_body(name)
        del self.bodies.by_name[name]
        self.pipeline.half_step.release_bodies(touching)

    def set_pose(self, rigid: RigidBody, pose: Pose) -> None:
        """Set the pose of a body."""
        touching = self.bodies.touching(rigid.pm_body)
        rigid.pose = self.joints.with_turns(rigid, pose)
        self.bodies.wake_around(rigid, touching)
        self.pipeline.continuous_collision.invalidate()
        self.pipeline.half_step.release_bodies(touching)
        self._note_motion()

    def set_twist(self, rigid: RigidBody, twist: Twist) -> None:
        """Set the velocity of a body, which is in free flight then unless it has joints."""
        free = self._is_free(rigid) or not self.joints.has_joints(rigid.body.name)
        rigid.set_twist(twist, self._settings.gravity, self.dt, free=free)
        self.pipeline.resting_damping.exempt_body(rigid)
        if self._table is not None and not rigid.body.anchored:
            self._table.free[self._table.columns.rows[rigid.body.name]] = free
        self._note_motion()

    def set_wrench(self, rigid: RigidBody, wrench: Wrench, until: int | None) -> None:
        """Set the wrench on a body until a step; None is for ever."""
        twist, free = self.twist_of(rigid), self._is_free(rigid)
        self.pipeline.wrenches.set_wrench(rigid, wrench, until)
        if wrench != NO_WRENCH:
            self._wake(rigid)
        if self._table is not None:
            row = self._table.columns.rows[rigid.body.name]
            self._table.leads[row] = rigid.lead(self._settings.gravity, self.dt)
        if free:
            self.set_twist(rigid, twist)
        self._note_motion()

    # Robots

    @property
    def robot_states(self) -> RobotStates:
        """Return drives and odometry of the robots, in the order of the scene."""
        return RobotStates.of([*self.pipeline.floor.drives.states(self.table.scene).values()])

    def drive(self, rigid: RigidBody, velocity: Twist, until: int) -> None:
        """Have a robot drive at a velocity as seen from it [m/s, rad/s], up to a step."""
        drives, name = self.pipeline.floor.drives, rigid.body.name
        self.changes += drives.command(self.table.scene, name, velocity, until)
        self._wake(rigid)

    # Grips

    def set_grip(self, grip: Grip) -> None:
        """Add a grip, in place of that of the same hand."""
        old = self.pipeline.mouse_joints.grip_of(grip.hand)
        if old is not None and old.body != grip.body:
            self.remove_grip(grip.hand)
        self.changes += old != grip
        self.pipeline.mouse_joints.set_grip(grip)

    def remove_grip(self, hand: str) -> None:
        """Remove the grip of a hand; its body keeps its velocity."""
        grip = self.pipeline.mouse_joints.grip_of(hand)
        if grip is not None:
            self.pipeline.mouse_joints.remove_grip(hand)
            self.pipeline.half_step.release_bodies([self.bodies.by_name[grip.body]])
            self._note_motion()

    # Joints

    def join(self, joint: Joint) -> None:
        """Add a joint; it replaces one of that name in its place."""
        self._drop_table()
        self.changes += 1
        self.joints.add(joint)

    def unjoin(self, name: str) -> None:
        """Remove a joint."""
        self._drop_table()
        self.changes += 1
        joint, bodies = self.joints.by_name[name].joint, self.bodies.by_name
        self.joints.remove(name)
        self.pipeline.half_step.release_bodies(
            bodies[end] for end in (joint.a, joint.b) if end in bodies
        )

    # The numbers of a body that leaves their range overflow in any stage, before it is removed.
    @np.errstate(over='ignore', invalid='ignore')
    def step(self, number: int, *, reports_contacts: bool) -> list[str]:
        """
        Make a step.

        :param number: count of steps of the world
        :param reports_contacts: whether contacts are reported
        :return: bodies that left the range of numbers, and were removed
        """
        for rigid in self.pipeline.wrenches.ended(number):
            self.set_wrench(rigid, NO_WRENCH, None)
        table = self.table
        if table.columns.moving:
            self.pipeline.step(
                table,
                number=number,
                age=self._age,
                reports_contacts=reports_contacts,
            )
        self._age += 1
        for name, force in self.joints.broken():
            self.unjoin(name)
            self.broken.append((name, force))
        lost = table.lost()
        # In a fixed order: the engine solves its constraints in an order that removals change.
        for name in dict.fromkeys((*lost, *table.columns.expiries.get(number + 1, ()))):
            self.remove(name)
        return lost

    # Inside

    def _change_gravity(self, old: Point, new: Point) -> None:
        """
        Replace gravity: bodies wake, and true velocities stay.

        A pile presses otherwise then; with its cached impulses the solver would throw it up.
        """
        rigids = list(self.bodies.by_name.values())
        wake_bodies(rigid.pm_body for rigid in rigids)
        share = _pressing_share(old, new)
        if share < 1.0:
            scale_impulses(self.shapes, share)
        for rigid in rigids:
            # If no share is left, nothing rests on anything any more.
            if rigid.free or not (share or self.joints.has_joints(rigid.body.name)):
                rigid.set_twist(rigid.twist(old, self.dt, free=rigid.free), new, self.dt)
        self.pm_space.gravity = new

    def _rebuild_boundary(self) -> None:
        background = self.pm_space.static_body
        touching = self.bodies.touching(background)
        self.boundary.rebuild(self._settings)
        self.pipeline.contact_report.forget_body(background.id)
        self.pipeline.half_step.release_bodies(touching)

    def _is_free(self, rigid: RigidBody) -> bool:
        """Return whether a body is in free flight."""
        if self._table is None:
            return rigid.free
        return bool(self._table.free[self._table.columns.rows[rigid.body.name]])

    def _insert(self, rigid: RigidBody, pose: Pose, twist: Twist) -> None:
        self._drop_table()
        self.changes += 1
        rigid.pose = pose
        # At rest: see `stages.tight_boxes`.
        self.bodies.add(rigid)
        rigid.set_twist(twist, self._settings.gravity, self.dt)

    def _take_out(self, rigid: RigidBody) -> None:
        self._drop_table()
        self.changes += 1
        self.bodies.take_out(rigid)
        self.pipeline.wrenches.forget_body(rigid)
        self.pipeline.contact_report.forget_body(rigid.pm_body.id)

    def _wake(self, rigid: RigidBody) -> None:
        """Wake a body and its island, before the next step: the table shows who sleeps."""
        rigid.pm_body.activate()
        if self._table is not None:
            self._table.forget_state()

    def _note_motion(self) -> None:
        self.changes += 1
        if self._table is not None:
            self._table.forget_state()

    def _drop_table(self) -> None:
        """Drop the table, before a body or joint is added, removed or changed."""
        if self._table is not None:
            self._table.store_flags()
        self._table = None


def _pressing_share(old: Point, new: Point) -> float:
    """Return the share of the impulses under one gravity that bodies press with under another."""
    before = math.hypot(*old)
    if before == 0.0:
        return 1.0
    along = old[0] / before * new[0] + old[1] / before * new[1]
    # No more than all of it: the pull of springs, and impacts, do not grow with gravity.
    return min(max(along / before, 0.0), 1.0)
