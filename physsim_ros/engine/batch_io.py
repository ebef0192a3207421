# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Batch input and output: bodies and contacts of a Pymunk space as arrays.

Pymunk reads and writes them all at once; attribute by attribute it takes a hundred times as long.
The engine lists its bodies in an order of its own: awake dynamic and kinematic bodies, static
ones, then sleeping ones. A *slot* is a place in that order; `body_table` maps slots to rows.
"""

from __future__ import annotations

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
# Of all spaces: the memory that is written from is numpy's, which the engine may neither grow nor
# free.
_WRITTEN = batch.Buffer()


class BatchIO:
    """
    Reads and writes the bodies and contacts of a space as arrays.

    :param space: of the engine
    """

    def __init__(self, space: pymunk.Space) -> None:
        self._space = space
        self._buffer = _new_buffer()

    def read_states(self) -> tuple[bytes, Floats]:
        """
        Return ids and states of all bodies, by slot.

        :return: the ids as the bytes of (m,) uint64, which are compared at once; and (m, 6)
            float64: x, y [m], yaw [rad], velocity [m/s], spin [rad/s], a view that the next
            reading overwrites
        """
        self._buffer.clear()
        batch.get_space_bodies(self._space, _ID_AND_STATE, self._buffer)
        states = np.frombuffer(self._buffer.float_buf(), dtype=np.float64)
        return self._buffer.int_buf()[:], states.reshape(-1, 6)

    def write_states(self, states: Floats) -> None:
        """
        Set the states of all bodies, (m, 6) float64 by slot.

        Nothing may sleep: Pymunk 7.3 wakes a sleeping body as it writes it, which changes the
        slots of those behind it.
        """
        _WRITTEN.set_float_buf(np.ascontiguousarray(states))
        batch.set_space_bodies(self._space, _STATE, _WRITTEN)

    def read_contacts(self, fields: batch.ArbiterFields) -> tuple[Ids, Floats]:
        """
        Return fields of all pairs of shapes that touched in the last step.

        Sleeping pairs are not among them. Both arrays are views that the next reading overwrites.

        :return: the fields that are ids or counts, and those that are numbers, pair after pair
        """
        self._buffer.clear()
        batch.get_space_arbiters(self._space, fields, self._buffer)
        ints = np.frombuffer(self._buffer.int_buf(), dtype=np.uint64)
        return ints, np.frombuffer(self._buffer.float_buf(), dtype=np.float64)


def _new_buffer() -> batch.Buffer:
    """Return a buffer that frees its arrays; `Buffer` of Pymunk 7.3 never does."""
    buffer = batch.Buffer()
    free_floats, free_ints = lib.pmFloatArrayFree, lib.pmIntArrayFree
    buffer._float_arr = ffi.gc(buffer._float_arr, free_floats)  # noqa: SLF001
    buffer._int_arr = ffi.gc(buffer._int_arr, free_ints)  # noqa: SLF001
    return buffer
