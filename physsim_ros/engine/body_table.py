# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
One table of all bodies: a row each, in spawn order, and last a row for the background.

Columns that stay until a body comes, goes or changes are made once. The engine lists bodies by
*slot*, in an order that changes whenever one falls asleep, wakes, comes or goes; the table maps
slots to rows, so that everything outside of it speaks of rows alone.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from physsim_ros.engine.batch_io import BatchIO, Ids
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.ccd.body_extents import corner_count, safe_depths, turning_radius
from physsim_ros.engine.fast_bodies import slow_bounds
from physsim_ros.engine.graph_search import reachable, Rows
from physsim_ros.engine.memory import indices_of
from physsim_ros.model.arrays import Flags, Floats, greatest, Ints
from physsim_ros.model.joints import JointKind
from physsim_ros.model.scene import Scene
from physsim_ros.model.transform import NO_WRENCH
import pymunk
from pymunk._chipmunk_cffi import lib

# A body beyond this position or speed is removed [m, m/s, rad, rad/s]; float64 resolves 0.1 mm
# there.
LOST = 1e12


class SceneColumns(NamedTuple):
    """
    Columns that follow from the scene alone, for n bodies.

    :ivar rows: name -> row
    :ivar moving: whether there is a body that is not anchored; else a step changes nothing
    :ivar most_elastic: greatest restitution of a pair that could collide
    :ivar dynamic: (n + 1,) bool: forces move it; never the background
    :ivar anchored: (n + 1,) bool: it does not move at all; always the background
    :ivar friction: (n + 1,) float64: the engine's coefficient, whose products are those of pairs
    :ivar elasticity: (n + 1,) float64: the same of restitution
    :ivar reach: (n,) float64: greatest distance of a point of it from the centre of mass [m]
    :ivar offsets: (n, 2) float64: the engine's origin in the body's frame [m]
    :ivar gravity_lead: (n, 3) float64: half a step of gravity [m/s, m/s, rad/s]
    :ivar solid: (n,) bool: neither anchored nor a sensor
    :ivar safe_depths: (n,) float64: how far it may be entered in a step unseen [m]
    :ivar turning_radii: (n,) float64: how far out its turning counts for continuous collision [m]
    :ivar corners: (n,) float64: of its pieces, the cost of continuous collision
    :ivar pieces: (n,) float64: count of the pieces of each body
    :ivar half_widths: (n,) float64: of the thinnest piece of each body [m]
    :ivar groups: (n,) int64: bodies of one group pass through each other; 0 is none
    :ivar joined: (j, 2) intp: rows of the two bodies of each joint
    :ivar not_colliding: (k, 2) intp: rows of bodies that a joint keeps from colliding
    :ivar sprung: (n,) bool: part of an island of joints that hangs on a spring and on something
        that forces do not move, so that its velocity has no half-step lead
    :ivar on_springs: (s,) intp: rows of the dynamic bodies that springs pull
    :ivar expiries: step -> names of the bodies that are removed at its end
    """

    rows: dict[str, int]
    moving: bool
    most_elastic: float
    dynamic: Flags
    anchored: Flags
    friction: Floats
    elasticity: Floats
    reach: Floats
    offsets: Floats
    gravity_lead: Floats
    solid: Flags
    safe_depths: Floats
    turning_radii: Floats
    corners: Floats
    pieces: Floats
    half_widths: Floats
    groups: Ints
    joined: Rows
    not_colliding: Rows
    sprung: Flags
    on_springs: Rows
    expiries: dict[int, list[str]]


