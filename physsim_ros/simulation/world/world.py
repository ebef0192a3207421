# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The world: requests go in, snapshots come out.

Laws: the world changes only between steps and only in `apply`; a refusal changes nothing; the same
requests at the same steps give the same bits, in another process too.
"""

from __future__ import annotations

from dataclasses import replace
import hashlib
import math

import numpy as np
from physsim_ros.engine.checkpoint import checkpoint_of, saved_state
from physsim_ros.engine.observation import digest_parts, observe_bodies
from physsim_ros.engine.space import Space
from physsim_ros.model.checkpoint import Checkpoint, WorldState
from physsim_ros.model.grips import Grip
from physsim_ros.model.requests import (
    Anchor,
    BodyRequest,
    ChangeBody,
    Command,
    Configure,
    Delete,
    DeleteAll,
    DeleteBodies,
    HandRequest,
    JointRequest,
    MoveBodies,
    Release,
    Request,
    Restore,
    Spawn,
)
from physsim_ros.model.scene import Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Contacts, Snapshot
from physsim_ros.simulation.world import body_requests, hand_requests, joint_requests
from physsim_ros.simulation.world.capacity import Capacity
from physsim_ros.simulation.world.live_space import LiveSpace
from physsim_ros.simulation.world.lookup import points_in_world


class World:
    """
    A world of bodies, stepped at a fixed rate.

    :param physics_rate: steps a second of simulation time [Hz]
    :param frame_steps: number of steps in a frame
    :param settings: at the start; None is the default ones
    """

    def __init__(
        self,
        *,
        physics_rate: float = 240.0,
        frame_steps: int = 4,
        settings: WorldSettings | None = None,
    ) -> None:
        self.physics_rate = physics_rate
        self.frame_steps = frame_steps
        self.dt = 1.0 / physics_rate
        self.step_count = 0
        # Whether contacts are read; reading them costs a tenth of a step.
        self.watching = False
        # Whether the last request that was carried out changed anything.
        self.changed = False
        self._settings = settings or WorldSettings()
        self._live_space = LiveSpace(self._settings, self.dt)
        # The serial number of the next body.
        self._spawned = 0
        self._capacity = Capacity(self._settings)

    @property
    def _space(self) -> Space:
        return self._live_space.space

    # Reading

    def __len__(self) -> int:
        return len(self._space.bodies.by_name)

    def __contains__(self, name: str) -> bool:
        return name in self._space.bodies.by_name

    @property
    def settings(self) -> WorldSettings:
        """Return the settings of the world."""
        return self._settings

    @property
    def scene(self) -> Scene:
        """Return the bodies, joints and settings."""
        return self._space.table.scene

    @property
    def stamp(self) -> int:
        """Return the simulation time [ns]."""
        return round(self.step_count * 1e9 / self.physics_rate)

    def snapshot(self) -> Snapshot:
        """Return the snapshot of this step."""
        table, start = self._space.table, self._space.start_state
        poses, twists = observe_bodies(table, start)
        return Snapshot(
            step=self.step_count,
            stamp=self.stamp,
            scene=table.scene,
            poses=poses,
            twists=twists,
            forces=self._space.joints.forces(),
            compressed=self._space.joints.compressed(),
            springs=self._space.joints.springs(),
            grips=self.grips,
            pulls=self._space.joints.pulls() if self.watching else np.empty((0, 2)),
        )

    def contacts(self, snapshot: Snapshot) -> Contacts:
        """Return the contacts since the last call, of the steps in which they were read."""
        report = self._space.pipeline.contact_report
        return report.take_contacts(self._space.table, lambda: snapshot.centers)

    def clear_contacts(self) -> None:
        """Drop the contacts since the last call of `contacts`."""
        self._space.pipeline.contact_report.clear()

    def digest(self) -> str:
        """Return a hash of time, scene, poses, velocities, wrenches and grips, not of impulses."""
        digest = hashlib.blake2b(digest_size=16)
        digest.update(f'{self.step_count} {self.physics_rate!r}'.encode())
        acting = self._space.pipeline.wrenches.acting()
        for part in digest_parts(self._space.table, self._space.start_state, acting):
            digest.update(part)
        for grip in self.grips:
            digest.update(repr(grip).encode())
        return digest.hexdigest()

    @property
    def grips(self) -> tuple[Grip, ...]:
        """Return the grips of hands on bodies."""
        return self._space.pipeline.mouse_joints.grips()

    def save(self) -> WorldState:
        """Return the saved state of the world."""
        return saved_state(self._space, self.step_count)

    # Changing

    def replay(self, request: Request) -> None:
        """
        Carry out a request again, whose capacity was checked the first time.

        :raises Refusal: and nothing is changed
        """
        self._capacity.checking = False
        try:
            self.apply(request)
        finally:
            self._capacity.checking = True

    def apply(self, request: Request) -> tuple[str, str]:
        """
        Carry out a request.

        :return: the body or joint concerned, or '', and a sentence that says what was done
        :raises Refusal: and nothing is changed
        """
        before = self._space, self._space.changes
        done = self._carry_out(request)
        self.changed = before != (self._space, self._space.changes)
        return done

    def _carry_out(self, request: Request) -> tuple[str, str]:
        if isinstance(request, JointRequest):
            return joint_requests.apply_joint_request(self._space, request, self._capacity)
        if isinstance(request, HandRequest):
            return hand_requests.apply_hand_request(self._space, request, self._capacity)
        if isinstance(request, BodyRequest):
            return self._change_bodies(request)
        match request:
            case Configure(changes=changes):
                self._configure(replace(self._settings, **changes))
                return '', f'set {", ".join(changes)}'
            case Restore(state=state):
                self._restore(state)
                joints = f' and {len(state.joints)} joints' if state.joints else ''
                return '', f'loaded {len(state.bodies)} bodies{joints}'

    def take_broken(self) -> list[tuple[str, float]]:
        """Return the joints that broke since the last call, and the force of each then [N]."""
        broken, self._space.broken = self._space.broken, []
        return broken

    def step(self, count: int) -> tuple[str, ...]:
        """
        Make a number of steps.

        :return: bodies that left the range of numbers and were removed
        """
        lost: list[str] = []
        for _ in range(count):
            lost += self._space.step(self.step_count, watching=self.watching)
            self.step_count += 1
        return tuple(lost)

    # Going on from a checkpoint

    def renew(self) -> Checkpoint:
        """
        Go on in a space that is built from a checkpoint of this moment, and return that.

        A world that resumes the checkpoint later goes on with the same bits.
        """
        before = self._space
        key = self._live_space.renew(self.step_count)
        if self._space is not before:
            self._note_new_space()
        return key

    def resume(self, key: Checkpoint, *, going_over: bool = False) -> None:
        """
        Go back, or forward, to a checkpoint.

        :param going_over: whether the world is at that moment now, with the same bodies; then
            the contacts of the frame so far are kept
        """
        self.step_count = key.step
        self._settings = key.scene.settings
        self._live_space.resume(key, going_over=going_over)
        self._note_new_space()

    def build_bodies(self, count: int) -> None:
        """Build a number of bodies for the next `renew`."""
        self._live_space.build_bodies(count)

    def _note_new_space(self) -> None:
        self._spawned = len(self._space.bodies.by_name)
        self._capacity.settings = self._settings
        self._capacity.forget()

    # Requests

    def _change_bodies(self, request: BodyRequest) -> tuple[str, str]:
        space = self._space
        match request:
            case Spawn():
                return self._spawn(request)
            case ChangeBody():
                return body_requests.change_body(space, request, self._capacity)
            case MoveBodies():
                return body_requests.move_bodies(space, request, self._capacity)
            case Command():
                until = self._wrenches_until()
                return body_requests.command_bodies(space, request, until, self._capacity)
            case Anchor(point=point, frame=frame) | Release(point=point, frame=frame):
                (point,) = points_in_world(space, (point,), frame)
                anchored = isinstance(request, Anchor)
                return body_requests.set_anchored(space, point, self._capacity, anchored=anchored)
            case Delete(name=name):
                return body_requests.delete_bodies(space, (name,), 'name')
            case DeleteBodies(names=names):
                return body_requests.delete_bodies(space, names)
            case DeleteAll(namespace=namespace):
                return body_requests.delete_all(space, namespace)

    def _spawn(self, request: Spawn) -> tuple[str, str]:
        expires = self._step_after(request.lifetime) if request.lifetime > 0 else None
        done = body_requests.spawn_body(
            self._space, request, self._capacity, serial=self._spawned, expires=expires
        )
        self._spawned = max(self._spawned, self._space.bodies.by_name[request.name].serial + 1)
        return done

    def _wrenches_until(self) -> int | None:
        """Return the step until which a wrench acts that is asked for now; None is for ever."""
        timeout = self._settings.command_timeout
        return self._step_after(timeout) if timeout > 0 else None

    def _configure(self, settings: WorldSettings) -> None:
        old, self._settings = self._settings, settings
        self._capacity.settings = settings
        self._space.configure(settings)
        if settings.command_timeout != old.command_timeout:
            self._limit_wrenches(self._wrenches_until())

    def _limit_wrenches(self, until: int | None) -> None:
        """Let no wrench act longer than to a step; None is for ever."""
        for rigid in self._space.pipeline.wrenches.acting():
            if until is not None and (rigid.wrench_until is None or rigid.wrench_until > until):
                self._space.set_wrench(rigid, rigid.wrench, until)

    def _restore(self, state: WorldState) -> None:
        self._capacity.check_state(state)
        # A space of its own for every state: what was in the old one leaves no trace.
        self._live_space.begin(checkpoint_of(state, self.step_count, self.dt))
        self._settings = state.settings
        self._note_new_space()

    def _step_after(self, seconds: float) -> int:
        return self.step_count + steps_in(seconds, self.physics_rate)


def steps_in(seconds: float, physics_rate: float) -> int:
    """
    Return the number of steps that cover a time [s], at least one.

    :param physics_rate: of the world [Hz]
    """
    # Less a billionth, and a few last bits: 0.1 s at 240 Hz is 24 steps, not 25.
    return max(1, math.ceil(seconds * physics_rate * (1.0 - 1e-15) - 1e-9))
