# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Half-step velocity: exact free flight (leapfrog; Störmer, Verlet).

Problem: the engine moves a body with the velocity of the step before and then accelerates it, so
that a thrown ball falls ½ g t dt too far (law 1: 4 cm in 2 s at 240 Hz).
Method: while a body is in free flight, the engine's velocity leads the true one by half a step of
its acceleration; what is reported is the true one. A body is in free flight if its velocity
changed in the last step by its acceleration and by nothing else. True velocities do not jump when
a body begins or ceases to fly.
Cost: a comparison of velocities before and after each step.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
from physsim_ros.engine.batch_io import BatchIO
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.stages.support_graph import find_unsupported
from physsim_ros.engine.step_context import StepContext
from physsim_ros.model.arrays import Flags, Floats
from physsim_ros.model.transform import rotated_each
import pymunk

# Difference of a sum in another order, as a share of the velocity.
ROUNDING = 1e-12


class StartState(NamedTuple):
    """
    The state that the next step begins with.

    :ivar state: (n, 6) float64: poses and velocities of the engine's origins
    :ivar free: (n,) bool: in free flight, so that the velocity leads
    :ivar unsupported: (n,) bool: falls since its support was removed; the engine has to forget
        the impulses of its contacts
    """

    state: Floats
    free: Flags
    unsupported: Flags


class HalfStep:
    """
    Finds bodies in free flight, and keeps the lead of their velocities.

    :param pm_space: of the engine
    :param io: of the space
    """

    def __init__(self, pm_space: pymunk.Space, io: BatchIO) -> None:
        self._pm_space = pm_space
        self._io = io
        # Names of the bodies from which something was removed since the last step.
        self._released: set[str] = set()

    def release_bodies(self, rigids: Iterable[RigidBody]) -> None:
        """Note bodies whose support may have been removed, or moved away."""
        self._released.update(rigid.body.name for rigid in rigids)

    def start_state(self, table: BodyTable) -> StartState:
        """Return the state that the next step begins with, after all requests until now."""
        columns, free, state = table.columns, table.free, table.state
        unsupported = np.zeros(len(free), np.bool_)
        if table.sleepers:
            # A sleeping body does not move, whatever velocity the engine keeps for it.
            state = state.copy()
            state[table.asleep, 3:] = 0.0
        if not self._may_change(table):
            return StartState(state, free, unsupported)
        flies = free & ~columns.sprung
        rows = [columns.rows[name] for name in self._released if name in columns.rows]
        released = sorted(row for row in rows if columns.dynamic[row])
        if released:
            unsupported = find_unsupported(self._pm_space, self._io, table, released)
            flies = flies | unsupported
        if not np.array_equal(flies, free):
            state = state.copy()
            begin, end = flies & ~free, free & ~flies
            state[begin, 3:] += table.leads[begin]
            state[end, 3:] -= table.leads[end]
        return StartState(state, flies, unsupported)

    def _may_change(self, table: BodyTable) -> bool:
        """Return whether requests may have begun or ended the free flight of a body."""
        return bool(self._released) or len(table.columns.on_springs) > 0

    def begin_step(self, table: BodyTable) -> list[int]:
        """
        Write the half-step leads of bodies whose free flight requests have changed.

        :return: rows of the bodies whose support was removed
        """
        if not self._may_change(table):
            return []
        start = self.start_state(table)
        self._released.clear()
        changed = np.flatnonzero(start.free != table.free).tolist()
        for row in changed:
            pm_body = table.bodies[row].pm_body
            vx, vy, pm_body.angular_velocity = start.state[row, 3:].tolist()
            pm_body.velocity = vx, vy
        if changed:
            table.free = start.free
            table.forget_state()
        return np.flatnonzero(start.unsupported).tolist()

    @staticmethod
    def find_free(context: StepContext) -> None:
        """Find which bodies the step only accelerated: those are in free flight."""
        table = context.table
        # Reads which bodies sleep, too.
        after = table.state[:, 3:]
        if not table.may_fly:
            table.free = np.zeros(len(after), np.bool_)
            return
        kept = (1.0 - context.settings.damping) ** context.dt
        flown = context.twists * kept + 2.0 * table.leads
        same = np.abs(flown - after) <= ROUNDING * (1.0 + table.sizes[:, 3:])
        table.free = table.can_fly & same[:, 0] & same[:, 1] & same[:, 2]


def observe_bodies(table: BodyTable, start: StartState) -> tuple[Floats, Floats]:
    """
    Return poses of the bodies' origins and true twists of their centres of mass.

    :param start: the state that the next step begins with
    :return: (n, 3) float64 each: x, y [m], yaw [rad]; velocity [m/s], spin [rad/s]
    """
    poses, twists = start.state[:, :3].copy(), start.state[:, 3:].copy()
    offsets = table.columns.offsets
    if np.count_nonzero(offsets):
        poses[:, :2] -= rotated_each(offsets, poses[:, 2])
    if np.count_nonzero(start.free):
        twists -= np.where(start.free[:, None], table.leads, 0.0)
    return poses, twists
