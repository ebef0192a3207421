# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Batch input and output: bodies and contacts of a Pymunk space as arrays.

Pymunk reads and writes them all at once; attribute by attribute it takes a hundred times as long.
The engine lists its bodies in an order of its own: awake dynamic and kinematic bodies, static
ones, then sleeping ones. A *slot* is a place in that order; `body_table` maps slots to rows.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Floats
import pymunk
from pymunk import batch
from pymunk._chipmunk_cffi import ffi, lib

Ids = NDArray[np.uint64]

_STATE = batch.BodyFields.POSITION | batch.BodyFields.ANGLE
_STATE |= batch.BodyFields.VELOCITY | batch.BodyFields.ANGULAR_VELOCITY
_ID_AND_STATE = batch.BodyFields.BODY_ID | _STATE
# Called by the engine for each body, for each pair of shapes that touch.
_READ_BODY = ffi.addressof(lib, 'pmSpaceBodyGetIteratorFuncBatched')
_READ_ARBITER = ffi.addressof(lib, 'pmSpaceArbiterIteratorFuncBatched')
# Of all spaces: the memory that is written from is numpy's, which the engine may neither grow nor
# free.
_WRITTEN = batch.Buffer()


class _Numbers:
    """
    Memory that Pymunk writes numbers to, freed with this; `batch.Buffer` of Pymunk 7.3 never is.

    :param memory: `pmFloatArray` or `pmIntArray`
    :param free: frees it
    :param kind: of the numbers, of 8 bytes each
    """

    def __init__(self, memory: Any, free: Any, kind: type[np.float64 | np.uint64]) -> None:
        self.memory = ffi.gc(memory, free)
        self._kind = kind
        # The numbers as of the last reading, and where they lay.
        self._array: NDArray[Any] = np.empty(0, kind)
        self._place: Any = None

    def read(self) -> NDArray[Any]:
        """Return what was written last, a view that the next reading overwrites."""
        memory = self.memory
        if memory.num != len(self._array) or memory.arr != self._place:
            numbers = ffi.buffer(memory.arr, memory.num * self._array.itemsize)
            self._array, self._place = np.frombuffer(numbers, self._kind), memory.arr
        return self._array


class BatchIO:
    """
    Reads and writes the bodies and contacts of a space as arrays.

    What is read stays in one place from reading to reading: `batch.get_space_bodies` and
    `get_space_arbiters` of Pymunk take three times as long for a few bodies.

    :param space: of the engine
    """

    def __init__(self, space: pymunk.Space) -> None:
        self._space = space
        self._engine = space._space  # noqa: SLF001 - Chipmunk's, for its own functions
        self._ints = _Numbers(lib.pmIntArrayNew(0), lib.pmIntArrayFree, np.uint64)
        self._floats = _Numbers(lib.pmFloatArrayNew(0), lib.pmFloatArrayFree, np.float64)
        self._request = ffi.new('pmBatchedData *')
        self._request.intArray = self._ints.memory
        self._request.floatArray = self._floats.memory

    def read_states(self) -> tuple[bytes, Floats]:
        """
        Return ids and states of all bodies, by slot.

        :return: the ids as the bytes of (m,) uint64, which are compared at once; and (m, 6)
            float64: x, y [m], yaw [rad], velocity [m/s], spin [rad/s], a view that the next
            reading overwrites
        """
        self._begin_reading(_ID_AND_STATE)
        lib.cpSpaceEachBody(self._engine, _READ_BODY, self._request)
        return self._ints.read().tobytes(), self._floats.read().reshape(-1, 6)

    def read_contacts(self, fields: batch.ArbiterFields) -> tuple[Ids, Floats]:
        """
        Return fields of all pairs of shapes that touched in the last step.

        Sleeping pairs are not among them. Both arrays are views that the next reading overwrites.

        :return: the fields that are ids or counts, and those that are numbers, pair after pair
        """
        self._begin_reading(fields)
        lib.cpSpaceEachCachedArbiter(self._engine, _READ_ARBITER, self._request)
        return self._ints.read(), self._floats.read()

    def _begin_reading(self, fields: batch.BodyFields | batch.ArbiterFields) -> None:
        self._request.fields = fields.value
        self._ints.memory.num = self._floats.memory.num = 0

    def write_states(self, states: Floats) -> None:
        """
        Set the states of all bodies, (m, 6) float64 by slot.

        Nothing may sleep: Pymunk 7.3 wakes a sleeping body as it writes it, which changes the
        slots of those behind it.
        """
        _WRITTEN.set_float_buf(np.ascontiguousarray(states))
        batch.set_space_bodies(self._space, _STATE, _WRITTEN)
