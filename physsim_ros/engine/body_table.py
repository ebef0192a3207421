# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
One table of all bodies: a row each, in spawn order, and last a row for the background.

The engine lists bodies by *slot*, in an order that changes whenever one falls asleep, wakes, comes
or goes. The table maps slots to rows, so that everything outside of it speaks of rows alone.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from physsim_ros.engine.batch_io import BatchIO, Ids
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.ccd.fast_bodies import slow_bounds
from physsim_ros.engine.core import dtype_of
from physsim_ros.engine.core_world import address_of
from physsim_ros.engine.graph_search import Rows
from physsim_ros.engine.memory import place_of
from physsim_ros.engine.scene_columns import columns_of
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.scene import Scene
from physsim_ros.model.transform import NO_WRENCH
import pymunk
from pymunk._chipmunk_cffi import lib

# A body beyond this position or speed is removed [m, m/s, rad, rad/s]; float64 resolves 0.1 mm
# there.
LOST = 1e12
_BODY = dtype_of('Body')


class BodyTable:
    """
    The bodies of a space by column.

    :param scene: of these bodies
    :param bodies: in spawn order
    :param background: Pymunk's static body, which has the walls
    :param io: reads and writes the arrays of the space
    :param dt: length of a step [s]

    :ivar columns: numbers that follow from the scene alone
    :ivar leads: (n, 3) float64: the half-step lead of each body in free flight, wrench included
    :ivar free: (n,) bool: in free flight, so that the engine's velocity leads by `leads`
    :ivar asleep: (n,) bool: asleep in the engine at the last reading
    :ivar sleepers: count of sleeping bodies
    :ivar can_fly: (n,) bool: awake, not on a floor, and free flight has a half-step lead
    :ivar may_fly: whether any body can
    :ivar places: (n + 1,) int64: of `cpBody`, by which `memory` reads it
    :ivar slot_changes: count of changes of the slots, by bodies that fell asleep or woke
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
        self.columns = columns_of(scene, dt)
        self.leads = self.columns.gravity_lead.copy(order='F')
        for row, rigid in enumerate(bodies):
            if rigid.wrench != NO_WRENCH:
                self.leads[row] = rigid.lead(scene.settings.gravity, dt)
        self.free = np.array([rigid.free for rigid in bodies], np.bool_)
        self.slot_changes = 0
        self._io = io
        self.ids: Ids = np.array([*(rigid.pm_id for rigid in bodies), background.id], np.uint64)
        places = (rigid.place for rigid in bodies)
        self.places = np.array([*places, place_of(background._body)], np.int64)  # noqa: SLF001
        self._by_place = np.argsort(self.places)
        self.records = np.zeros(len(self.ids), _BODY)
        self.records['engine'] = [
            *(address_of(rigid.pm_body) for rigid in bodies),
            address_of(background),
        ]
        self.records['dynamic'] = self.columns.dynamic
        self.records['anchored'] = self.columns.anchored
        self._ascending = np.argsort(self.ids)
        self._sorted_ids = self.ids[self._ascending]
        self._state: Floats | None = None
        self._sizes: Floats | None = None
        # Bounds of positions and velocities within which a body is neither lost nor fast.
        self._bounds = np.full((len(bodies), 6), LOST, order='F')
        np.minimum(LOST, slow_bounds(self.columns, dt), out=self._bounds[:, 3:])
        self._all_within: bool | None = None
        self._listed, _ = io.read_states()
        self._map_slots()

    def rows_of(self, ids: Ids) -> Rows:
        """Return the rows of engine ids; an id that is in no row is the background."""
        near = np.minimum(np.searchsorted(self._sorted_ids, ids), len(self.ids) - 1)
        rows: Rows = self._ascending[near]
        return np.where(self._sorted_ids[near] == ids, rows, len(self.bodies))

    def rows_at(self, places: Ints) -> Rows:
        """Return the rows of bodies by the places of their `cpBody`."""
        rows: Rows = self._by_place[np.searchsorted(self.places, places, sorter=self._by_place)]
        return rows

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
        # Column by column: NumPy is three times slower with rows of a thousand bodies.
        return np.asfortranarray(states.take(self._slots, axis=0))

    def lost(self) -> list[str]:
        """Return the names of the bodies whose state is not finite, or too large."""
        if self.all_slow:
            return []
        # NaN compares false, so that it is lost too.
        far = ~(self.sizes < LOST).all(axis=1)
        return [self.scene.names[row] for row in np.flatnonzero(far)]

    def write_state(self, state: Floats) -> None:
        """Set the poses and velocities of all bodies, (n, 6) float64; no body may sleep."""
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
        if self.sleepers:
            awake = ~self.asleep[rows]
            rows, poses = rows[awake], poses[awake]
        before = state[rows, :3].tolist()
        for row, old, new in zip(rows.tolist(), before, poses.tolist(), strict=True):
            if new != old:
                # Pymunk's own attributes check and convert each value: ten times the cost.
                pm_body, (x, y, yaw) = self.bodies[row].pm_body._body, new  # noqa: SLF001
                lib.cpBodySetPosition(pm_body, (x, y))
                lib.cpBodySetAngle(pm_body, yaw)
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
        # On a floor nothing flies.
        self.can_fly &= self.columns.floor_friction == 0.0
        self.may_fly = np.count_nonzero(self.can_fly) > 0
