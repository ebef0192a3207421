# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A step of the engine with a call between its narrow phase and its solver.

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


class PreSolveHook:
    """
    The hook of a space.

    :param pm_space: of the engine
    """

    def __init__(self, pm_space: pymunk.Space) -> None:
        self._pm_space = pm_space
        # A massive body outside the space, whose angle stays 0 and within the limits.
        body = pymunk.Body(1.0, 1.0)
        constraint = pymunk.RotaryLimitJoint(pm_space.static_body, body, -1.0, 1.0)
        constraint.pre_solve = lambda *_: self._before_solving()
        pm_space.add(constraint)
        # In a step that is not made here, as for a warm start, there is nothing to do.
        self._before_solving: Callable[[], None] = lambda: None

    def step(self, dt: float, before_solving: Callable[[], None]) -> None:
        """Make a step of the engine, with a call before its contacts are solved."""
        self._before_solving = before_solving
        self._pm_space.step(dt)
