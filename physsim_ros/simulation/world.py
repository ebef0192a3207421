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
The world: requests go in, snapshots come out.

Laws: the world changes only between steps and only in `apply`; a refusal changes nothing; the same
requests at the same steps give the same bits, in another process too.
"""

from __future__ import annotations

from dataclasses import replace
import hashlib
import math
from typing import NamedTuple

from physsim_ros.engine.body_pool import BodyPool
from physsim_ros.engine.checkpoint import checkpoint_of, restore_checkpoint, take_checkpoint
from physsim_ros.engine.observation import digest_parts, observe_bodies
from physsim_ros.engine.space import Space
from physsim_ros.model.checkpoint import BodyState, Checkpoint, Motion, WorldState
from physsim_ros.model.grips import Grip
from physsim_ros.model.joints import JointKind
from physsim_ros.model.requests import (
    Anchor,
    Axle,
    BodyRequest,
    ChangeBody,
    Command,
    Configure,
    Delete,
    DeleteAll,
    DeleteBodies,
    Grab,
    HandRequest,
    Join,
    JointRequest,
    KeepHand,
    LetGo,
    MoveBodies,
    MoveHand,
    Pin,
    Release,
    Request,
    Restore,
    Spawn,
    Unjoin,
    UnjoinAll,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Contacts, Snapshot
from physsim_ros.model.transform import Point
from physsim_ros.simulation import body_requests, hand_requests, joint_requests
from physsim_ros.simulation.capacity import Capacity
from physsim_ros.simulation.lookup import points_in_world, pose_in_world


class World:
    """
    A world of bodies, stepped at a fixed rate.

    :param physics_rate: steps a second of simulation time [Hz]
    :param frame_steps: of a frame; at its end, what has left the range of numbers is looked for
    :param settings: what holds at the start
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
        self._space = Space(self._settings, self.dt)
        self._spawned = 0
        self._pool = BodyPool()
        # Of a space that was built from it just now.
        self._fresh: _Fresh | None = None
        self._capacity = Capacity(self._settings)

    # Reading

    def __len__(self) -> int:
        return len(self._space.bodies.by_name)

    def __contains__(self, name: str) -> bool:
        return name in self._space.bodies.by_name

    @property
    def settings(self) -> WorldSettings:
        """Return what holds for the whole world."""
        return self._settings

    @property
    def stamp(self) -> int:
        """Return the simulation time [ns]."""
        return round(self.step_count * 1e9 / self.physics_rate)

    def snapshot(self) -> Snapshot:
        """Return where everything is."""
        table, settled = self._space.table, self._space.settled
        poses, twists = observe_bodies(table, settled)
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
        )

    def contacts(self, snapshot: Snapshot) -> Contacts:
        """Return what touched since the last call while the world was being watched."""
        report = self._space.pipeline.contact_report
        return report.take_contacts(self._space.table, lambda: snapshot.centers)

    def clear_contacts(self) -> None:
        """Forget what touched since the last call of `contacts`."""
        self._space.pipeline.contact_report.clear()

    def digest(self) -> str:
        """Return a hash of all that is known of the world, but for the engine's own memory."""
        digest = hashlib.blake2b(digest_size=16)
        digest.update(f'{self.step_count} {self.physics_rate!r}'.encode())
        acting = self._space.pipeline.wrenches.acting()
        for part in digest_parts(self._space.table, self._space.settled, acting):
            digest.update(part)
        for grip in self.grips:
            digest.update(repr(grip).encode())
        return digest.hexdigest()

    @property
    def grips(self) -> tuple[Grip, ...]:
        """Return the grips of hands on bodies."""
        return self._space.pipeline.mouse_joints.grips()

    def body_at(self, point: Point) -> str | None:
        """Return the topmost body, that spawned last, which covers a point of the world [m]."""
        return next(iter(self._space.bodies.at(point)), None)

    def save(self) -> WorldState:
        """Return everything that the world goes on from."""
        now = self.step_count
        key, bodies = take_checkpoint(self._space, now), []
        motions = zip(key.state.tolist(), key.free.tolist(), strict=True)
        for rigid, (state, free) in zip(self._space.bodies.by_name.values(), motions, strict=True):
            body, until = rigid.body, rigid.wrench_until
            if body.expires is not None:
                body = replace(body, expires=body.expires - now)
            bodies.append(
                BodyState(
                    body=body,
                    pose=rigid.pose,
                    twist=self._space.twist_of(rigid),
                    motion=Motion._make((*state, free)),
                    wrench=rigid.wrench,
                    wrench_steps=None if until is None else until - now,
                )
            )
        joints = tuple(held.joint for held in self._space.joints.by_name.values())
        return WorldState(
            settings=self._settings, bodies=tuple(bodies), joints=joints, memory=key.memory
        )

    # Changing

    def replay(self, request: Request) -> None:
        """
        Carry out a request again, for which there was a place the first time.

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
            return self._join(request)
        if isinstance(request, HandRequest):
            return self._drag(request)
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
        """Return the joints that have broken since the last call, and what each gave then [N]."""
        broken, self._space.broken = self._space.broken, []
        return broken

    def step(self, count: int) -> tuple[str, ...]:
        """
        Go on by a number of steps.

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
        Go on in a space built anew from what is so, and return that.

        Whoever resumes the checkpoint later goes on with the same bits. The engine itself has a
        past that cannot be read, as in the order in which it has found contacts; a new space has
        none.
        """
        if self._fresh is not None and self._fresh.suits(self._space, self.step_count):
            return self._fresh.key
        key = take_checkpoint(self._space, self.step_count)
        space = restore_checkpoint(key, self.dt, pool=self._pool.bodies)
        _hand_over(self._space, space)
        self._replace_space(space, BodyPool(self._space))
        return key

    def resume(self, key: Checkpoint, *, going_over: bool = False) -> None:
        """
        Go back, or forward, to a checkpoint.

        :param going_over: whether the world is at that moment now, with the same bodies; then
            the contacts of the frame so far are not forgotten
        """
        self.step_count = key.step
        self._settings = key.scene.settings
        space = restore_checkpoint(key, self.dt)
        if going_over:
            _hand_over(self._space, space)
        self._replace_space(space, BodyPool())

    def build_bodies(self, count: int) -> None:
        """Make so many bodies ready for the next `renew`."""
        self._pool.build_bodies(self._space.table.scene, count)

    def _replace_space(self, space: Space, pool: BodyPool) -> None:
        self._space, self._pool, self._fresh = space, pool, None
        self._spawned = len(space.bodies.by_name)
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

    def _join(self, request: JointRequest) -> tuple[str, str]:
        match request:
            case Join(points=points, frame=frame):
                placed = points_in_world(self._space, points, frame)
                return joint_requests.join(self._space, request, placed)
            case Unjoin(name=name):
                return joint_requests.unjoin(self._space, name)
            case UnjoinAll(namespace=namespace):
                return '', joint_requests.unjoin_all(self._space, namespace)
            case Pin(point=point, frame=frame) | Axle(point=point, frame=frame):
                kind = JointKind.PIN if isinstance(request, Pin) else JointKind.AXLE
                (point,) = points_in_world(self._space, (point,), frame)
                return joint_requests.pin(self._space, kind, point)

    def _drag(self, request: HandRequest) -> tuple[str, str]:
        match request:
            case Grab(point=point, frame=frame):
                (point,) = points_in_world(self._space, (point,), frame)
                return hand_requests.grab_body(self._space, request, point)
            case MoveHand(point=point, yaw=yaw, frame=frame):
                x, y, turned = pose_in_world(self._space, (*point, yaw or 0.0), frame)
                moved = replace(request, point=(x, y), yaw=None if yaw is None else turned)
                return hand_requests.move_hand(self._space, moved, self._capacity)
            case KeepHand(hand=hand):
                return '', f'{hand} is there'
            case LetGo(hand=hand):
                return hand_requests.let_go(self._space, hand)

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
        key = checkpoint_of(state, self.step_count, self.dt)
        space = restore_checkpoint(key, self.dt)
        space.joints.check_springs(
            {name: rigid.body for name, rigid in space.bodies.by_name.items()}
        )
        self._settings = state.settings
        self._replace_space(space, BodyPool())
        self._fresh = _Fresh(key, space, space.changes)

    def _step_after(self, seconds: float) -> int:
        return self.step_count + steps_in(seconds, self.physics_rate)


def steps_in(seconds: float, physics_rate: float) -> int:
    """
    Return how many steps something takes that goes on for so long, at least one.

    :param physics_rate: of the world [Hz]
    """
    # Less a billionth, and a few last bits: 0.1 s at 240 Hz is 24 steps, not 25.
    return max(1, math.ceil(seconds * physics_rate * (1.0 - 1e-15) - 1e-9))


class _Fresh(NamedTuple):
    """
    A checkpoint, and the space that was built from it.

    :ivar changes: of the space then
    """

    key: Checkpoint
    space: Space
    changes: int

    def suits(self, space: Space, step: int) -> bool:
        """Tell whether a space is still as it was built, at a step."""
        as_built = self.space is space and space.age == 0 and space.changes == self.changes
        return as_built and self.key.step == step


def _hand_over(old: Space, new: Space) -> None:
    """Hand on what an older space of the same bodies has reported of the frame so far."""
    report = new.pipeline.contact_report
    report.copy_sums(old.pipeline.contact_report, old.table.ids, new.table.ids)
    new.broken = old.broken
