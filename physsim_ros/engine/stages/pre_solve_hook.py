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
Call a function between the narrow phase and the solver of a Pymunk step.

At that moment all contacts of the step are known, with their target velocities, and none has been
solved. Pymunk 7.3.1 has no hook there: `Space.on_collision(pre_solve=...)` calls Python once a
pair of shapes, while pairs are still being found, which doubles the time of a step. Constraints
have one: `cpSpaceStep` calls `Constraint.pre_solve` after `cpArbiterPreStep` of all contacts. The
hook is a constraint that does nothing else; it can go once Pymunk has a callback of the space
there.
"""

from __future__ import annotations

from collections.abc import Callable

import pymunk


def add_pre_solve(
    space: pymunk.Space, function: Callable[[pymunk.Constraint, pymunk.Space], None]
) -> None:
    """Call a function in each step of a space, before its contacts are solved."""
    # A massive body outside the space, whose angle stays 0 and within the limits.
    hook = pymunk.RotaryLimitJoint(space.static_body, pymunk.Body(1.0, 1.0), -1.0, 1.0)
    hook.pre_solve = function
    space.add(hook)
