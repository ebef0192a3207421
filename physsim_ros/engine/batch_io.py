# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Batch input and output: bodies and contacts of a Pymunk space as arrays.

Pymunk reads and writes them all at once; attribute by attribute it takes a hundred times as long.
The engine lists its bodies in an order of its own: awake dynamic and kinematic bodies, static
ones, then sleeping ones. A *slot* is a place in that order; `body_table` maps slots to rows.
"""

from __future__ import annotations

from collections.abc import Callable
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
_ID_AND_STATE = (batch.BodyFields.BODY_ID | _STATE).value
# Functions of Pymunk that the engine calls for each body, and for each pair of touching shapes.
_READ_BODY = ffi.addressof(lib, 'pmSpaceBodyGetIteratorFuncBatched')
_READ_ARBITER = ffi.addressof(lib, 'pmSpaceArbiterIteratorFuncBatched')
# Shared by all spaces: its memory is NumPy's, which the engine may neither grow nor free.
_WRITTEN = batch.Buffer()


class _Numbers:
    """
    Memory that Pymunk writes numbers to, freed with this; `batch.Buffer` of Pymunk 7.3 leaks.

    :param memory: `pmFloatArray` or `pmIntArray`
    :param free: frees it
    :param kind: of the numbers, of 8 bytes each
    """

    def __init__(self, memory: Any, free: Any, kind: type[np.float64 | np.uint64]) -> None:
        self.memory = ffi.gc(memory, free)
        self._kind = kind
        # The numbers of the last reading, and their address.
        self._array: NDArray[Any] = np.empty(0, kind)
        self._place: Any = None

    def array(self) -> NDArray[Any]:
        """Return what was written last, a view that the next reading overwrites."""
        memory = self.memory
        if memory.num != len(self._array) or memory.arr != self._place:
            numbers = ffi.buffer(memory.arr, memory.num * self._array.itemsize)
            self._array, self._place = np.frombuffer(numbers, self._kind), memory.arr
        return self._array


class _Reading:
    """
    Fields of all bodies or of all contacts, in memory that is used from reading to reading.

    `batch.get_space_bodies` and `get_space_arbiters` of Pymunk make a request and views anew each
    time, which takes three times as long for a few bodies.

    :param each: function of Chipmunk that iterates over bodies or contacts
    :param function: function of Pymunk that reads the fields of one
    """

    def __init__(self, each: Callable[..., None], function: Any) -> None:
        self._each = each
        self._function = function
        self._ints = _Numbers(lib.pmIntArrayNew(0), lib.pmIntArrayFree, np.uint64)
        self._floats = _Numbers(lib.pmFloatArrayNew(0), lib.pmFloatArrayFree, np.float64)
        self._request = ffi.new('pmBatchedData *')
        self._request.intArray = self._ints.memory
        self._request.floatArray = self._floats.memory

    def read(self, pm_space: pymunk.Space, fields: int) -> tuple[Ids, Floats]:
        """Return the fields that are ids or counts, and those that are numbers."""
        self._ints.memory.num = self._floats.memory.num = 0
        self._request.fields = fields
        self._each(pm_space._space, self._function, self._request)  # noqa: SLF001
        return self._ints.array(), self._floats.array()


class BatchIO:
    """
    Reads and writes the bodies and contacts of a space as arrays.

    :param pm_space: of the engine
    """

    def __init__(self, pm_space: pymunk.Space) -> None:
        self._pm_space = pm_space
        self._bodies = _Reading(lib.cpSpaceEachBody, _READ_BODY)
        self._contacts = _Reading(lib.cpSpaceEachCachedArbiter, _READ_ARBITER)

    def read_states(self) -> tuple[bytes, Floats]:
        """
        Return ids and states of all bodies, by slot.

        :return: the ids as the bytes of (m,) uint64, which are compared at once; and (m, 6)
            float64: x, y [m], yaw [rad], velocity [m/s], spin [rad/s], a view that the next
            reading overwrites
        """
        ids, states = self._bodies.read(self._pm_space, _ID_AND_STATE)
        return ids.tobytes(), states.reshape(-1, 6)

    def read_contacts(self, fields: batch.ArbiterFields) -> tuple[Ids, Floats]:
        """
        Return fields of all pairs of shapes that touched in the last step.

        Sleeping pairs are not among them. Both arrays are views that the next reading overwrites.

        :return: the fields that are ids or counts, and those that are numbers, pair after pair
        """
        return self._contacts.read(self._pm_space, fields.value)

    def write_states(self, states: Floats) -> None:
        """
        Set the states of all bodies, (m, 6) float64 by slot.

        Nothing may sleep: Pymunk 7.3 wakes a sleeping body as it writes it, which changes the
        slots of those behind it.
        """
        _WRITTEN.set_float_buf(np.ascontiguousarray(states))
        batch.set_space_bodies(self._pm_space, _STATE, _WRITTEN)
