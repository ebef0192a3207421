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
A bell in the engine: it rings in the middle of a step, and tells which bodies are struck in it.

At its sound all contacts of the step are found, and their speeds, and none is solved.
"""

from __future__ import annotations

from collections.abc import Callable

import pymunk

# From this restitution on, bodies pass blows on rather than take them as one.
ELASTIC = 0.75
# What is slower is no blow, but the tremor of what lies still [m/s].
SLOWEST = 0.05


def hang(space: pymunk.Space, ring: Callable[..., None]) -> pymunk.Constraint:
    """Have something called before the contacts of each step are solved, and return by what."""
    # A joint that holds nothing.
    bell = pymunk.RotaryLimitJoint(space.static_body, pymunk.Body(1.0, 1.0), -1.0, 1.0)
    bell.pre_solve = ring
    space.add(bell)
    return bell


def struck(arbiter: pymunk.Arbiter) -> list[pymunk.Body]:
    """Return the bodies that forces move where two shapes touch elastically; none elsewhere."""
    if arbiter.restitution < ELASTIC:
        return []
    return [body for body in arbiter.bodies if body.body_type == pymunk.Body.DYNAMIC]
