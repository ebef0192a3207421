# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Numbers of the engine that Pymunk 7.3.1 has no functions for, read and written in its memory.

They are the accumulated impulses from which constraints start their next step (warm starting),
`jAcc` and `jnAcc` in `include/chipmunk/chipmunk_structs.h` of Munk2D, and a body's `v_bias` and
`w_bias`, by which contacts push it out of another. To be replaced as soon as Pymunk gives access;
`test_joint_memory` fails where a version has its structs otherwise.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from physsim_ros.model.arrays import Floats
import pymunk
from pymunk._chipmunk_cffi import ffi

# ruff: noqa: SLF001

# Offset of the accumulated impulse in numbers of 8 bytes, and its count of components.
_ACCUMULATED: dict[type[pymunk.Constraint], tuple[int, int]] = {
    pymunk.PivotJoint: (25, 2),
    pymunk.GrooveJoint: (32, 2),
    pymunk.PinJoint: (25, 1),
    pymunk.SlideJoint: (26, 1),
    pymunk.GearJoint: (18, 1),
    pymunk.RotaryLimitJoint: (17, 1),
    pymunk.SimpleMotor: (15, 1),
    pymunk.DampedSpring: (30, 1),
}
# Offset of `v_bias` and `w_bias` in numbers of 8 bytes.
_PUSH = 24
_PUSHES = slice(_PUSH, _PUSH + 3)


def impulses(constraints: Sequence[pymunk.Constraint]) -> Floats:
    """Return (c, 2) float64: accumulated impulses [N s, N m s]; the second of scalar ones is 0."""
    found = np.zeros((len(constraints), 2))
    for row, constraint in enumerate(constraints):
        at, count = _ACCUMULATED[type(constraint)]
        numbers = ffi.cast('double *', constraint._constraint)
        found[row, :count] = [numbers[at + number] for number in range(count)]
    return found


def set_impulses(constraints: Sequence[pymunk.Constraint], values: Floats) -> None:
    """Set (c, 2) float64: accumulated impulses [N s, N m s]."""
    for constraint, value in zip(constraints, values.tolist(), strict=True):
        at, count = _ACCUMULATED[type(constraint)]
        numbers = ffi.cast('double *', constraint._constraint)
        for number in range(count):
            numbers[at + number] = value[number]


def numbers_of(bodies: Iterable[pymunk.Body]) -> list[Any]:
    """Return pointers to the numbers of bodies, for `take_pushes`."""
    return [ffi.cast('double *', body._body) for body in bodies]


def take_pushes(numbers: Sequence[Any]) -> Floats:
    """
    Return the velocities by which contacts push bodies out, and set them to zero.

    :return: (k, 3) float64 [m/s, rad/s]; the next step would have moved the bodies by these
    """
    pushes = [each[_PUSHES] for each in numbers]
    found = np.array([list(each) for each in pushes]).reshape(-1, 3)
    for row in np.flatnonzero(found.any(axis=1)).tolist():
        each = numbers[row]
        each[_PUSH] = each[_PUSH + 1] = each[_PUSH + 2] = 0.0
    return found
