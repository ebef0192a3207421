# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Position corrections that keep the energy: of continuous collision and of first touches.

A body that is set back against gravity or a wrench gets the velocity that it had at that place.
Otherwise each bounce of a falling body would gain the potential energy of the displacement.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.engine import memory
from physsim_ros.engine.step_context import StepContext
from physsim_ros.model.arrays import Flags, Floats, Ints
from physsim_ros.model.transform import dots


def are_jointed(context: StepContext, rows: Ints) -> Flags:
    """Return which rows are dynamic bodies with joints: the joint solver removes their work."""
    columns = context.table.columns
    jointed = np.zeros(len(columns.dynamic), np.bool_)
    jointed[columns.joined] = True
    found: Flags = (jointed & columns.dynamic)[rows]
    return found


def corrected_twists(context: StepContext, states: Floats, backs: Floats) -> Floats:
    """
    Return the velocities that bodies had at the places to which they are set back.

    :param states: (k, 24) float64: numbers of `cpBody`
    :param backs: (k, 2) float64: displacement by which each is set back [m]
    :return: (k, 3) float64 [m/s, rad/s]
    """
    dt = context.dt
    velocities, spins = states[:, memory.BODY_VELOCITY], states[:, memory.BODY_SPIN]
    inverse = states[:, memory.BODY_INVERSE_MASS, None]
    pulls = context.settings.gravity + states[:, memory.BODY_FORCE] * inverse
    ways = np.hypot(backs[:, 0], backs[:, 1])
    along = backs / np.where(ways > 0.0, ways, 1.0)[:, None]
    works = dots(pulls, backs)
    # The engine's velocity is that of half a step earlier.
    speeds = dots(velocities, along) + dots(pulls, along) * dt / 2
    squares = speeds * speeds + 2.0 * works
    changes = np.copysign(np.sqrt(np.maximum(squares, 0.0)), speeds) - speeds
    changes[works == 0.0] = 0.0
    # Energy that the translation does not have came from the spin.
    missing = np.minimum(squares, 0.0) * (works != 0.0)
    missing *= states[:, memory.BODY_INVERSE_MOMENT] / inverse[:, 0]
    left = np.where(
        missing < 0.0, np.sqrt(np.maximum(spins * spins + missing, 0.0)), np.abs(spins)
    )
    return np.column_stack((velocities + along * changes[:, None], np.copysign(left, spins)))
