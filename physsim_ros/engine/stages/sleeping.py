# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Sleeping by island, as Chipmunk has it: an island at rest costs nothing until something wakes it.

Problem: a settled pile costs as much as a falling one. Method: Chipmunk's sleeping (contact graph
and joints make islands; an island whose bodies all had little energy for a while is taken out of
the solver; Box2D does the same). Pymunk does not wake bodies that overlap a static or kinematic
body which is added or moved; `wake_overlapping` does. A checkpoint wakes all, so that a restored
space and the one that went on are in the same state.
Cost: none. Without it: 1,000 bodies at rest cost as much as 1,000 that move.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from physsim_ros.engine.settings import IDLE_SPEED
from physsim_ros.engine.step_context import StepContext
import pymunk

# A body on a spring that accelerates by no more than this is at rest [m/s², rad/s²]: one that
# swings in 40 s is then within 1 mm of where it rests.
REST_ACCELERATION = 2.5e-5


def keep_flying_awake(context: StepContext) -> None:
    """Keep bodies awake that fly slowly: nothing would stop them (Newton's first law)."""
    table = context.table
    if not np.count_nonzero(table.free):
        return
    speeds = table.sizes[:, 3:]
    slow = speeds < IDLE_SPEED
    for row in (table.free & slow[:, 0] & slow[:, 1] & slow[:, 2]).nonzero()[0].tolist():
        if speeds[row].any():
            # Chipmunk begins to count idle time anew.
            table.bodies[row].pm_body.activate()


def keep_swinging_awake(context: StepContext) -> None:
    """Keep bodies on springs awake that accelerate: a slow swing has only reached its turn."""
    table, rows = context.table, context.table.columns.on_springs
    if not len(rows):
        return
    twists = table.state[rows, 3:]
    slow = np.abs(twists).max(axis=1, initial=0.0) < IDLE_SPEED
    changes = np.abs(twists - context.twists[rows]).max(axis=1, initial=0.0)
    for row in rows[slow & (changes > REST_ACCELERATION * context.dt)].tolist():
        table.bodies[row].pm_body.activate()


def wake_bodies(bodies: Iterable[pymunk.Body]) -> None:
    """Wake dynamic bodies, and with each its whole island."""
    for body in bodies:
        if body.is_sleeping:
            body.activate()


def wake_overlapping(pm_space: pymunk.Space, body: pymunk.Body) -> None:
    """Wake the bodies that overlap one: the engine compares static shapes with awake ones only."""
    hits = (hit.shape for shape in body.shapes for hit in pm_space.shape_query(shape))
    wake_bodies(shape.body for shape in hits if shape is not None and shape.body is not None)