class BodyTable:
    """
    The bodies of a space by column.

    :param scene: of these bodies
    :param bodies: of the engine, in spawn order
    :param background: the engine's body of all that is no body
    :param io: of the space
    :param dt: of a step [s]

    :ivar columns: numbers that follow from the scene alone
    :ivar leads: (n, 3) float64: the half-step lead of each body in free flight, wrench included
    :ivar free: (n,) bool: in free flight, so that the engine's velocity leads by that
    :ivar asleep: (n,) bool: in the engine's sleep, as of the last reading
    :ivar sleepers: count of those
    :ivar can_fly: (n,) bool: awake, and free flight has a half-step lead
    :ivar may_fly: whether any can
    :ivar memory: (n + 1,) int64: index of each body in the engine's memory
    :ivar slot_changes: counts how often slots were found changed, by sleeping and waking
    """

    def __init__(
        self,
        scene: Scene,
        bodies: Sequence[RigidBody],
        background: pymunk.Body,
        io: BatchIO,
        dt: float,
    ) -> None:
        self.scene = scene
        self.bodies = tuple(bodies)
        self.columns = _columns_of(scene, dt)
        self.leads = self.columns.gravity_lead.copy(order='F')
        for row, rigid in enumerate(bodies):
            if rigid.wrench != NO_WRENCH:
                self.leads[row] = rigid.lead(scene.settings.gravity, dt)
        self.free = np.array([rigid.free for rigid in bodies], np.bool_)
        self.slot_changes = 0
        self._io = io
        ids = [rigid.engine.id for rigid in bodies]
        self.ids: Ids = np.array([*ids, background.id], np.uint64)
        self.memory = indices_of((*(rigid.engine for rigid in bodies), background))
        self._by_memory = np.argsort(self.memory)
        self._ascending = np.argsort(self.ids)
        self._sorted_ids = self.ids[self._ascending]
        self._rows = {rigid.engine: row for row, rigid in enumerate(bodies)}
        self._state: Floats | None = None
        self._sizes: Floats | None = None
        # Of positions and velocities: within them a body is neither lost nor fast.
        self._bounds = np.full((len(bodies), 6), LOST, order='F')
        np.minimum(LOST, slow_bounds(self.columns, dt), out=self._bounds[:, 3:])
        self._all_within: bool | None = None
        self._listed, _ = io.read_states()
        self._map_slots()

    def rows_of(self, ids: Ids) -> Rows:
        """Return the rows of engine ids; of one that is no body's, that of the background."""
        near = np.minimum(np.searchsorted(self._sorted_ids, ids), len(self.ids) - 1)
        rows: Rows = self._ascending[near]
        return np.where(self._sorted_ids[near] == ids, rows, len(self.bodies))

    def rows_in_memory(self, indices: Ints) -> Rows:
        """Return the rows of bodies by their indices in the engine's memory."""
        rows: Rows = self._by_memory[np.searchsorted(self.memory, indices, sorter=self._by_memory)]
        return rows

    def row_of(self, engine: pymunk.Body) -> int | None:
        """Return the row of one of the engine's bodies; None is the background."""
        return self._rows.get(engine)

    @property
    def state(self) -> Floats:
        """Return (n, 6) float64: poses and velocities of the engine's origins; read only."""
        if self._state is None:
            self._state = self.read_states()[:-1]
        return self._state

    @property
    def state_with_background(self) -> Floats:
        """Return (n + 1, 6) float64: the same, and zeros for the background."""
        return np.concatenate((self.state, np.zeros((1, 6))))

    @property
    def sizes(self) -> Floats:
        """Return (n, 6) float64: the absolute values of `state`; read only."""
        if self._sizes is None:
            self._sizes = np.abs(self.state)
        return self._sizes

    @property
    def all_slow(self) -> bool:
        """Return whether no body is lost, or fast enough for any stage (`fast_bodies`)."""
        if self._all_within is None:
            # NaN compares false.
            within = self.sizes < self._bounds
            self._all_within = np.count_nonzero(within) == within.size
        return self._all_within

    def read_states(self) -> Floats:
        """
        Return poses and velocities as the engine has them now, in the middle of a step too.

        :return: (n + 1, 6) float64, by row [m, rad, m/s, rad/s]
        """
        listed, states = self._io.read_states()
        if listed != self._listed:
            self._listed = listed
            self.slot_changes += 1
            self._map_slots()
        # By column: numpy computes with rows of a thousand bodies three times as slowly.
        return np.asfortranarray(states.take(self._slots, axis=0))

    def lost(self) -> list[str]:
        """Return the names of the bodies whose state is not finite, or too large."""
        if self.all_slow:
            return []
        # NaN compares false, so that it is lost too.
        far = ~(self.sizes < LOST).all(axis=1)
        return [self.scene.names[row] for row in np.flatnonzero(far)]

    def write_state(self, state: Floats) -> None:
        """Set the poses and velocities of all bodies, (n, 6) float64; none may sleep."""
        states = np.zeros((len(self.ids), 6))
        states[self._slots[:-1]] = state
        self._io.write_states(states)
        self.forget_state()

    def write_poses(self, rows: Rows, poses: Floats) -> None:
        """
        Set the poses of some bodies, sleeping ones excepted.

        :param rows: (k,) of the bodies
        :param poses: (k, 3) float64: of the engine's origins [m, rad]
        """
        state = self.state
        moved = (state[rows, :3] != poses).any(axis=1) & ~self.asleep[rows]
        rows, poses = rows[moved], poses[moved]
        for row, (x, y, yaw) in zip(rows.tolist(), poses.tolist(), strict=True):
            # Pymunk's own attributes check and convert each value: ten times the cost.
            engine = self.bodies[row].engine._body  # noqa: SLF001
            lib.cpBodySetPosition(engine, (x, y))
            lib.cpBodySetAngle(engine, yaw)
        state[rows, :3] = poses
        self._sizes = self._all_within = None

    def forget_state(self) -> None:
        """Drop the cached state, which the engine has changed."""
        self._state = self._sizes = self._all_within = None

    def store_flags(self) -> None:
        """Write to each body whether it is in free flight, before the table is dropped."""
        for rigid, free in zip(self.bodies, self.free.tolist(), strict=True):
            rigid.free = free

    def _map_slots(self) -> None:
        rows = self.rows_of(np.frombuffer(self._listed, np.uint64))
        slots = np.empty(len(self.ids), np.intp)
        slots[rows] = np.arange(len(rows))
        self._slots = slots
        # The engine lists sleeping bodies behind all static ones, the background among them.
        dynamic = self.columns.dynamic[:-1]
        self.asleep = dynamic & (slots[:-1] > slots[-1])
        self.sleepers = np.count_nonzero(self.asleep)
        self.can_fly = dynamic & ~self.columns.sprung & ~self.asleep
        self.may_fly = np.count_nonzero(self.can_fly) > 0


