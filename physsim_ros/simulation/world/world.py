# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The world: requests go in, snapshots come out.

Laws: the world changes between steps only by `apply`; a refusal changes nothing, or says that it
is half done, and the caller is to rebuild the world; the same requests at the same steps give the
same bits, in another process too.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping
from dataclasses import replace
import hashlib
from operator import gt
from typing import Any, NamedTuple

from physsim_ros.engine.contacts import take_contacts
from physsim_ros.model import requests
from physsim_ros.model.answer import Answer
from physsim_ros.model.arrays import make_read_only
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import Refusal, StepFailed
from physsim_ros.model.requests import Configure, Request, Restore
from physsim_ros.model.scene import Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Contacts, Grip, NO_VECTORS, Snapshot
from physsim_ros.model.timeline import stamp_of
from physsim_ros.model.translation import counted, Text
from physsim_ros.runtime.slices import finish
from physsim_ros.simulation.world import (
    body_requests,
    hand_requests,
    joint_requests,
    robot_requests,
)
from physsim_ros.simulation.world.live_space import LiveSpace


def configure(live: LiveSpace, request: Configure) -> Answer:
    """
    Change settings.

    :raises Refusal: a value is out of range, or too many bodies would attract each other; nothing
        is changed
    """
    space, old = live.space, live.settings
    new = replace(old, **request.changes)
    live.capacity.check_settings(new)
    space.configure(new)
    until = live.step_after(new.command_timeout)
    if until is not None and new.command_timeout != old.command_timeout:
        # No wrench acts longer than from now on to the new timeout.
        for rigid in space.wrenched():
            if rigid.wrench_until is None or rigid.wrench_until > until:
                space.set_wrench(rigid, rigid.wrench, until)
    changed = list(request.changes)
    setting = Text(changed[0]) if len(changed) == 1 else ', '.join(changed)
    return Answer(message=Text('set {setting}', setting=setting))


def restore(live: LiveSpace, request: Restore) -> Answer:
    """
    Replace bodies, joints and settings by those of a saved state, in a space of its own.

    :raises WorldFull: the state is too large; nothing is changed
    :raises BadProperty: springs are too stiff for the steps; nothing is changed
    """
    live.begin(request.state, live.step_count)
    return Answer(message=load_message(request.state))


def load_message(state: WorldState) -> Text:
    """Return the message about a state that was loaded."""
    if not state.bodies:
        return Text('loaded 0 bodies')
    bodies, joints = counted(len(state.bodies), 'body'), counted(len(state.joints), 'joint')
    if state.joints:
        return Text('loaded {bodies} and {joints}', bodies=bodies, joints=joints)
    return Text('loaded {bodies}', bodies=bodies)


# The handler of each type of request. It checks everything, then changes the space; a request that
# consists of several, such as a cut, may fail half way: `Refusal.is_half_done` is then true.
HANDLERS: Mapping[type, Callable[[LiveSpace, Any], Answer]] = {
    requests.Spawn: body_requests.spawn,
    requests.ChangeBody: body_requests.change_body,
    requests.Cut: body_requests.cut,
    requests.MoveBodies: body_requests.move_bodies,
    requests.Command: body_requests.command,
    requests.Anchor: body_requests.anchor,
    requests.Release: body_requests.release,
    requests.Delete: body_requests.delete,
    requests.DeleteBodies: body_requests.delete_bodies,
    requests.DeleteAll: body_requests.delete_all,
    requests.Join: joint_requests.join,
    requests.Rejoin: joint_requests.rejoin,
    requests.Pin: joint_requests.join_at_point,
    requests.Axle: joint_requests.join_at_point,
    requests.Unjoin: joint_requests.unjoin,
    requests.UnjoinAll: joint_requests.unjoin_all,
    requests.Grab: hand_requests.grab,
    requests.MoveHand: hand_requests.move_hand,
    requests.KeepHand: hand_requests.keep_hand,
    requests.LetGo: hand_requests.let_go,
    requests.CommandMotors: joint_requests.command_motors,
    requests.DriveRobot: robot_requests.drive_robot,
    requests.Configure: configure,
    requests.Restore: restore,
}


class Change(NamedTuple):
    """
    The effect of a request on a world.

    :ivar answer: to it
    :ivar has_changed: whether it changed anything
    :ivar joined: bodies whose joints it added, replaced or removed, by name; none where it has
        replaced the whole world
    :ivar has_grown: whether it left more bodies, or more joints, than there were before
    """

    answer: Answer
    has_changed: bool
    joined: frozenset[str]
    has_grown: bool


