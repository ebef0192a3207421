# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Tight boxes: the engine's broad phase lists pairs of bodies that are near, however fast they are.

**Problem.** `cpBBTree` extends the box of a shape by its way of a tenth of a second (`GetBB`), so
that a box of the tree need not change in each step. Fast bodies overlap in the tree then wherever
they are (Munk2D as in Pymunk 7.3.1): 12,000 discs of 20 km/s that touch nothing make pairs of
930 MB and steps of 1.6 s, 40 lists of 900 spheres of 1 km/s steps of 40 to 60 s. That is so in a
free fall of some minutes, too. With this stage: 52 MB and 0.07 s, and 1 s.

**Method.** A body whose extended boxes may overlap so many others that it costs less to index it
in each step is indexed where the coming step ends, at rest: the tree's box is extended by a tenth
of its size only (`GetBB`), and the engine finds it valid. Position, angle and velocity are as they
were to the bit. The others are counted in the grid of `ccd.broad_phase`; no pair is listed.

**Scope.** It depends on what is near a body, as the horizons of `ccd.swept_boxes` do: a crowd that
falls, a single fast body, and one that slides over tiles are left to the engine.

**Cost.** Some 1 us for the count of each body that is fast enough for so many pairs (22 m/s with a
half width of 5 cm), and 3 to 5 us for each that is indexed, in each step.

Without it `test/engine/stages/test_tight_boxes.py` fails. It can go once Pymunk has
`cpBBTreeSetVelocityFunc`.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.engine.body import index_at_rest
from physsim_ros.engine.ccd.broad_phase import count_candidates
from physsim_ros.engine.ccd.fast_bodies import EXTENSION, fast_in_crowd, MOST_PAIRS
from physsim_ros.engine.step_context import StepContext


def tighten_boxes(context: StepContext) -> None:
    """Keep fast bodies' broad-phase boxes tight, so that only nearby pairs are listed."""
    table, columns = context.table, context.table.columns
    if table.all_slow:
        return
    ways = context.twists[:, :2] * EXTENSION
    fast = fast_in_crowd(columns, ways)
    if not fast.any():
        return
    starts, reach = context.poses[:, :2], columns.reach[:, None]
    low, high = starts + np.minimum(ways, 0.0), starts + np.maximum(ways, 0.0)
    boxes = np.concatenate((low - reach, high + reach), axis=1)
    pairs = columns.pieces * count_candidates(boxes, fast, columns.pieces)
    for row in np.flatnonzero(pairs > MOST_PAIRS).tolist():
        index_at_rest(table.bodies[row].pm_body, ahead=context.dt)