# A world is often built anew from the scene that it has, and then another one follows it.
@lru_cache(maxsize=2)
def _columns_of(scene: Scene, dt: float) -> SceneColumns:
    bodies, count = scene.bodies, len(scene.bodies)
    anchored = np.array([*(body.anchored for body in bodies), True], np.bool_)
    dynamic = np.array([*(body.dynamic for body in bodies), False], np.bool_)
    sensor = np.array([body.sensor for body in bodies], np.bool_)
    lead = (*(half * dt / 2 for half in scene.settings.gravity), 0.0)
    elasticity = np.sqrt([*(body.elasticity for body in bodies), scene.settings.elasticity])
    friction = [*(body.friction for body in bodies), scene.settings.friction]
    rows = {name: row for row, name in enumerate(scene.names)}
    ends = [(rows[joint.a], rows.get(joint.b, count)) for joint in scene.joints]
    joined = np.array(ends, np.intp).reshape(-1, 2)
    # With the background, which has no shape but walls, a jointed body collides.
    collide = np.array([joint.collide or joint.b not in rows for joint in scene.joints], np.bool_)
    springs = np.array([joint.kind is JointKind.SPRING for joint in scene.joints], np.bool_)
    expiries: dict[int, list[str]] = {}
    for body in bodies:
        if body.expires is not None:
            expiries.setdefault(body.expires, []).append(body.name)
    return SceneColumns(
        rows=rows,
        moving=bool((~anchored[:-1]).any()),
        most_elastic=greatest(elasticity[:-1]) * greatest(elasticity),
        dynamic=dynamic,
        anchored=anchored,
        friction=np.sqrt(friction),
        elasticity=elasticity,
        reach=np.array([body.shape.form.outer for body in bodies]),
        offsets=np.where(anchored[:-1, None], 0.0, scene.centroids),
        gravity_lead=np.where(dynamic[:-1, None], lead, 0.0),
        solid=~anchored[:-1] & ~sensor,
        safe_depths=safe_depths(bodies),
        turning_radii=np.array([turning_radius(body) for body in bodies]),
        corners=np.array([corner_count(body) for body in bodies], np.float64),
        pieces=np.array([len(body.shape.form.pieces) for body in bodies], np.float64),
        half_widths=np.array([body.shape.form.inner for body in bodies]),
        groups=np.array([body.group for body in bodies], np.int64),
        joined=joined,
        not_colliding=joined[~collide],
        sprung=_sprung(dynamic, joined, springs),
        on_springs=np.unique(joined[springs][dynamic[joined[springs]]]),
        expiries=expiries,
    )


def _sprung(dynamic: Flags, joined: Rows, springs: Flags) -> Flags:
    """
    Return (n,) bool: dynamic bodies of islands that hang on a spring, and on what is not dynamic.

    :param dynamic: (n + 1,) bool
    :param joined: (j, 2) intp: rows of each joint
    :param springs: (j,) bool: which of the joints are springs
    """
    within: Flags = np.asarray(dynamic[joined].all(axis=1))

    def islands_with(joints: Flags) -> Flags:
        marked = np.zeros(len(dynamic), np.bool_)
        marked[joined[joints]] = True
        return reachable(marked & dynamic, joined[within])

    return (islands_with(~within) & islands_with(springs))[:-1]
