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
The world: owns the Pymunk space; requests go in, snapshots come out.

Laws: the world changes only between steps and only in `apply`; a refusal changes nothing; the same
requests at the same steps give the same bits, in another process too.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
import hashlib
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray
from physsim_ros.core import rigid_body, stillness, sweep
from physsim_ros.core.contacts import ContactLog, Ids
from physsim_ros.core.errors import (
    Anchored,
    BadProperty,
    NothingThere,
    UnknownBody,
    UnknownFrame,
    WorldFull,
)
from physsim_ros.core.names import split_name
from physsim_ros.core.palette import color_of
from physsim_ros.core.properties import HEAVIEST, LIGHTEST
from physsim_ros.core.requests import (
    Anchor,
    check_pose,
    Command,
    Configure,
    Delete,
    DeleteAll,
    Release,
    Request,
    Restore,
    Spawn,
)
from physsim_ros.core.rigid_body import REST, RigidBody
from physsim_ros.core.settings import WorldSettings
from physsim_ros.core.shapes import Point, Pose
from physsim_ros.core.snapshot import (
    Body,
    BodyState,
    Contacts,
    Floats,
    Ints,
    Scene,
    Snapshot,
    WorldState,
)
import pymunk
from pymunk import batch

# 5 mm: the engine's own 0.1 is 10 cm in a metre world.
SLOP = 0.005
# Thickness of the walls of `bounds` [m]: what is squeezed into one still finds its way back in.
WALL = 10.0
# What has come further than this has left every world [m]; float64 holds 0.1 mm there.
LOST = 1e12

_STATE = (
    batch.BodyFields.POSITION
    | batch.BodyFields.ANGLE
    | batch.BodyFields.VELOCITY
    | batch.BodyFields.ANGULAR_VELOCITY
)
_TWIST = batch.BodyFields.VELOCITY | batch.BodyFields.ANGULAR_VELOCITY


@dataclass(slots=True, eq=False)
class _Layout:
    """
    What is constant for the rows of all bodies until one comes, goes or changes.

    :param scene: the bodies, in spawn order
    :param rows: name -> row
    :param ids: (n,): the engine's ids of the bodies, ascending
    :param id_rows: (n,): the row of each of them
    :param order: for each row, its place in the engine's own listing
    :param listed: for each place in the engine's listing, its body; None for walls
    :param safe2: for each place, the squared speed up to which no sweep is needed [m²/s²]
    :param loose: (n,) bool: whether forces move the body
    :param offsets: (n, 2): the engine's origin in the body's frame [m]
    :param lead: (n, 3): how far the engine's velocity leads in free flight
    :param free: (n,) bool: in free flight; changes from frame to frame
    :param ground: what `stillness` has to know of the bodies
    """

    scene: Scene
    rows: dict[str, int]
    ids: Ids
    id_rows: Ints
    order: NDArray[np.intp]
    listed: tuple[RigidBody | None, ...]
    safe2: Floats
    loose: NDArray[np.bool_]
    offsets: Floats
    lead: Floats
    free: NDArray[np.bool_]
    ground: stillness.Ground


