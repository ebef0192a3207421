# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Damping of resting contacts: the solver's own errors taken out of what friction locks in place.

Problem: sequential impulses stop after a few iterations and warm-start the next step. For the
slow bending of a stack that is a spring without a damper: a stack of ten boxes sways for half a
minute after it is put down (law 18), and never becomes slow enough to sleep.
Method: our own. A body that lies with a face on something that does not move, its friction inside
the cone, does not move either (Coulomb). Where such contacts lead from a body down to what is
fixed, the velocity that it still has is error; a share of it is removed, several times a second.
Bodies that slide, roll, fly, stand on a corner or on something that moves are never touched, nor
those that are faster than such an error can be.
Cost: one look at the contacts, eight times a second of simulation.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.engine.batch_io import BatchIO
from physsim_ros.engine.body import RigidBody
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.graph_search import reachable
from physsim_ros.engine.scene_columns import SceneColumns
from physsim_ros.engine.settings import IDLE_SPEED
from physsim_ros.engine.step_context import StepContext
from physsim_ros.model.arrays import Flags, Floats
from pymunk import batch

# Rate of the damping [Hz]: the solver itself damps faster swaying than half of this in a second.
RATE = 8.0
# Share of the velocity that is removed each time: three quarters of a sway in a second.
DAMPED_SHARE = 0.3
# Greatest velocity of an error [m/s]: what the solver leaves of a stack that is put down.
FASTEST_ERROR = 0.1
# Least velocity of an error that is damped [m/s]; slower bodies fall asleep by themselves.
SLOWEST_ERROR = IDLE_SPEED / 20
# Share of the friction cone inside which a contact sticks; one that slides lies on the cone to the
# last bit.
INSIDE = 0.999

_F = batch.ArbiterFields
_CONTACT = _F.BODY_A_ID | _F.BODY_B_ID | _F.IS_FIRST_CONTACT
_CONTACT |= _F.CONTACT_COUNT | _F.TOTAL_IMPULSE | _F.NORMAL


class RestingDamping:
    """
    Damps bodies that friction locks in place.

    :param io: of a space whose `collision_persistence` is 1, so that it lists only contacts of
        the last step
    :param dt: of a step [s]
    """

    def __init__(self, io: BatchIO, dt: float) -> None:
        self._io = io
        self._period = max(1, round(1.0 / (RATE * dt)))
        # Names of bodies whose velocity was set since the last step.
        self._thrown: set[str] = set()

    def exempt_body(self, rigid: RigidBody) -> None:
        """Do not damp a body in the next step, since its velocity has just been set."""
        self._thrown.add(rigid.body.name)

    def damp_resting(self, context: StepContext) -> None:
        """Remove a share of the velocity of bodies locked in place, every so many steps."""
        thrown, self._thrown = self._thrown, set()
        if context.age % self._period:
            return
        table, twists = context.table, context.twists
        speed = point_speeds(table.columns, twists)
        slow = table.columns.dynamic[:-1] & (speed < FASTEST_ERROR)
        slow[[row for name in thrown if (row := table.columns.rows.get(name)) is not None]] = False
        visible = slow & (speed > SLOWEST_ERROR) & ~table.asleep
        if not visible.any():
            return
        anchored = table.columns.anchored
        locked = self._locked(table, np.append(slow, False) | anchored)[:-1] & visible
        twists[locked] *= 1.0 - DAMPED_SHARE
        # One by one: batch writes are wrong while any body sleeps.
        for row in np.flatnonzero(locked).tolist():
            pm_body = table.bodies[row].pm_body
            vx, vy, pm_body.angular_velocity = twists[row].tolist()
            pm_body.velocity = vx, vy

    def _locked(self, table: BodyTable, slow: Flags) -> Flags:
        """Return (n + 1,) bool: anchored bodies, and those that sticking faces tie to one."""
        ints, floats = self._io.read_contacts(_CONTACT)
        ints, floats = ints.reshape(-1, 4), floats.reshape(-1, 4)
        # A face has two points. At a first touch the impulse is that of an impact.
        face = (ints[:, 3] == 2) & (ints[:, 2] == 0)
        impulse, normal = floats[face, :2], floats[face, 2:]
        along = np.abs((impulse * normal).sum(axis=1))
        across = np.abs(impulse[:, 0] * normal[:, 1] - impulse[:, 1] * normal[:, 0])
        pairs = table.rows_of(ints[face, :2])
        friction = table.columns.friction[pairs].prod(axis=1)
        sticks = (across < INSIDE * friction * along) & slow[pairs].all(axis=1)
        return reachable(table.columns.anchored, pairs[sticks])


def point_speeds(columns: SceneColumns, twists: Floats) -> Floats:
    """Return (n,) float64: a bound on the speed of any point of each body [m/s]."""
    speeds: Floats = np.hypot(twists[:, 0], twists[:, 1])
    return speeds + np.abs(twists[:, 2]) * columns.reach
