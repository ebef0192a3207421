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
velocity that it had, and nothing moves far, next to nothing is left to be solved for in the next.

Law: what rests, rests as it would by all iterations; a step in which shapes begin to touch, or
before which anything was asked, has all of them.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.core.arrays import Floats
import pymunk

# So many do for what rests. Of a single box two leave 1e-9 m/s; by one alone a pile stirs.
FEW = 3
# What changes by no more in a step is the same [m/s, rad/s].
SAME = 1e-8
# What is faster meets its contacts at another place in each step [m/s, rad/s].
SLOW = 0.01


class Iterations:
    """
    Chooses how often the engine goes through the contacts of each step.

    :param space: whose contacts they are

    :ivar most: iterations where anything moves
    :ivar resting: steps since anything has moved
    """

    def __init__(self, space: pymunk.Space) -> None:
        self.most: int = space.iterations
        self.resting = 0
        self._space = space
        # What the last step began with: velocities, and the count of changes from outside.
        self._twists: Floats = np.empty((0, 3))
        self._changes = -1

    def choose(self, twists: Floats, changes: int, *, fastest: float) -> None:
        """
        Choose for the coming step.

        :param twists: (m, 3) float64: velocities [m/s] and spins [rad/s] that it begins with
        :param changes: counts what has been done to the bodies from outside
        :param fastest: of the numbers in `twists`
        """
        rests = (
            fastest <= SLOW
            and changes == self._changes
            and np.abs(twists - self._twists).max(initial=0.0) <= SAME
        )
        self.resting = self.resting + 1 if rests else 0
        self._space.iterations = min(FEW, self.most) if rests else self.most
        self._twists, self._changes = twists, changes

    def stir(self) -> None:
        """Have all of them in the coming step, or in the one that is being made."""
        self.resting = 0
        self._space.iterations = self.most
