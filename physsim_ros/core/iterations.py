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
How often the engine goes through the contacts of a step: less often where all is at rest.

The engine begins a step with the impulses of the one before. Where these have left every body the
velocity that it had, and where it was, next to nothing is left to be solved for in the next.

Law: what rests stays where it would by all iterations, and what creeps is changed by no more than
`STIRS` in a step. A step in which shapes begin to touch, or before which anything was asked, has
all of them.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.core.arrays import Floats
from physsim_ros.core.engine_arrays import EngineArrays
import pymunk

# So many do for what rests. Of a single box two leave 1e-9 m/s; by one alone a pile stirs.
FEW = 3
# Velocities that change by no more in a step rest [m/s, rad/s], and no more rest that change by
# ten times as much: to go from few iterations to all of them and back keeps a pile swaying.
CALM = 1e-10
STIRS = 1e-9
# What goes faster meets its contacts at another place in each step [m/s, rad/s], whether it flies
# or is pushed out of what it overlaps, for which it has no velocity.
SLOW = 0.002
# Steps from one look at how far all have gone to the next.
LOOK = 8


class Iterations:
    """
    Chooses how often the engine goes through the contacts of each step.

    :param space: whose contacts they are
    :param arrays: of it
    :param dt: of a step [s]

    :ivar most: iterations where anything moves
    :ivar resting: steps since anything has moved
    """

    def __init__(self, space: pymunk.Space, arrays: EngineArrays, dt: float) -> None:
        self.most: int = space.iterations
        self.resting = 0
        self._space = space
        self._arrays = arrays
        self._near = SLOW * LOOK * dt
        # What the last step began with: velocities, and the count of changes from outside.
        self._twists: Floats = np.empty((0, 3))
        self._changes = -1
        # Steps in which neither has changed, and where all was when that was looked at last.
        self._same = 0
        self._poses: Floats | None = None
        self._near_by = False

    def choose(self, twists: Floats, changes: int) -> None:
        """
        Choose for the coming step.

        :param twists: (m, 3) float64: velocities [m/s] and spins [rad/s] that it begins with
        :param changes: counts what has been done to the bodies from outside
        """
        limit = STIRS if self.resting else CALM
        same = changes == self._changes and np.abs(twists - self._twists).max(initial=0.0) <= limit
        self._twists, self._changes = twists, changes
        if not same:
            self.stir()
            return
        if self._same % LOOK == 0:
            self._look()
        self._same += 1
        self.resting = self.resting + 1 if self._near_by else 0
        self._space.iterations = min(FEW, self.most) if self._near_by else self.most

    def _look(self) -> None:
        """Find whether anything has gone far since the last time."""
        poses = self._arrays.states()[:, :3]
        self._near_by = self._poses is not None and bool(
            np.abs(poses - self._poses).max(initial=0.0) <= self._near
        )
        self._poses = poses

    def stir(self) -> None:
        """Have all of them in the coming step, or in the one that is being made."""
        self.resting = self._same = 0
        self._poses = None
        self._space.iterations = self.most
