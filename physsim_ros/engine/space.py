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
The engine's side of the world: bodies and joints in a Pymunk space, stepped, read and changed.

Laws: a Pymunk object never leaves the core; what is read is a fresh array in spawn order; true
velocities do not jump when gravity or a wrench changes; what loses its footing falls as one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
import math

import numpy as np
from physsim_ros.engine import body as rigid_body
from physsim_ros.engine.articulation.joint_set import Machine
from physsim_ros.engine.batch_io import EngineArrays, Ids
from physsim_ros.engine.body import REST, RigidBody
from physsim_ros.engine.body_table import lay_out, Layout
from physsim_ros.engine.boundary import Walls
from physsim_ros.engine.ccd import continuous
from physsim_ros.engine.ccd.candidates import FastBodies
from physsim_ros.engine.contact_report import ContactLog
from physsim_ros.engine.stages import pre_solve_hook
from physsim_ros.engine.stages.half_step import Flight, Settled
from physsim_ros.engine.stages.impact_propagation import Cascade
from physsim_ros.engine.stages.resting_damping import RATE, Stillness
from physsim_ros.engine.stages.simultaneous_impacts import Blows
from physsim_ros.engine.stages.sleeping import Rest, SLOW, SLOW_IN_AIR, STRIDE
from physsim_ros.engine.warm_start import forget, recall, remind, ShapeIds, weaken
from physsim_ros.model.arrays import Floats, greatest
from physsim_ros.model.checkpoint import Checkpoint, Motion
from physsim_ros.model.scene import Body, Joint, Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Contacts
from physsim_ros.model.transform import Point, Pose, turned
import pymunk

# A point so near counts as inside [m]: on the seam of two pieces it lies inside neither.
SEAM = 1e-9
# What has come further than this has left every world [m]; float64 holds 0.1 mm there.
LOST = 1e12