class World(LiveSpace):
    """
    A world of bodies, stepped at a fixed rate: a live space, with requests, steps and snapshots.

    :param physics_rate: steps a second of simulation time [Hz]
    :param frame_steps: number of steps in a frame
    :param settings: at the start; None is the default ones

    :ivar reports_contacts: whether contacts are reported, which costs a tenth of a step
    """

    def __init__(
        self,
        *,
        physics_rate: float = 240.0,
        frame_steps: int = 4,
        settings: WorldSettings | None = None,
    ) -> None:
        super().__init__(settings or WorldSettings(), physics_rate)
        self.frame_steps = frame_steps
        self.reports_contacts = False
        self._lost: list[str] = []

    # Reading

    def __len__(self) -> int:
        return len(self.space.bodies.by_name)

    def __contains__(self, name: str) -> bool:
        return name in self.space.bodies.by_name

    @property
    def scene(self) -> Scene:
        """Return the bodies, joints and settings."""
        return self.space.table.scene

    @property
    def stamp(self) -> int:
        """Return the simulation time [ns]."""
        return stamp_of(self.step_count, self.physics_rate)

    def snapshot(self) -> Snapshot:
        """Return the snapshot of this step."""
        poses, twists = self.space.core.observe()
        forces, pulls, pressing = self.space.joints.report()
        fields = NO_VECTORS
        if self.reports_contacts:
            fields = self.space.table.field_forces(self.space.dt)
        snapshot = Snapshot(
            step=self.step_count,
            stamp=self.stamp,
            scene=self.scene,
            poses=poses,
            twists=twists,
            forces=forces,
            compressed=pressing,
            springs=self.space.joints.springs(),
            grips=self.grips,
            robots=self.space.table.robot_states,
            pulls=pulls if self.reports_contacts else NO_VECTORS,
            fields=fields,
        )
        # The past has them, too.
        make_read_only(poses, twists, forces, pulls, pressing, fields, snapshot.robots)
        make_read_only(*snapshot.springs)
        return snapshot

    def contacts(self, snapshot: Snapshot) -> Contacts:
        """Return the contacts since the last call, of the steps in which they were read."""
        found = take_contacts(self.space.core, self.space.table, lambda: snapshot.centers)
        make_read_only(found.pairs, found.points, found.normals, found.impulses)
        make_read_only(found.begun, found.begun_at)
        return found

    def clear_contacts(self) -> None:
        """Drop the contacts since the last call of `contacts`."""
        self.space.clear_contacts()

    def digest(self) -> str:
        """Return the digest, by which worlds are compared; it leaves out cached impulses."""
        digest = hashlib.blake2b(digest_size=16)
        digest.update(f'{self.step_count} {self.physics_rate!r}'.encode())
        state, free, _ = self.space.core.read_state()
        digest.update(self.scene.key)
        digest.update(state.tobytes())
        digest.update(free.tobytes())
        for rigid in self.space.wrenched():
            digest.update(f'{rigid.body.name} {rigid.wrench!r} {rigid.wrench_until}'.encode())
        for name, coming in self.space.commands.coming.in_order(self.space.bodies.by_name):
            digest.update(f'{name} {coming!r}'.encode())
        for command in self.space.joints.all_commands:
            digest.update(repr(tuple(command)).encode())
        for grip in self.grips:
            digest.update(repr(grip).encode())
        for states in (self.space.table.robot_states, self.space.table.actor_states):
            for name in states.dtype.names or ():
                digest.update(states[name].tobytes())
        return digest.hexdigest()

    @property
    def grips(self) -> tuple[Grip, ...]:
        """Return the grips of hands on bodies."""
        return tuple(self.space.grips) if self.space.grips else ()

    def save(self) -> WorldState:
        """Return the saved state of the world."""
        return self.saver()()

    # Changing

    def apply(self, request: Request) -> Change:
        """
        Carry out a request.

        :raises Refusal: nothing is changed, or the request is half done
        """
        space, changes, counts = self.space, self.space.changes, self._counts
        # Without those of joints that have broken.
        space.take_joined()
        try:
            answer = HANDLERS[type(request)](self, request)
        except Refusal as refusal:
            refusal.is_half_done = self.space is not space or space.changes != changes
            raise
        is_other = self.space is not space
        return Change(
            answer=answer,
            has_changed=is_other or space.changes != changes,
            joined=frozenset() if is_other else space.take_joined(),
            # One by one: a cut may add a body, and remove a joint.
            has_grown=any(map(gt, self._counts, counts)),
        )

    @property
    def _counts(self) -> tuple[int, int]:
        """Return the numbers of bodies and of joints."""
        return len(self.space.bodies.by_name), len(self.space.joints.by_name)

    def slices_of_reapplying(self, request: Request) -> Generator[None]:
        """
        Carry out a request again, whose capacity was checked the first time; yield after slices.

        :raises Refusal: and nothing is changed
        """
        if isinstance(request, Restore):
            yield from self.slices_of_beginning(request.state)
        with self.capacity.unchecked():
            self.apply(request)

    @property
    def is_within_step(self) -> bool:
        """Return whether a step is begun and not ended."""
        return self.space.is_within_step

    def take_lost(self) -> list[str]:
        """Return the bodies removed since the last call, as they left the range of numbers."""
        if not self._lost:
            return []
        lost, self._lost = self._lost, []
        return lost

    def take_broken(self) -> list[tuple[str, float]]:
        """Return the joints that broke since the last call, and the force of each then [N]."""
        return self.space.take_broken()

    def step(self, count: int) -> tuple[str, ...]:
        """
        Make a number of steps at once, in a world beside the live one, which its failure spares.

        :return: bodies that left the range of numbers and were removed
        :raises RuntimeError: in place of any error
        """
        try:
            finish(self.slices_of_steps(count))
        except StepFailed as error:
            raise RuntimeError(str(error)) from error
        return tuple(self.take_lost())

    def slices_of_steps(self, count: int) -> Generator[None]:
        """
        Make a number of steps; yield where they take long, within a step too.

        Nothing of the world is read or changed before the last of them has ended.

        :raises StepFailed: in place of any error
        """
        end = self.step_count + count
        while self.step_count < end or self.is_within_step:
            try:
                made, gone = self.space.step(
                    self.step_count,
                    end - self.step_count,
                    reports_contacts=self.reports_contacts,
                )
            except Exception as error:
                raise StepFailed(f'step {self.step_count + 1} failed: {error}') from error
            self.step_count += made
            self._lost += gone
            if self.step_count < end or self.is_within_step:
                yield
