# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Types of arrays, rows of three numbers, and a reduction that numpy has no single name for."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.errors import Malformed

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]

_NO_ROWS: Floats = np.empty((0, 3))
_NO_ROWS.flags.writeable = False


def no_rows() -> Floats:
    """Return (0, 3) float64, read-only."""
    return _NO_ROWS


def greatest(numbers: Floats) -> float:
    """Return the greatest absolute value; 0 for an empty array, NaN if any is NaN."""
    return float(np.abs(numbers).max(initial=0.0))


def checked_rows(values: Any, count: int, name: str) -> Floats:
    """
    Return a read-only copy of as many rows of three finite numbers, or none.

    :param name: of the field, for the refusal
    :raises Malformed: they are something else
    """
    try:
        given = np.asarray(values)
    except ValueError as error:
        # Rows of different lengths.
        raise Malformed(f'each {name} needs 3 numbers', field=name) from error
    if given.ndim and not len(given):
        return _NO_ROWS
    if given.ndim != 2 or given.shape[1] != 3 or given.dtype.kind not in 'fiu':
        raise Malformed(f'each {name} needs 3 numbers', field=name)
    if len(given) != count:
        raise Malformed(f'{name} has {len(given)} entries for {count} bodies', field=name)
    rows = np.array(given, dtype=np.float64)
    if not np.isfinite(rows).all():
        raise Malformed(f'{name} is not finite', field=name)
    rows.flags.writeable = False
    return rows