class Space:
    """
    Bodies in the engine.

    :param settings: of the world
    :param dt: of a step [s]
    :param key: what it goes on from; None is an empty space
    :param spares: bodies that have been built beforehand, by name
    :param before: the space that this one follows, from which it takes what has been found out of
        the joints; None is none
    """

    def __init__(
        self,
        settings: WorldSettings,
        dt: float,
        *,
        key: Checkpoint | None = None,
        spares: Mapping[str, RigidBody] | None = None,
        before: Space | None = None,
    ) -> None:
        self.bodies: dict[str, RigidBody] = {}
        # Counts what has been done to it from outside.
        self.changes = 0
        # What it counted when joints were held last, and what cannot have given energy since.
        self._powerless = 0
        self._settings = settings
        self._dt = dt
        self._names: dict[pymunk.Body, str] = {}
        self._pushed: dict[str, RigidBody] = {}
        # Those whose velocity has been set since the last step: they are not calmed in the next.
        self._thrown: set[str] = set()
        self._layout: Layout | None = None
        self._space = pymunk.Space()
        self._arrays = EngineArrays(self._space)
        self._space.collision_slop = continuous.SLOP
        # The engine lists contacts of the last step only, and forgets at once what parted.
        self._space.collision_persistence = 1
        self._shapes = ShapeIds(self._space)
        self._watching = False
        self._walls = Walls(self._space, self._shapes)
        known = None if before is None else before.machine
        self.machine: Machine = Machine(self._space, self._arrays, self.bodies, dt, before=known)
        # Joints that have broken, and what each gave then [N]; whoever reads it empties it.
        self.broken: list[tuple[str, float]] = []
        self._fast = FastBodies(self._space, self._arrays, self.bodies, self._names, dt)
        self._rest = Rest(self._arrays, dt)
        self._contacts = ContactLog(self._arrays)
        self._stillness = Stillness(self._arrays)
        self._flight = Flight(self._space, self._arrays, self.bodies)
        self._cascade = Cascade(self._space)
        self._blows = Blows(self._space, self._arrays)
        self._calm_steps = max(1, round(1.0 / (RATE * dt)))
        # Steps since the space was empty: what is done every so many steps counts from there, so
        # that a restored state goes on alike at whatever step it is restored.
        self._age = 0
        self.configure(settings)
        if key is not None:
            self._shapes.following = key.memory.walls
        self._raise_walls()
        if key is not None:
            self._fill(key, spares or {})
        # Only now: what is filled in has touched before.
        self._space.on_collision(begin=self._begin)

    # Reading

    @property
    def scene(self) -> Scene:
        """Return everything about the bodies that stays while they move."""
        return self._lay_out().scene

    def rows(self) -> tuple[Scene, Floats, Floats]:
        """Return the scene, and (n, 3) float64 poses and twists, in spawn order."""
        layout, (state, free, _) = self._lay_out(), self._settled()
        poses, twists = state[:, :3].copy(), state[:, 3:].copy()
        if layout.offsets.any():
            poses[:, :2] -= turned(layout.offsets, poses[:, 2])
        twists -= np.where(free[:, None], layout.lead, 0.0)
        return layout.scene, poses, twists

    def forces(self) -> Floats:
        """Return (j,) float64: what each joint gave in the last step [N]."""
        return self.machine.forces(self._lay_out().listed)

    def contacts(self, centers: Callable[[], Floats]) -> Contacts:
        """
        Return what touched since the last call while steps were watched.

        :param centers: gives (n, 2) float64: centres of mass, world [m]
        """
        layout = self._lay_out()
        return self._contacts.take(layout.ids, layout.id_rows, centers)

    def clear_contacts(self) -> None:
        """Forget what touched since the last call of `contacts`."""
        self._contacts.clear()

    def essence(self) -> Iterator[bytes]:
        """Yield all that is known of the bodies, but for what the engine remembers of contacts."""
        layout, (state, free, _) = self._lay_out(), self._settled()
        yield layout.scene.key
        yield state.tobytes()
        yield free.tobytes()
        # In spawn order, whichever was pushed first.
        for rigid in sorted(self._pushed.values(), key=lambda rigid: rigid.serial):
            yield f'{rigid.body.name} {rigid.wrench!r} {rigid.wrench_until}'.encode()

    def keyframe(self, step: int) -> Checkpoint:
        """Return all that the bodies go on from; `step` is the number of steps made."""
        layout, (state, free, fallen) = self._lay_out(), self._settled()
        rigids = list(self.bodies.values())
        ids = [rigid.first for rigid in rigids]
        return Checkpoint(
            step=step,
            scene=layout.scene,
            state=state.copy(),
            free=free.copy(),
            wrenches=tuple(
                (row, rigid.wrench, rigid.wrench_until)
                for row, rigid in enumerate(rigids)
                if rigid.body.name in self._pushed
            ),
            memory=recall(self._shapes, ids, self._walls.first, forgotten=fallen),
            forces=self.forces(),
        )

    def bodies_at(self, point: Point) -> list[str]:
        """Return the bodies that cover a point of the world [m], the highest serial first."""
        names = set()
        # What coasts has gone on since the engine looked where its shapes are.
        for hit in self._space.point_query(point, SEAM + SLOW * STRIDE, pymunk.ShapeFilter()):
            hit.shape.cache_bb()
            if hit.shape.body in self._names and hit.shape.point_query(point).distance <= SEAM:
                names.add(self._names[hit.shape.body])
        return sorted(names, key=lambda name: -self.bodies[name].serial)

    def twist(self, rigid: RigidBody) -> Pose:
        """Return the true velocity of a body."""
        if self._layout is not None:
            rigid.free = bool(self._layout.free[self._layout.rows[rigid.body.name]])
        return rigid.twist(self._settings.gravity, self._dt)

    # Changing

    def configure(self, settings: WorldSettings) -> None:
        """Let other settings hold from now on."""
        self._unlay()
        old, self._settings = self._settings, settings
        self.changes += old != settings
        if old.gravity != settings.gravity:
            share = _share(old.gravity, settings.gravity)
            if share < 1.0:
                weaken(self._shapes, share)
            for name, rigid in self.bodies.items():
                # Where nothing of it is left, what lay on something lies there no more.
                if rigid.free or not (share or self.machine.has(name)):
                    twist = rigid.twist(old.gravity, self._dt)
                    rigid.set_twist(twist, settings.gravity, self._dt)
        self._space.gravity = settings.gravity
        self._space.damping = 1.0 - settings.damping
        self._space.iterations = settings.iterations
        walls = (settings.bounds, settings.friction, settings.elasticity)
        if walls != (old.bounds, old.friction, old.elasticity):
            # Only then: what lies on the walls would stir.
            self._raise_walls()

    def add(self, body: Body, serial: int, pose: Pose, twist: Pose) -> RigidBody:
        """Take a new body into the space."""
        rigid = rigid_body.build(body, serial)
        self._put(rigid, pose, twist)
        return rigid

    def change(self, old: RigidBody, body: Body, pose: Pose, twist: Pose) -> None:
        """Replace a body by what it has become; its place in the spawn order stays."""
        if _same_in_engine(old.body, body):
            # Nothing that the engine knows has changed; it keeps what it remembers of contacts.
            if body != old.body:
                self._unlay()
                self.changes += 1
                old.body = body
            if pose != old.pose:
                self.set_pose(old, pose)
            if twist != self.twist(old):
                self.set_twist(old, twist)
            return
        rigid = rigid_body.build(body, old.serial)
        pose = self._unwound(old, pose)
        touching = self._touching(old.engine)
        self.machine.detach(body.name)
        self._take(old)
        self._put(rigid, pose, twist)
        self.machine.attach(body.name)
        self._flight.let_go(touching)
        if old.wrench != REST and not body.fixed:
            self.push(rigid, old.wrench, old.wrench_until)

    def remove(self, name: str) -> None:
        """Take a body and its joints out of the space for good."""
        rigid = self.bodies[name]
        touching = self._touching(rigid.engine)
        for joint in self.machine.of(name):
            self.unjoin(joint)
        self._take(rigid)
        del self.bodies[name]
        self._flight.let_go(touching)

    def set_pose(self, rigid: RigidBody, pose: Pose) -> None:
        """Put a body somewhere else."""
        self.changes += 1
        rigid.pose = self._unwound(rigid, pose)
        self._fast.forget_standing()
        self._forget_state()
        self._flight.let_go(self._touching(rigid.engine))

    def join(self, joint: Joint) -> None:
        """Take in a joint; it replaces one of that name in its place."""
        self._unlay()
        self.changes += 1
        self.machine.put(joint)

    def unjoin(self, name: str) -> None:
        """Take a joint out."""
        self._unlay()
        self.changes += 1
        self._powerless += 1
        joint = self.machine.joints[name].joint
        self.machine.remove(name)
        self._flight.let_go(
            [self.bodies[body] for body in (joint.a, joint.b) if body in self.bodies]
        )

    def set_twist(self, rigid: RigidBody, twist: Pose) -> None:
        """Let a body fly freely at a velocity."""
        self.changes += 1
        rigid.set_twist(twist, self._settings.gravity, self._dt)
        self._thrown.add(rigid.body.name)
        if self._layout is not None and not rigid.body.anchored:
            self._layout.free[self._layout.rows[rigid.body.name]] = True
        self._forget_state()

    def set_motion(self, rigid: RigidBody, motion: Motion) -> None:
        """Let a body go on from saved numbers."""
        self._unlay()
        rigid.go_on_from(motion)

    def push(self, rigid: RigidBody, wrench: Pose, until: int | None) -> None:
        """Let a wrench act from now on, to the step `until`; None is for ever."""
        self.changes += 1
        twist, free = self.twist(rigid), rigid.free
        rigid.wrench, rigid.wrench_until = wrench, until
        if wrench == REST:
            self._pushed.pop(rigid.body.name, None)
        else:
            self._pushed[rigid.body.name] = rigid
        if self._layout is not None:
            row = self._layout.rows[rigid.body.name]
            self._layout.lead[row] = rigid.lead(self._settings.gravity, self._dt)
        if free:
            self.set_twist(rigid, twist)

    def limit_wrenches(self, until: int | None) -> None:
        """Let no wrench act longer than to a step; None is for ever."""
        for rigid in list(self._pushed.values()):
            if until is not None and (rigid.wrench_until is None or rigid.wrench_until > until):
                self.push(rigid, rigid.wrench, until)

    def inherit(self, old: Space) -> None:
        """Take over what an older space of the same bodies has seen of the frame so far."""
        self._contacts.inherit(old._contacts, old._engine_ids(), self._engine_ids())
        self.broken = old.broken

    def retire(self) -> None:
        """
        Have the engine forget all contacts; for a space that is used no more.

        It goes through all that it remembers for each shape that is taken out.
        """
        self.machine.clear()
        states = self._arrays.states()
        states[:] = 0.0
        states[:, 0] = np.arange(len(states)) * 1e6
        self._arrays.write_states(states)
        self._space.step(self._dt)

    def give_up(self) -> RigidBody | None:
        """Take a body out of a retired space, as good as new; None is none left."""
        if not self.bodies:
            return None
        rigid = self.bodies.popitem()[1]
        self._shapes.remove(rigid.engine.shapes)
        self._space.remove(rigid.engine)
        # What the last step left for the next to push out.
        pymunk.Body.update_position(rigid.engine, 0.0)
        rigid.wrench, rigid.wrench_until, rigid.free = REST, None, True
        return rigid

    def _engine_ids(self) -> Ids:
        """Return the engine's ids of all bodies, in spawn order, and of the background."""
        return np.append(self._lay_out().engine_ids, self._space.static_body.id)

    def _fill(self, key: Checkpoint, spares: Mapping[str, RigidBody]) -> None:
        """Take in all bodies at once, and go on from where they were."""
        for serial, body in enumerate(key.scene.bodies):
            rigid = spares.get(body.name)
            if rigid is None or rigid.body is not body:
                rigid = rigid_body.build(body, serial)
            rigid.serial = serial
            self.bodies[body.name] = rigid
            self._names[rigid.engine] = body.name
        rigids = list(self.bodies.values())
        self._space.add(*(rigid.engine for rigid in rigids))
        layout = self._lay_out(key.scene)
        at_rest = key.state.copy()
        at_rest[:, 3:] = 0.0
        self._write_state(layout, at_rest)
        for rigid, first in zip(rigids, key.memory.ids.tolist(), strict=True):
            rigid.first = first
        self._shapes.put_back((rigid.first, rigid.engine.shapes) for rigid in rigids)
        remind(self._space, self._shapes, key.memory, self._dt)
        self._write_state(layout, key.state)
        for joint in key.scene.joints:
            self.machine.put(joint)
        self.machine.go_on_from(key.forces)
        layout.free = key.free.copy()
        for row, wrench, until in key.wrenches:
            rigid = rigids[row]
            rigid.wrench, rigid.wrench_until = wrench, until
            self._pushed[rigid.body.name] = rigid
            layout.lead[row] = rigid.lead(self._settings.gravity, self._dt)

    def _unwound(self, rigid: RigidBody, pose: Pose) -> Pose:
        """Return a pose with as many whole turns as a jointed body has made: joints count them."""
        if not self.machine.has(rigid.body.name):
            return pose
        turns = round((rigid.engine.angle - pose[2]) / math.tau)
        return pose[0], pose[1], pose[2] + turns * math.tau

    def _put(self, rigid: RigidBody, pose: Pose, twist: Pose) -> None:
        """Take a body into the space."""
        self._unlay()
        self.changes += 1
        rigid.pose = pose
        rigid.set_twist(twist, self._settings.gravity, self._dt)
        self.bodies[rigid.body.name] = rigid
        self._names[rigid.engine] = rigid.body.name
        self._space.add(rigid.engine)
        rigid.first = self._shapes.add(rigid.engine.shapes)

    def _take(self, rigid: RigidBody) -> None:
        """Take a body out of the space."""
        self._unlay()
        self.changes += 1
        self._shapes.remove(rigid.engine.shapes)
        self._space.remove(rigid.engine)
        del self._names[rigid.engine]
        self._contacts.forget(rigid.engine.id)
        self._cascade.forget(rigid.engine)
        self._pushed.pop(rigid.body.name, None)

    def _touching(self, engine: pymunk.Body) -> list[RigidBody]:
        """Return the bodies that touched one, or the background, in the last step."""
        found: list[pymunk.Body] = []
        engine.each_arbiter(lambda arbiter: found.extend(arbiter.bodies))
        names = dict.fromkeys(self._names[each] for each in found if each in self._names)
        return [self.bodies[name] for name in names]

    def _raise_walls(self) -> None:
        background = self._space.static_body
        touching = self._touching(background)
        self._walls.follow(self._settings)
        self._contacts.forget(background.id)
        self._fast.forget_standing()
        self._flight.let_go(touching)

    # Stepping

    def step(self, number: int, *, watching: bool, last: bool) -> tuple[str, ...]:
        """
        Make a step.

        :param number: steps that the world has made
        :param watching: whether contacts are read
        :param last: whether the state after it will be looked at
        :return: bodies that had left the range of numbers, and were removed before it
        """
        self._end_wrenches(number)
        self._settle()
        self._watching = watching
        expired = self._lay_out().expiries.get(number + 1, ())
        lost: tuple[str, ...] = ()
        broken: tuple[tuple[str, float], ...] = ()
        coasts = self._rest.coasts(self._age, self.changes)
        if coasts:
            self._rest.coast(seen=last or bool(expired))
            self._forget_state()
        else:
            # When a wrench ends, or anything lets go, what flies is told from what does not,
            # however steps are counted out.
            ends = any(rigid.wrench_until == number + 1 for rigid in self._pushed.values())
            lost, broken = self._solve(told=last or ends or bool(expired))
        if not watching:
            self._contacts.skip_step()
        elif coasts:
            self._contacts.repeat_step()
        else:
            self._contacts.add_step()
        self._age += 1
        for name in expired:
            if name in self.bodies:
                self.remove(name)
        for name, force in broken:
            if name in self.machine.joints:
                self.unjoin(name)
                self.broken.append((name, force))
        return lost

    def _solve(self, *, told: bool) -> tuple[tuple[str, ...], tuple[tuple[str, float], ...]]:
        """
        Have the engine make a step.

        :param told: whether it has to be told after it what flies
        :return: bodies that were lost and removed before it, and joints that broke in it with
            what they gave [N]
        """
        lost: tuple[str, ...] = ()
        self._rest.catch_up()
        self._push_all()
        before = self._arrays.twists()
        fastest = greatest(before)
        # NaN compares false.
        if not fastest < LOST:
            lost = self.drop_lost()
            before = self._arrays.twists()
            fastest = greatest(before)
        layout = self._lay_out()
        if self._age % self._calm_steps == 0:
            rows = [layout.rows[name] for name in self._thrown if name in layout.rows]
            self._stillness.calm(layout.ground, before, layout.order[rows])
        self._thrown.clear()
        self._fast.arrest(layout, before, fastest)
        if self.machine.joints:
            self.machine.prepare(layout.listed, self._states)
        self._space.step(self._dt)
        layout.state = None
        if self.machine.joints:
            driven = bool(self._pushed) or self.changes != self._powerless
            self._hold(layout, before, driven=driven)
            self._powerless = self.changes
        self._rest.look(before, self.changes, slow=self._is_slow(layout, before, fastest))
        broken = tuple(self.machine.broken())
        # What coasts flies, or does not, as it did in the step before.
        if told or broken or self._rest.steps:
            kept = (1.0 - self._settings.damping) ** self._dt
            self._flight.judge(layout, before * kept, self._state(layout))
            if self._rest.steps and self._flight.accelerates(layout):
                self._rest.stir()
        return lost, broken

    def _is_slow(self, layout: Layout, twists: Floats, fastest: float) -> bool:
        """Tell whether all are so slow that most steps need no engine if they go on like this."""
        limit = SLOW_IN_AIR if self._settings.damping else SLOW
        if self.machine.joints or fastest > min(limit, layout.unswept * self._dt / STRIDE):
            return False
        return greatest(layout.ground.speeds(twists)) <= limit

    def _settle(self) -> None:
        """Let what has lost its footing fly, and what hangs on a spring not."""
        layout = self._lay_out()
        if not self._flight.is_unsettled(layout):
            return
        state, free, fallen = self._settled()
        self._flight.forget_loosened()
        if state is not layout.state:
            self.changes += 1
            twists = self._arrays.twists()
            twists[layout.order] = state[:, 3:]
            self._arrays.write_twists(twists)
            layout.state, layout.free = state, free
        if len(fallen):
            forget(self._shapes, fallen)

    def drop_lost(self) -> tuple[str, ...]:
        """Remove what has left the range of numbers, before it poisons what it touches."""
        layout = self._lay_out()
        far = np.abs(self._state(layout))
        # NaN compares false, so that it is lost too.
        if far.size == 0 or far.max() < LOST:
            return ()
        lost = ~(far < LOST).all(axis=1)
        names = tuple(layout.scene.names[row] for row in np.flatnonzero(lost))
        for name in names:
            self.remove(name)
        return names

    def _end_wrenches(self, number: int) -> None:
        """Let wrenches end that act no longer than to a step."""
        for rigid in list(self._pushed.values()):
            if rigid.wrench_until is not None and rigid.wrench_until <= number:
                self.push(rigid, REST, None)

    def _push_all(self) -> None:
        """Apply the wrenches in the coming step of the engine, which forgets them after it."""
        for rigid in self._pushed.values():
            fx, fy, rigid.engine.torque = rigid.wrench
            rigid.engine.force = fx, fy

    def _begin(self, arbiter: pymunk.Arbiter, space: pymunk.Space, _: object) -> None:
        """Look at two shapes that touch for the first time."""
        contact = arbiter.contact_point_set
        self._rest.stir()
        continuous.relieve(arbiter, contact, space)
        struck = pre_solve_hook.struck(arbiter)
        self._cascade.begin(struck)
        self._blows.begin(struck)
        if self._watching:
            self._contacts.begin(arbiter, contact)

    def _hold(self, layout: Layout, before: Floats, *, driven: bool) -> None:
        """Hold what the engine has not held of the joints."""
        states, rest = self._states(), np.zeros((1, 3))
        before = np.concatenate((before, rest))
        if self.machine.hold(layout.listed, states, before, driven=driven):
            self._arrays.write_twists(states[:-1, 3:])
        layout.state = states.take(layout.order, axis=0)

    # Rows

    def _states(self) -> Floats:
        """Return (m + 1, 6) float64: poses and velocities in the listing, then the background."""
        listed = self._arrays.states()
        states = np.zeros((len(listed) + 1, 6))
        states[:-1] = listed
        return states

    def _state(self, layout: Layout) -> Floats:
        """Return (n, 6) float64: poses and velocities of the engine's origins, in spawn order."""
        if layout.state is None:
            layout.state = self._arrays.states().take(layout.order, axis=0)
        return layout.state

    def _settled(self) -> Settled:
        """Return what the next step begins with, whatever has been asked since the last one."""
        layout = self._lay_out()
        return self._flight.settled(layout, self._state(layout), self.changes)

    def _write_state(self, layout: Layout, state: Floats) -> None:
        """Set the (n, 6) float64 poses and velocities of the engine's origins."""
        numbers = self._arrays.states()
        numbers[layout.order] = state
        self._arrays.write_states(numbers)
        layout.state = None

    def _forget_state(self) -> None:
        if self._layout is not None:
            self._layout.state = None

    def _lay_out(self, scene: Scene | None = None) -> Layout:
        """
        Return the layout, made anew where a body has come, gone or changed.

        :param scene: what is so; None makes a new one
        """
        if self._layout is None:
            rigids = tuple(self.bodies.values())
            if scene is None:
                bodies = tuple(rigid.body for rigid in rigids)
                joints = tuple(held.joint for held in self.machine.joints.values())
                scene = Scene(bodies=bodies, settings=self._settings, joints=joints)
            self._layout = lay_out(scene, rigids, self._arrays.ids(), self._dt)
        return self._layout

    def _unlay(self) -> None:
        """Give up the layout, before a body comes, goes or changes."""
        if self._layout is not None:
            self._layout.flatten_flight()
        self._layout = None
        self._fast.forget_standing()


def _same_in_engine(a: Body, b: Body) -> bool:
    """Tell whether two bodies differ only in what the engine does not know."""
    return a == replace(b, color=a.color, expires=a.expires)


def _share(old: Point, new: Point) -> float:
    """Return how much of what one gravity has pressed together another one still does."""
    before = math.hypot(*old)
    if before == 0.0:
        return 1.0
    along = old[0] / before * new[0] + old[1] / before * new[1]
    # No more than all of it: what springs press, and blows, do not grow with gravity.
    return min(max(along / before, 0.0), 1.0)
