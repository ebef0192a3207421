# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Conveyors: sensors whose surface moves, and with it the floor under what is on them.

A body is on a conveyor where its centre of mass is inside of it; of several, the one that was
spawned last counts.
"""

from __future__ import annotations

from functools import lru_cache
import math

import numpy as np
from physsim_ros.engine.step_context import StepContext
from physsim_ros.model.arrays import Floats
from physsim_ros.model.scene import Scene
from physsim_ros.model.shapes import contains
from physsim_ros.model.transform import rotated_each


@lru_cache(maxsize=2)
def conveyors_of(scene: Scene) -> tuple[int, ...]:
    """Return the rows of the conveyors of a scene."""
    return tuple(row for row, body in enumerate(scene.bodies) if any(body.surface_velocity))


def floor_velocities(context: StepContext) -> Floats | None:
    """
    Return the velocity of the floor under each body.

    :return: (n, 3) float64: at the centre of mass, world axes [m/s], turn [rad/s]; None where the
        floor stands still
    """
    table, rows = context.table, conveyors_of(context.table.scene)
    if not rows:
        return None
    velocities = np.zeros((len(table.bodies), 3))
    centers = context.poses[:, :2]
    for row in rows:
        body, yaw = table.scene.bodies[row], context.poses[row, 2]
        # The engine's origin of a body is its centre of mass; of an anchored one, its own.
        around = centers - context.poses[row, :2]
        local = rotated_each(around, -yaw) + table.columns.offsets[row]
        on = contains(body.shape.form.pieces, *local.T)
        on[row] = False
        vx, vy, spin = context.twists[row].tolist()
        sx, sy = body.surface_velocity
        cos, sin = math.cos(yaw), math.sin(yaw)
        velocities[on, 0] = vx + cos * sx - sin * sy - spin * around[on, 1]
        velocities[on, 1] = vy + sin * sx + cos * sy + spin * around[on, 0]
        velocities[on, 2] = spin
    return velocities
