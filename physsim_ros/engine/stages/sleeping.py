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
When all is at rest, or goes on as it does, and most steps need no engine.

The engine begins a step with the impulses of the one before. Where these have left every body the
velocity that it had, and have pushed none out of another, there is next to nothing to be solved
for in the next steps either: each body goes on as it did, and what touches is as it was.

Law: what rests stays where it would if every step were solved for; what something holds and is
accelerated by less than `STIRS` may be held back. A step after anything has been asked, or has
begun to touch, is solved for.
"""

from __future__ import annotations

import numpy as np
from physsim_ros.engine.batch_io import EngineArrays
from physsim_ros.model.arrays import Floats, greatest

# At rest the engine makes a step so often [s].
STRIDE = 1.0 / 30.0
# Steps in which nothing has changed before it is taken for rest.
LONG = 8
# Velocities that change faster are those of what moves [m/s², rad/s²].
STIRS = 2.5e-7
# What is pushed out of what it overlaps, for which it has no velocity, goes faster [m/s, rad/s].
PUSHED = 1e-7
# What has a point that is faster might come too far in a stride before it is seen to touch [m/s]:
# 0.7 mm, a seventh of what may overlap anyway.
SLOW = 0.02
# The same where the air slows things down, which it does in the engine's steps only [m/s].
SLOW_IN_AIR = 1e-6


class Rest:
    """
    Finds out which steps need no engine, and makes them.

    :param arrays: of the space
    :param dt: of a step [s]

    :ivar steps: in which nothing has changed, up to now
    """

    def __init__(self, arrays: EngineArrays, dt: float) -> None:
        self.steps = 0
        self._arrays = arrays
        self._dt = dt
        # Steps, of which the last is made by the engine.
        self._stride = max(1, round(STRIDE / dt))
        # What the last step has left, if it was slow: poses and velocities, and how many changes
        # from outside there had been.
        self._poses: Floats = np.empty((0, 3))
        self._twists: Floats = np.empty((0, 3))
        self._changes = -1
        # Whether all have gone further than the engine knows.
        self._ahead = False

    def coasts(self, age: int, changes: int) -> bool:
        """
        Tell whether all go on in the coming step as they did.

        :param age: steps made since the space was empty
        :param changes: counts what has been done to the bodies from outside
        """
        rests = self.steps >= LONG and changes == self._changes
        return rests and (age + 1) % self._stride != 0

    def coast(self, *, seen: bool) -> None:
        """
        Make a step in which all go on as they did.

        :param seen: whether the engine is asked after it where they are
        """
        self.steps += 1
        self._poses = self._poses + self._twists * self._dt
        self._ahead = True
        if seen:
            self.catch_up()

    def catch_up(self) -> None:
        """Have the engine know where all are."""
        if self._ahead:
            self._arrays.write_poses(self._poses)
            self._ahead = False

    def look(self, before: Floats, changes: int, *, slow: bool) -> None:
        """
        Look whether anything has changed in a step that the engine has made.

        :param before: (m, 3) float64: velocities [m/s] and spins [rad/s] that it began with
        :param changes: counts what had been done to the bodies from outside
        :param slow: whether nothing was too fast
        """
        if not slow:
            self.steps, self._changes = 0, -1
            return
        poses, known = self._poses, changes == self._changes
        self._poses, self._twists = self._arrays.poses(), self._arrays.twists()
        self._changes = changes
        rests = (
            known
            and greatest(self._twists - before) <= STIRS * self._dt
            and greatest(self._poses - poses - before * self._dt) <= PUSHED * self._dt
        )
        self.steps = self.steps + 1 if rests else 0

    def stir(self) -> None:
        """Take it that what comes is not as it was."""
        self.steps = 0
