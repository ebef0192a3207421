# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Space: the bodies, joints and walls that are in the engine, and all that can be done to them.

Laws: no other folder uses a Pymunk object; true velocities do not jump when gravity or a
wrench changes.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
import math

from physsim_ros.engine.bodies import RigidBody
from physsim_ros.engine.body_set import BodySet, wake_bodies
from physsim_ros.engine.body_table import BodyTable, CoreTables
from physsim_ros.engine.boundary import Boundary
from physsim_ros.engine.commands import CommandSet
from physsim_ros.engine.core import lib
from physsim_ros.engine.core_world import CoreWorld
from physsim_ros.engine.grip_set import GripSet
from physsim_ros.engine.joints.joint_set import JointSet
from physsim_ros.engine.pymunk_bodies import build_body
from physsim_ros.engine.scene_columns import check_columns, check_floor
from physsim_ros.engine.settings import make_space
from physsim_ros.engine.warm_start import scale_impulses, ShapeIds
from physsim_ros.model.attraction import attracts
from physsim_ros.model.lesson import Lesson
from physsim_ros.model.scene import Body, Joint, Scene, Wakes
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Grip
from physsim_ros.model.transform import NO_WRENCH, Point, Pose, REST, Twist, Wrench

# Bodies that leave at the end of a step in one call [1]: some 60 ms.
_MOST_LEAVING = 2000
# Of a space of Pymunk as it is made.
_WITHOUT_GRAVITY = WorldSettings(gravity=(0.0, 0.0))