class World:
    """
    A world of bodies, stepped at a fixed rate.

    :param physics_rate: steps a second of simulation time [Hz]
    :param settings: what holds at the start
    """

    def __init__(
        self, *, physics_rate: float = 240.0, settings: WorldSettings | None = None
    ) -> None:
        self.physics_rate = physics_rate
        self.dt = 1.0 / physics_rate
        self._calm_steps = max(1, round(physics_rate / stillness.RATE))
        self.step_count = 0
        # Whether contacts are read; reading them costs a tenth of a step.
        self.watching = False
        self._settings = settings or WorldSettings()
        self._buffer = batch.Buffer()
        self._open()

    def _open(self) -> None:
        """Begin with an empty space."""
        self._bodies: dict[str, RigidBody] = {}
        self._names: dict[pymunk.Body, str] = {}
        self._pushed: dict[str, RigidBody] = {}
        self._spawned = 0
        self._layout: _Layout | None = None
        self._space = pymunk.Space()
        self._space.collision_slop = SLOP
        # The engine lists contacts of the last step only, and forgets at once what parted.
        self._space.collision_persistence = 1
        self._space.on_collision(begin=self._begin)
        self._walls: list[pymunk.Shape] = []
        self._contacts = ContactLog(self._space)
        self._stillness = stillness.Stillness(self._space)
        # Steps since the space was empty: what is done every so many steps counts from there, so
        # that a restored state goes on alike at whatever step it is restored.
        self._age = 0
        self._configure(self._settings)

    # Reading

    def __len__(self) -> int:
        return len(self._bodies)

    def __contains__(self, name: str) -> bool:
        return name in self._bodies

    @property
    def settings(self) -> WorldSettings:
        """What holds for the whole world."""
        return self._settings

    def settings_with(self, changes: Mapping[str, Any]) -> WorldSettings:
        """
        Return the settings as they would be with some changed.

        :raises Refusal: they would not fit
        """
        return replace(self._settings, **changes)

    @property
    def stamp(self) -> int:
        """Simulation time [ns]."""
        return round(self.step_count * 1e9 / self.physics_rate)

    def snapshot(self) -> Snapshot:
        """Return where everything is."""
        layout = self._lay_out()
        state = self._read(_STATE, 6)[layout.order]
        poses, twists = state[:, :3].copy(), state[:, 3:].copy()
        if layout.offsets.any():
            x, y = layout.offsets.T
            cos, sin = np.cos(poses[:, 2]), np.sin(poses[:, 2])
            poses[:, 0] -= cos * x - sin * y
            poses[:, 1] -= sin * x + cos * y
        twists -= np.where(layout.free[:, None], layout.lead, 0.0)
        return Snapshot(
            step=self.step_count,
            stamp=self.stamp,
            scene=layout.scene,
            poses=poses,
            twists=twists,
        )

    def contacts(self, snapshot: Snapshot) -> Contacts:
        """Return what touched since the last call while the world was being watched."""
        layout = self._lay_out()
        return self._contacts.take(layout.ids, layout.id_rows, snapshot.centers)

    def digest(self) -> str:
        """Return a hash of everything that decides how the world goes on."""
        layout = self._lay_out()
        digest = hashlib.blake2b(digest_size=16)
        digest.update(f'{self.step_count} {self.physics_rate!r}'.encode())
        digest.update(layout.scene.key)
        digest.update(self._read(_STATE, 6)[layout.order].tobytes())
        digest.update(layout.free.tobytes())
        for name, rigid in self._pushed.items():
            digest.update(f'{name} {rigid.wrench!r} {rigid.wrench_until}'.encode())
        return digest.hexdigest()

    def body_at(self, point: Point) -> str | None:
        """Return the topmost body, that spawned last, which covers a point of the world [m]."""
        hits = self._space.point_query(point, 0.0, pymunk.ShapeFilter())
        names = {self._names[hit.shape.body] for hit in hits if hit.shape.body in self._names}
        return max(names, key=lambda name: self._bodies[name].serial, default=None)

    def save(self) -> WorldState:
        """Return everything that the world goes on from, save the engine's contact memory."""
        self._unlay()
        now = self.step_count
        bodies = []
        for rigid in self._bodies.values():
            body, until = rigid.body, rigid.wrench_until
            if body.expires is not None:
                body = replace(body, expires=body.expires - now)
            bodies.append(
                BodyState(
                    body=body,
                    pose=rigid.pose,
                    twist=rigid.twist(self._settings.gravity, self.dt),
                    motion=rigid.motion,
                    wrench=rigid.wrench,
                    wrench_steps=None if until is None else until - now,
                )
            )
        return WorldState(settings=self._settings, bodies=tuple(bodies))

    # Changing

    def apply(self, request: Request) -> tuple[str, str]:
        """
        Carry out a request.

        :return: the body concerned, or '', and a sentence that says what was done
        :raises Refusal: and nothing is changed
        """
        match request:
            case Spawn():
                return self._spawn(request)
            case Delete(name=name):
                self._remove(self._known(name).body.name)
                return name, f'deleted {name}'
            case DeleteAll(namespace=namespace):
                return '', self._delete_all(namespace)
            case Anchor(point=point, frame=frame):
                return self._hold(point, frame, anchored=True)
            case Release(point=point, frame=frame):
                return self._hold(point, frame, anchored=False)
            case Command():
                return self._command(request)
            case Configure(changes=changes):
                self._configure(self.settings_with(changes))
                return '', f'set {", ".join(changes)}'
            case Restore(state=state):
                self._restore(state)
                return '', f'loaded {len(state.bodies)} bodies'

    def step(self, count: int) -> tuple[str, ...]:
        """
        Go on by a number of steps.

        :return: bodies that left the range of numbers and were removed
        """
        for remaining in range(count, 0, -1):
            self._push_all()
            layout = self._lay_out()
            before = self._read(_TWIST, 3)
            if self._age % self._calm_steps == 0:
                self._stillness.calm(layout.ground, before)
            self._arrest(layout, before)
            self._space.step(self.dt)
            self._age += 1
            self.step_count += 1
            if self.watching:
                self._contacts.add_step()
            expired = self._expiries.pop(self.step_count, ())
            if remaining == 1 or expired:
                self._judge_flight(layout, before)
            for name in expired:
                self._remove(name)
        return self._drop_lost()

    # Requests

    def _spawn(self, request: Spawn) -> tuple[str, str]:
        name, said = request.name, request.properties
        old = self._bodies.get(name)
        if old is None and len(self._bodies) >= self._settings.max_bodies:
            raise WorldFull(f'the world holds {len(self._bodies)} bodies, the most it may')
        pose = self._in_world(request.pose, request.frame)
        body = self._described(request, old.body if old else None)
        _check_weight(body)
        moves = (said.velocity or (0.0, 0.0)) != (0.0, 0.0) or bool(said.spin)
        if body.anchored and moves:
            raise Anchored(f'{name} is anchored; it has no velocity', field='velocity')
        twist = REST if old is None or old.body.anchored else self._twist(old)
        if said.velocity is not None:
            twist = (*said.velocity, twist[2])
        if said.spin is not None:
            twist = (twist[0], twist[1], said.spin)
        if body.anchored:
            twist = REST
        if old is not None:
            self._change(old, body, pose, twist)
            return name, f'changed {name}'
        self._put(rigid_body.build(body, self._spawned), pose, twist)
        self._spawned += 1
        return name, f'spawned {name}'

    def _described(self, request: Spawn, old: Body | None) -> Body:
        """Return the body that a spawn asks for: what it says, else what was, else defaults."""
        said = request.properties
        if old is None:
            old = Body(
                name=request.name,
                shape=request.shape,
                color=request.color or color_of(self._spawned),
                mass=None,
                density=self._settings.density,
                friction=self._settings.friction,
                elasticity=self._settings.elasticity,
                anchored=False,
                kinematic=False,
                group=0,
                sensor=False,
                expires=None,
            )
        changes = said.said()
        for motion in ('velocity', 'spin'):
            changes.pop(motion, None)
        if said.density is not None:
            changes['mass'] = None
        if request.color is not None:
            changes['color'] = request.color
        if request.lifetime > 0:
            changes['expires'] = self._step_after(request.lifetime)
        return replace(old, shape=request.shape, **changes)

    def _hold(self, point: Point, frame: str, *, anchored: bool) -> tuple[str, str]:
        x, y, _ = self._in_world((*point, 0.0), frame)
        name = self.body_at((x, y))
        if name is None:
            raise NothingThere(f'there is no body at ({x:g}, {y:g})', field='point')
        rigid = self._bodies[name]
        if rigid.body.anchored != anchored:
            body = replace(rigid.body, anchored=anchored)
            self._change(rigid, body, rigid.pose, REST)
        return name, f'{"anchored" if anchored else "released"} {name}'

    def _delete_all(self, namespace: str | None) -> str:
        names = [
            name for name in self._bodies if namespace is None or split_name(name)[0] == namespace
        ]
        for name in names:
            self._remove(name)
        return f'deleted {len(names)} bodies'

    def _command(self, request: Command) -> tuple[str, str]:
        rigids = [self._known(name) for name in request.names]
        for rigid in rigids:
            if rigid.body.anchored and (request.twists or request.wrenches):
                raise Anchored(
                    f'{rigid.body.name} is anchored; it takes a pose only', field='joint_names'
                )
            if rigid.body.kinematic and request.wrenches:
                raise BadProperty(
                    f'{rigid.body.name} is kinematic; forces do not move it', field='wrench'
                )
        poses = [self._in_world(pose, request.frame) for pose in request.poses]
        for rigid, pose in zip(rigids, poses, strict=False):
            rigid.pose = pose
        for rigid, twist in zip(rigids, request.twists, strict=False):
            self._set_twist(rigid, twist)
        timeout = self._settings.command_timeout
        until = self._step_after(timeout) if timeout > 0 else None
        for rigid, wrench in zip(rigids, request.wrenches, strict=False):
            self._push(rigid, wrench, until)
        if len(rigids) == 1:
            return request.names[0], f'commanded {request.names[0]}'
        return '', f'commanded {len(rigids)} bodies'

    def _configure(self, settings: WorldSettings) -> None:
        self._unlay()
        old, self._settings = self._settings, settings
        if old.gravity != settings.gravity:
            for rigid in self._bodies.values():
                if rigid.free:
                    twist = rigid.twist(old.gravity, self.dt)
                    rigid.set_twist(twist, settings.gravity, self.dt)
        self._space.gravity = settings.gravity
        self._space.damping = 1.0 - settings.damping
        self._space.iterations = settings.iterations
        self._raise_walls()

    def _restore(self, state: WorldState) -> None:
        self._settings = state.settings
        self._open()
        for saved in state.bodies:
            body, now = saved.body, self.step_count
            if body.expires is not None:
                body = replace(body, expires=body.expires + now)
            rigid = rigid_body.build(body, self._spawned)
            self._spawned += 1
            self._put(rigid, saved.pose, saved.twist)
            if saved.wrench != REST:
                steps = saved.wrench_steps
                self._push(rigid, saved.wrench, None if steps is None else now + steps)
            if saved.motion is not None:
                rigid.motion = saved.motion

    # Bodies

    def _known(self, name: str) -> RigidBody:
        if name not in self._bodies:
            raise UnknownBody(f'there is no body {name!r}', field='name')
        return self._bodies[name]

    def _in_world(self, pose: Pose, frame: str) -> Pose:
        if not frame:
            return pose
        if frame not in self._bodies:
            raise UnknownFrame(
                f'frame {frame!r} is neither the world nor a body', field='header.frame_id'
            )
        x, y, yaw = self._bodies[frame].pose
        turned_x, turned_y = rigid_body.rotated((pose[0], pose[1]), yaw)
        result = (x + turned_x, y + turned_y, yaw + pose[2])
        check_pose(result, 'pose')
        return result

    def _put(self, rigid: RigidBody, pose: Pose, twist: Pose) -> None:
        """Take a body into the space."""
        self._unlay()
        rigid.pose = pose
        rigid.set_twist(twist, self._settings.gravity, self.dt)
        self._bodies[rigid.body.name] = rigid
        self._names[rigid.engine] = rigid.body.name
        self._space.add(rigid.engine, *rigid.engine.shapes)

    def _change(self, old: RigidBody, body: Body, pose: Pose, twist: Pose) -> None:
        """Replace a body by what it has become."""
        if _same_in_engine(old.body, body):
            # Nothing that the engine knows has changed; it keeps what it remembers of contacts.
            if body != old.body:
                self._unlay()
                old.body = body
            if pose != old.pose:
                old.pose = pose
            if twist != self._twist(old):
                self._set_twist(old, twist)
            return
        rigid = rigid_body.build(body, old.serial)
        self._take(old)
        self._put(rigid, pose, twist)
        if old.wrench != REST and not body.fixed:
            self._push(rigid, old.wrench, old.wrench_until)

    def _take(self, rigid: RigidBody) -> None:
        """Take a body out of the space; its place in the spawn order stays."""
        self._unlay()
        self._space.remove(rigid.engine, *rigid.engine.shapes)
        del self._names[rigid.engine]
        self._pushed.pop(rigid.body.name, None)

    def _remove(self, name: str) -> None:
        self._take(self._bodies[name])
        del self._bodies[name]

    def _twist(self, rigid: RigidBody) -> Pose:
        """Return the true velocity of a body as it is now."""
        if self._layout is not None:
            rigid.free = bool(self._layout.free[self._layout.rows[rigid.body.name]])
        return rigid.twist(self._settings.gravity, self.dt)

    def _set_twist(self, rigid: RigidBody, twist: Pose) -> None:
        """Let a body fly freely at a velocity."""
        rigid.set_twist(twist, self._settings.gravity, self.dt)
        if self._layout is not None:
            self._layout.free[self._layout.rows[rigid.body.name]] = True

    def _push(self, rigid: RigidBody, wrench: Pose, until: int | None) -> None:
        """Let a wrench act from now on, without a jump of the true velocity."""
        twist, free = self._twist(rigid), rigid.free
        rigid.wrench, rigid.wrench_until = wrench, until
        if wrench == REST:
            self._pushed.pop(rigid.body.name, None)
        else:
            self._pushed[rigid.body.name] = rigid
        if self._layout is not None:
            row = self._layout.rows[rigid.body.name]
            self._layout.lead[row] = rigid.lead(self._settings.gravity, self.dt)
        if free:
            self._set_twist(rigid, twist)

    def _step_after(self, seconds: float) -> int:
        # Less a billionth: 0.1 s at 240 Hz is 24 steps, not 25 for the last bit of 0.1.
        return self.step_count + max(1, math.ceil(seconds * self.physics_rate - 1e-9))

    def _raise_walls(self) -> None:
        self._space.remove(*self._walls)
        self._walls = []
        if self._settings.bounds is None:
            return
        left, bottom, right, top = self._settings.bounds
        for box in (
            pymunk.BB(left - WALL, bottom - WALL, left, top + WALL),
            pymunk.BB(right, bottom - WALL, right + WALL, top + WALL),
            pymunk.BB(left - WALL, bottom - WALL, right + WALL, bottom),
            pymunk.BB(left - WALL, top, right + WALL, top + WALL),
        ):
            wall = pymunk.Poly.create_box_bb(self._space.static_body, box)
            wall.friction = math.sqrt(self._settings.friction)
            wall.elasticity = math.sqrt(self._settings.elasticity)
            self._walls.append(wall)
        self._space.add(*self._walls)

    # Steps

    def _push_all(self) -> None:
        """Apply the wrenches of the coming step; the engine forgets them after it."""
        for rigid in list(self._pushed.values()):
            if rigid.wrench_until is not None and rigid.wrench_until <= self.step_count:
                self._push(rigid, REST, None)
            else:
                fx, fy, rigid.engine.torque = rigid.wrench
                rigid.engine.force = fx, fy

    def _begin(self, arbiter: pymunk.Arbiter, space: pymunk.Space, _: object) -> None:
        """Look at two shapes that touch for the first time."""
        sweep.relieve(arbiter, space, SLOP)
        if self.watching:
            self._contacts.begin(arbiter)

    def _arrest(self, layout: _Layout, before: Floats) -> None:
        """Shorten the coming step of the bodies that are too fast for the engine."""
        fast = (before[:, 0] ** 2 + before[:, 1] ** 2) > layout.safe2
        if fast.any():
            movers = [layout.listed[place] for place in np.flatnonzero(fast)]
            sweep.arrest(self._space, [rigid for rigid in movers if rigid is not None], self.dt)

    def _judge_flight(self, layout: _Layout, before: Floats) -> None:
        """Find which bodies the last step only accelerated: those are in free flight."""
        after = self._read(_TWIST, 3)[layout.order]
        kept = (1.0 - self._settings.damping) ** self.dt
        flown = before[layout.order] * kept + 2.0 * layout.lead
        # Rounding of the same sum in another order, nothing more.
        same = np.abs(after - flown) <= 1e-12 * (1.0 + np.abs(after))
        layout.free = same.all(axis=1) & layout.loose

    def _drop_lost(self) -> tuple[str, ...]:
        """Remove what has left the range of numbers, before it poisons what it touches."""
        layout = self._lay_out()
        state = self._read(_STATE, 6)
        # NaN compares false, so that it is lost too.
        inside = (np.abs(state) < LOST).all(axis=1)
        if inside.all():
            return ()
        rigids = [layout.listed[place] for place in np.flatnonzero(~inside)]
        names = tuple(rigid.body.name for rigid in rigids if rigid is not None)
        for name in names:
            self._remove(name)
        return names

    # Rows

    def _read(self, fields: batch.BodyFields, width: int) -> Floats:
        """Return (m, width) float64 of every body in the engine's listing."""
        # The buffer is reused (a new one a call would leak), so what leaves is a copy.
        self._buffer.clear()
        batch.get_space_bodies(self._space, fields, self._buffer)
        numbers = np.frombuffer(self._buffer.float_buf(), dtype=np.float64)
        return numbers.reshape(-1, width).copy()

    def _lay_out(self) -> _Layout:
        """Return the layout, made anew where a body has come, gone or changed."""
        if self._layout is not None:
            return self._layout
        rigids = tuple(self._bodies.values())
        self._buffer.clear()
        batch.get_space_bodies(self._space, batch.BodyFields.BODY_ID, self._buffer)
        listing = np.frombuffer(self._buffer.int_buf(), dtype=np.uintp).tolist()
        places = {id_: place for place, id_ in enumerate(listing)}
        ids = np.array([rigid.engine.id for rigid in rigids], dtype=np.uintp)
        order = [places[id_] for id_ in ids.tolist()]
        ascending = np.argsort(ids)
        listed: list[RigidBody | None] = [None] * len(listing)
        safe2 = np.full(len(listing), np.inf)
        for rigid, place in zip(rigids, order, strict=True):
            listed[place] = rigid
            if not rigid.body.fixed and not rigid.body.sensor:
                safe2[place] = (sweep.safe_depth(rigid) / self.dt) ** 2
        gravity = self._settings.gravity
        self._layout = _Layout(
            scene=Scene(bodies=tuple(rigid.body for rigid in rigids), settings=self._settings),
            rows={name: row for row, name in enumerate(self._bodies)},
            ids=ids[ascending],
            id_rows=ascending,
            order=np.array(order, dtype=np.intp),
            listed=tuple(listed),
            safe2=safe2,
            loose=np.array([not rigid.body.fixed for rigid in rigids], dtype=np.bool_),
            offsets=np.array([rigid.offset for rigid in rigids]).reshape(-1, 2),
            lead=np.array([rigid.lead(gravity, self.dt) for rigid in rigids]).reshape(-1, 3),
            free=np.array([rigid.free for rigid in rigids], dtype=np.bool_),
            ground=stillness.ground(listed, listing, self._settings.friction),
        )
        self._expiries: dict[int, list[str]] = {}
        for rigid in rigids:
            if rigid.body.expires is not None:
                self._expiries.setdefault(rigid.body.expires, []).append(rigid.body.name)
        return self._layout

    def _unlay(self) -> None:
        """Give up the layout, before a body comes, goes or changes."""
        if self._layout is not None:
            free = self._layout.free.tolist()
            for rigid, flies in zip(self._bodies.values(), free, strict=True):
                rigid.free = flies
        self._layout = None


def _same_in_engine(a: Body, b: Body) -> bool:
    """Tell whether two bodies differ only in what the engine does not know."""
    return a == replace(b, color=a.color, expires=a.expires)


def _check_weight(body: Body) -> None:
    """Refuse a body whose size and density make it too light or too heavy."""
    if not LIGHTEST <= body.weight <= HEAVIEST:
        field = 'density' if body.mass is None else 'mass'
        raise BadProperty(
            f'the body would weigh {body.weight:g} kg; {LIGHTEST:g} to {HEAVIEST:g} kg can be '
            'simulated',
            field=field,
        )
