# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Numbers of the engine's structs, read and written at many addresses at once.

Pymunk 7.3.1 has no functions for these numbers, or calls Python once for each. One array of NumPy
spans the address space, without memory of its own; an index counts words of 8 bytes. Structs that
Pymunk declares to cffi tell their places; those of bodies and constraints are in
`include/chipmunk/chipmunk_structs.h` of Munk2D. To be replaced as soon as Pymunk gives access;
`test_memory` fails where a version has its structs otherwise.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from physsim_ros.model.arrays import Floats, Ints
import pymunk
from pymunk._chipmunk_cffi import ffi

# ruff: noqa: SLF001

_WORD = 8
# The first word is the null pointer, which no buffer may begin with.
NUMBERS: Floats = np.frombuffer(ffi.buffer(ffi.cast('char *', _WORD), 2**47 - _WORD), np.float64)
_POINTERS: Ints = NUMBERS.view(np.int64)

# Places in `cpBody`, in words: `m_inv`, `i_inv`, `v`, `w`, `v_bias` and `w_bias`, `arbiterList`,
# `sleeping.idleTime`.
INVERSE_MASS, INVERSE_MOMENT, VELOCITY, SPIN, PUSH, ARBITERS, IDLE_TIME = 3, 5, 10, 15, 24, 29, 33
# Place in `cpShape` of `hashid`, by which the engine numbers the shapes of a space.
SHAPE_NUMBER = 23
# Places of the accumulated impulses in constraints, and their count.
ACCUMULATED: dict[type[pymunk.Constraint], tuple[int, int]] = {
    pymunk.PivotJoint: (25, 2),
    pymunk.PinJoint: (25, 1),
    pymunk.SlideJoint: (26, 1),
    pymunk.GearJoint: (18, 1),
    pymunk.RotaryLimitJoint: (17, 1),
    pymunk.SimpleMotor: (15, 1),
    pymunk.DampedSpring: (30, 1),
}


def index_of(struct: Any) -> int:
    """Return the index of the first word of a struct."""
    return int(ffi.cast('uintptr_t', struct)) // _WORD - 1


def indices_of(bodies: Iterable[pymunk.Body]) -> Ints:
    """Return (k,) int64: the indices of bodies."""
    return np.array([index_of(body._body) for body in bodies], np.int64)


def impulse_places(constraint: pymunk.Constraint) -> range:
    """Return the indices of the accumulated impulses of a constraint [N s, N m s]."""
    place, count = ACCUMULATED[type(constraint)]
    first = index_of(constraint._constraint) + place
    return range(first, first + count)


def follow(pointers: Ints) -> Ints:
    """Return the indices of the structs that pointers point at; -1 is none."""
    return _POINTERS[pointers] // _WORD - 1


def words(places: Ints) -> Ints:
    """Return (k,) int64: integers at some indices."""
    found: Ints = _POINTERS[places]
    return found


def vectors(places: Ints) -> Floats:
    """Return (k, 2) float64: vectors at some indices."""
    found: Floats = NUMBERS[places[:, None] + (0, 1)]
    return found


def integers(structs: Ints, offset: int) -> Ints:
    """Return (k,): integers of 4 bytes in structs, at an offset in bytes."""
    return _POINTERS.view(np.int32)[structs * 2 + offset // 4].astype(np.int64)