class Space:
    """
    The bodies, joints and walls in the engine.

    :param settings: of the world
    :param dt: of a sub-step [s]
    :param first_shape: number of the first wall of the boundary
    :param lesson: the task that belongs to the world; None is none

    :ivar dt: length of a sub-step [s]
    :ivar pm_space: Pymunk's space
    :ivar shapes: the engine's numbers of its shapes
    :ivar boundary: the walls of `bounds`
    :ivar bodies: in it
    :ivar joints: between them
    :ivar commands: of their motors, and of the drives of robots
    :ivar grips: of hands on them
    :ivar tables: of the core
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
        self._core = CoreWorld(self.pm_space, dt)
        self.joints = JointSet(self.pm_space, self.bodies.by_name, self._core, dt)
        self.commands = CommandSet(self.bodies, self.joints, dt)
        # Until they are taken: joints that have broken, with the force at which each did [N], and
        # the bodies whose joints were added, replaced or removed.
        self._broken: list[tuple[str, float]] = []
        self._joined: set[str] = set()
        self._changes = self._age = 0
        # The bodies that are still to be removed at the end of the step.
        self._leaving: list[str] = []
        # Bodies on which a wrench acts, by name.
        self._wrenched: dict[str, RigidBody] = {}
        self.grips = GripSet()
        self.tables = CoreTables(self.bodies, self.joints, self.grips, self._core, dt)
        self._settings = _WITHOUT_GRAVITY
        self.configure(settings)

    @property
    def settings(self) -> WorldSettings:
        """Return the settings of the world."""
        return self._settings

    @property
    def changes(self) -> int:
        """Return the count of changes other than steps."""
        return self._changes + self.commands.changes

    @property
    def age(self) -> int:
        """Return the count of steps made in this space."""
        return self._age

    @property
    def table(self) -> BodyTable:
        """Return the bodies as the core has them."""
        return self.tables.latest or self.tables.lay_out(self._scene)

    @property
    def core(self) -> CoreWorld:
        """Return the core, which has the bodies and joints of now."""
        if self.tables.latest is None:
            self.tables.lay_out(self._scene)
        return self._core

    @property
    def _scene(self) -> Scene:
        return Scene(
            bodies=tuple(rigid.body for rigid in self.bodies.by_name.values()),
            settings=self._settings,
            joints=tuple(held.joint for held in self.joints.by_name.values()),
            lesson=self._lesson,
        )

    def twist_of(self, rigid: RigidBody) -> Twist:
        """Return the true velocity of a body."""
        if rigid.pm_body.is_sleeping:
            return REST
        return rigid.twist(self._settings.gravity, self.dt)

    def configure(self, settings: WorldSettings) -> None:
        """Replace the settings: gravity, damping, iterations, and the walls of `bounds`."""
        check_floor(self._scene, settings, self.dt)
        self.tables.drop()
        old, self._settings = self._settings, settings
        self._changes += old != settings
        if old.gravity != settings.gravity:
            self._change_gravity(old.gravity, settings.gravity)
        if old.floor_friction != settings.floor_friction:
            wake_bodies(rigid.pm_body for rigid in self.bodies.by_name.values())
        self.pm_space.damping = 1.0 - settings.damping
        self.pm_space.iterations = -(-settings.iterations // lib.SUB_STEPS)
        walls = (settings.bounds, settings.friction, settings.elasticity)
        if walls != (old.bounds, old.friction, old.elasticity):
            # A rebuilt wall has no cached impulses; bodies on it would lose their warm start.
            self._rebuild_boundary()

    # Bodies

    def add(self, body: Body, pose: Pose, twist: Twist) -> RigidBody:
        """Add a new body, the topmost one."""
        check_columns(body, self._settings, self.dt)
        rigid = build_body(body)
        self._insert(rigid, pose, twist)
        return rigid

    def change(self, old: RigidBody, body: Body, pose: Pose, twist: Twist) -> None:
        """Replace a body by a changed one, in its place in the spawn order."""
        check_columns(body, self._settings, self.dt)
        wakes = old.body.wakes(body)
        if wakes < Wakes.TOUCHING:
            # The velocity that Chipmunk keeps for a sleeping body is rounding.
            stays_at_rest = old.pm_body.is_sleeping and twist == REST
            if wakes is Wakes.ITSELF:
                wake_bodies([old.pm_body])
            self.tables.drop()
            self._changes += body != old.body
            old.take_over_roles(old, body)
            old.body = body
            self.commands.drop_without_drive(body)
            if pose != old.pose:
                self.set_poses([(old, pose)])
            if not stays_at_rest and twist != self.twist_of(old):
                self.set_twist(old, twist)
            return
        rigid = build_body(body)
        # Reports of contacts take it for the same body: its contacts do not begin anew.
        rigid.row = old.row
        pose = self.joints.with_turns(old, pose)
        touching = self.bodies.touching(old.pm_body)
        self.joints.detach(body.name)
        self._take_out(old)
        self._insert(rigid, pose, twist)
        self.joints.attach(body.name)
        self.joints.check(self.joints.names_on(body.name))
        if not body.dynamic:
            self.grips.remove_from(body.name)
        rigid.take_over_roles(old, body)
        self.commands.drop_without_drive(body)
        self._release(touching)
        if old.wrench != NO_WRENCH and body.dynamic:
            self.set_wrench(rigid, old.wrench, old.wrench_until)

    def remove(self, names: Iterable[str]) -> None:
        """Remove bodies and their joints for good."""
        rigids = [self.bodies.by_name[name] for name in names]
        for rigid in rigids:
            for joint in self.joints.names_on(rigid.body.name):
                self.unjoin(joint)
        self._core.remove_shapes([rigid.address for rigid in rigids])
        for rigid in rigids:
            name = rigid.body.name
            self._take_out(rigid)
            self.grips.remove_from(name)
            self.commands.coming.put(name, ())
            del self.bodies.by_name[name]

    def set_poses(self, poses: Sequence[tuple[RigidBody, Pose]]) -> None:
        """Set the poses of bodies."""
        for rigid, pose in poses:
            touching = self.bodies.touching(rigid.pm_body)
            rigid.pose = self.joints.with_turns(rigid, pose)
            self.bodies.note_moved()
            self.bodies.wake_around(rigid, touching)
            if rigid.body.anchored:
                self._core.note_moved_static()
            self._release(touching)
        concerned = moved = [rigid for rigid, _ in poses]
        if any(each.body.medium or attracts(each.body, self._settings) for each in moved):
            # They act on all others from other places.
            concerned = list(self.bodies.by_name.values())
            wake_bodies(each.pm_body for each in concerned)
        for each in concerned:
            each.begin_fields()
        self._changes += len(poses)

    def set_twist(self, rigid: RigidBody, twist: Twist) -> None:
        """Set the velocity of a body: it flies then, unless joints or contacts hold it."""
        free = rigid.state['free'] or not self.joints.has_joints(rigid.body.name)
        rigid.set_twist(twist, self._settings.gravity, self.dt, free=free)
        if not rigid.body.anchored:
            rigid.state['thrown'] = True
        rigid.begin_fields()
        self._changes += 1

    def set_wrench(self, rigid: RigidBody, wrench: Wrench, until: int | None) -> None:
        """Set the wrench on a body until a step; None is for ever."""
        twist, free = self.twist_of(rigid), rigid.state['free']
        self.put_wrench(rigid, wrench, until)
        if wrench != NO_WRENCH:
            rigid.pm_body.activate()
        if self.tables.latest is not None:
            self.tables.latest.set_wrench(rigid.row, wrench)
        if free:
            self.set_twist(rigid, twist)
        self._changes += 1

    def put_wrench(self, rigid: RigidBody, wrench: Wrench, until: int | None) -> None:
        """Set the wrench of a body that is in no table yet."""
        rigid.wrench, rigid.wrench_until = wrench, until
        if wrench == NO_WRENCH:
            self._wrenched.pop(rigid.body.name, None)
        else:
            self._wrenched[rigid.body.name] = rigid

    def wrenched(self) -> list[RigidBody]:
        """Return the bodies on which a wrench acts, in spawn order."""
        rows = self.table.columns.rows
        return sorted(self._wrenched.values(), key=lambda rigid: rows[rigid.body.name])

    # Grips

    def set_grip(self, grip: Grip) -> None:
        """Add a grip, in place of that of the same hand."""
        old = self.grips.of(grip.hand)
        if old is not None and old.body != grip.body:
            self.remove_grip(grip.hand)
        self._changes += old != grip
        self.grips.put(grip)

    def remove_grip(self, hand: str) -> None:
        """Remove the grip of a hand, if it has one; its body keeps its velocity."""
        grip = self.grips.of(hand)
        if grip is not None:
            self.grips.remove(hand)
            self._release([self.bodies.by_name[grip.body]])
            self._changes += 1

    # Contacts

    def clear_contacts(self) -> None:
        """Drop the contacts that nobody has taken."""
        self._core.clear_contacts()

    def copy_reports(self, old: Space) -> None:
        """Copy what an older space of the same bodies has to report of the unfinished frame."""
        self._core.copy_contacts(old._core)
        self._broken = old.take_broken()

    # Joints

    def join(self, joint: Joint) -> None:
        """Add a joint; it replaces one of that name in its place."""
        self.tables.drop()
        self._changes += 1
        if (old := self.joints.by_name.get(joint.name)) is not None:
            self._joined.update(old.joint.bodies)
        self._joined.update(joint.bodies)
        self.joints.add(joint)
        self.joints.check([joint.name])

    def unjoin(self, name: str) -> None:
        """Remove a joint."""
        self.tables.drop()
        self._changes += 1
        joint, bodies = self.joints.by_name[name].joint, self.bodies.by_name
        self._joined.update(joint.bodies)
        self.joints.remove(name)
        self._release(bodies[end] for end in joint.bodies if end in bodies)

    def take_joined(self) -> frozenset[str]:
        """Return the bodies whose joints were added, replaced or removed since the last call."""
        joined, self._joined = frozenset(self._joined), set()
        return joined

    def take_broken(self) -> list[tuple[str, float]]:
        """Return the joints that broke since the last call, and the force of each then [N]."""
        broken, self._broken = self._broken, []
        return broken

    # Steps

    def step(self, step: int, count: int, *, reports_contacts: bool) -> tuple[int, list[str]]:
        """
        Make steps.

        :param step: count of steps that the world has made
        :param count: of the steps to make
        :param reports_contacts: whether contacts are reported
        :return: count of the steps that were made: fewer where something has to be done between
            two of them, or where they take long; and bodies that left the range of numbers, and
            are removed
        """
        if self._leaving:
            self._remove_leaving()
            return 0, []
        if self._wrenched:
            self._end_wrenches(step)
        if self.commands.are_coming:
            self.commands.begin(step)
        table, core, made = self.table, self.core, self._steps_until_event(step, count)
        if table.columns.moving:
            if (grips := self.grips.changed_records(self.bodies.by_name)) is not None:
                core.use(grips=grips)
            table.noise.make(step, made)
            made = core.step(made, step=step, age=self._age, reports_contacts=reports_contacts)
        self._age += made
        self.bodies.note_moved()
        if core.is_within_step:
            return made, []
        if core.has_broken:
            for name, force in self.joints.broken():
                self.unjoin(name)
                self._broken.append((name, force))
        lost = table.lost() if core.has_lost else []
        # In a fixed order: the engine solves its constraints in an order that removals change.
        expired = table.columns.expiries.get(step + made, ())
        self._leaving = [*dict.fromkeys((*lost, *expired))]
        self._remove_leaving()
        return made, lost

    def _remove_leaving(self) -> None:
        """Remove some of the bodies that leave at the end of the step."""
        some, self._leaving = self._leaving[:_MOST_LEAVING], self._leaving[_MOST_LEAVING:]
        self.remove(some)

    @property
    def is_within_step(self) -> bool:
        """Return whether a step is begun and not ended; nothing is read or changed until then."""
        return self._core.is_within_step or bool(self._leaving)

    def _end_wrenches(self, step: int) -> None:
        """End the wrenches that act up to a step."""
        for rigid in list(self._wrenched.values()):
            if rigid.wrench_until is not None and rigid.wrench_until <= step:
                self.set_wrench(rigid, NO_WRENCH, None)

    def _steps_until_event(self, step: int, count: int) -> int:
        """Return how many of some steps follow each other without anything between them."""
        expiries = self.table.columns.expiries
        if not (self._wrenched or self.commands.are_coming or expiries):
            return count
        events = (
            *expiries,
            *(rigid.wrench_until for rigid in self._wrenched.values()),
            *self.commands.steps,
        )
        ahead = (event - step for event in events if event is not None and event > step)
        return min([count, *ahead])

    # Inside

    def _change_gravity(self, old: Point, new: Point) -> None:
        """
        Replace gravity: bodies wake, and true velocities stay.

        A pile presses otherwise then; with its cached impulses the solver would throw it up.
        """
        rigids = list(self.bodies.by_name.values())
        wake_bodies(rigid.pm_body for rigid in rigids)
        share = _pressing_share(old, new)
        # No more than they were: the pull of springs, and impacts, do not grow with gravity.
        if share < 1.0:
            scale_impulses(self.shapes, share)
        for rigid in rigids:
            # If no share is left, nothing rests on anything any more.
            if rigid.state['free'] or not (share or self.joints.has_joints(rigid.body.name)):
                rigid.set_twist(rigid.twist(old, self.dt), new, self.dt)
        self.pm_space.gravity = new

    def _rebuild_boundary(self) -> None:
        touching = self.bodies.touching(self.bodies.background)
        self.boundary.rebuild(self._settings)
        self._release(touching)

    def _release(self, rigids: Iterable[RigidBody]) -> None:
        """Note bodies whose support may have been removed, or moved away."""
        for rigid in rigids:
            # A body whose engine objects have been made anew is another one.
            now = self.bodies.by_name.get(rigid.body.name)
            if now is not None:
                now.state['released'] = True

    def _insert(self, rigid: RigidBody, pose: Pose, twist: Twist) -> None:
        self.tables.drop()
        self._changes += 1
        rigid.pose = pose
        # At rest: see `core/tight_boxes.c`.
        self.bodies.add(rigid)
        rigid.set_twist(twist, self._settings.gravity, self.dt)

    def _take_out(self, rigid: RigidBody) -> None:
        self.tables.drop()
        self._changes += 1
        self.bodies.take_out(rigid)
        self._wrenched.pop(rigid.body.name, None)


def _pressing_share(old: Point, new: Point) -> float:
    """Return the share of the impulses under one gravity that bodies press with under another."""
    before = math.hypot(*old)
    if before == 0.0:
        return 1.0
    along = old[0] / before * new[0] + old[1] / before * new[1]
    return max(along / before, 0.0)
