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
Tight boxes: the engine's broad phase lists pairs of bodies that are near, however fast they are.

**Problem.** `cpBBTree` extends the box of a shape by its way of a tenth of a second (`GetBB`), so
that a box of the tree need not change in each step. Fast bodies overlap in the tree then wherever
they are (Munk2D as in Pymunk 7.3.1): 12,000 discs of 20 km/s that touch nothing make pairs of
930 MB and steps of 1.6 s, 40 lists of 900 spheres of 1 km/s steps of 40 to 60 s. That is so in a
free fall of some minutes, too. With this stage: 52 MB and 0.07 s, and 1 s.

**Method.** A body whose way would be many times its own width is put where the coming step ends,
and its shapes are indexed there at rest: the tree's box is extended by a tenth of its size only
(`GetBB`), and the engine finds it valid. Position, angle and velocity are as they were to the bit.

**Cost.** Nothing below that speed; 5 us a body and step above it.

Without it `test/engine/stages/test_tight_boxes.py` fails. It can go once Pymunk has
`cpBBTreeSetVelocityFunc`.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.engine.body import index_at_rest
from physsim_ros.engine.step_context import StepContext

# The engine extends a box by the way of so long [s].
EXTENSION = 0.1
# Least extension, in half widths of a body's thinnest piece, that is avoided: boxes of that length
# overlap some hundred others in a dense crowd.
MOST = 16.0


def tighten_boxes(context: StepContext) -> None:
    """Have the engine's broad phase bound fast bodies where the coming step ends."""
    table = context.table
    speeds = np.hypot(context.twists[:, 0], context.twists[:, 1])
    fast = speeds * EXTENSION > MOST * table.columns.half_widths
    for row in np.flatnonzero(fast).tolist():
        index_at_rest(table.bodies[row].engine, ahead=context.dt)
