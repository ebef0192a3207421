# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Continuous collision: the coming step of fast bodies ends where they first hit something.

The engine tests for overlap only where a step ends. Pairs that approach by more than a safe depth
in a step are found by a broad phase of swept boxes, and advanced to their time of impact. For the
rest of the step the two move as one rigid body with their common momentum and angular momentum
(a perfectly plastic impact, of the positions only): a light body is carried along by a heavy one
and by a kinematic one, and stops at an anchored one. The engine then finds the contact where the
step ends, and resolves it from the velocities, which stay as they are.

Laws: bodies that meet keep the displacement of their common centre of mass, unless one is anchored
or kinematic; a pair that overlaps is stopped only where it would come deeper; islands that do not
meet do not depend on each other.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.engine import memory
from physsim_ros.engine.body_table import BodyTable
from physsim_ros.engine.ccd.broad_phase import boxes_overlap
from physsim_ros.engine.ccd.fast_bodies import fast_bodies
from physsim_ros.engine.ccd.hulls import Hulls, static_shapes, StaticShapes
from physsim_ros.engine.ccd.impact_islands import ImpactIslands
from physsim_ros.engine.step_context import StepContext
from physsim_ros.engine.work_correction import are_jointed, corrected_twists
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.transform import dots
import pymunk

# Up to this many fast bodies, boxes are compared first: it saves time, and changes no result.
FEW = 8


class ContinuousCollision:
    """
    Ends the coming step of fast bodies where they first hit something.

    :param pm_space: of the engine
    :param hulls: of its shapes
    """

    def __init__(self, pm_space: pymunk.Space, hulls: Hulls) -> None:
        self._pm_space = pm_space
        self._hulls = hulls
        self._table: BodyTable | None = None
        self._static: StaticShapes | None = None

    def invalidate(self) -> None:
        """Read static shapes anew, since one of them has been moved."""
        self._table = None

    def clamp_moves(self, context: StepContext) -> None:
        """Set bodies back, so that the engine moves them to their first impact and no further."""
        table = context.table
        if table.all_slow:
            return
        moves = context.twists * context.dt
        fast = fast_bodies(table.columns, moves)
        if not fast.any():
            return
        if self._table is not table or self._static is None:
            static = static_shapes(self._pm_space, table, self._hulls)
            self._table, self._static = table, static
        rows = np.flatnonzero(fast)
        if len(rows) <= FEW and not _boxes_meet(table, self._static, moves, rows):
            return
        step = ImpactIslands(table, self._static, moves, self._hulls)
        moved, shifts = step.shifts(fast)
        self._set_back(context, moved, shifts, moves[moved, :2])

    def _set_back(self, context: StepContext, rows: Ints, shifts: Floats, ways: Floats) -> None:
        """
        Set bodies back.

        :param shifts: (k, 3) displacements [m, rad]
        :param ways: (k, 2) displacements of the centres of mass in the step [m]
        """
        if not len(rows):
            return
        pm_bodies = [context.table.bodies[row].pm_body for row in rows.tolist()]
        for pm_body, (x, y, turn) in zip(pm_bodies, shifts.tolist(), strict=True):
            pm_body.position += (x, y)
            pm_body.angle += turn
        # Correct only a body's own motion, not motion imparted by another body.
        shares = -dots(ways, shifts[:, :2]) / np.maximum(dots(ways, ways), 1e-300)
        backs = -ways * np.clip(shares, 0.0, 1.0)[:, None]
        places = memory.places_of(pm_bodies)
        states = memory.read_numbers(places, memory.BODY_WORDS)
        twists = corrected_twists(context, states, backs)
        loose = ~are_jointed(context, rows)
        context.twists[rows[loose]] = twists[loose]
        memory.write_numbers(places[loose], memory.BODY_TWIST, twists[loose])
        context.table.forget_state()


def _boxes_meet(table: BodyTable, static: StaticShapes, moves: Floats, rows: Ints) -> bool:
    """
    Return whether the swept box of a body overlaps that of another, or a static shape.

    :param moves: (n, 3) float64: of all bodies in the step [m, rad]
    :param rows: of the bodies in question
    """
    starts = table.state[:, :2]
    ends = starts + np.where(table.columns.solid[:, None], moves[:, :2], 0.0)
    reach = table.columns.reach[:, None]
    boxes = np.concatenate((np.minimum(starts, ends) - reach, np.maximum(starts, ends) + reach), 1)
    # Anchored bodies are among the static shapes; each other one overlaps itself.
    solid = boxes[table.columns.solid]
    return any(
        np.count_nonzero(boxes_overlap(boxes[row], solid)) > 1
        or boxes_overlap(boxes[row], static.boxes).any()
        for row in rows.tolist()
    )
