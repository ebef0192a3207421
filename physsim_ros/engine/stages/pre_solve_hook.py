# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

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
