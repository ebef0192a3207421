# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Types of arrays, read-only ones, and a reduction that numpy has no single name for."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.errors import Malformed

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]


def make_read_only(*arrays: NDArray[Any]) -> None:
    """Have arrays be read-only: others keep them, too."""
    for array in arrays:
        array.flags.writeable = False


_NO_ROWS: Floats = np.empty((0, 3))
make_read_only(_NO_ROWS)


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
        raise Malformed('each {field} needs 3 numbers', field=name) from error
    if given.ndim and not len(given):
        return _NO_ROWS
    if given.ndim != 2 or given.shape[1] != 3 or given.dtype.kind not in 'fiu':
        raise Malformed('each {field} needs 3 numbers', field=name)
    if len(given) != count:
        template = '{field} has {found} entries for {count} bodies'
        raise Malformed(template, field=name, found=len(given), count=count)
    rows = np.array(given, dtype=np.float64)
    if not np.isfinite(rows).all():
        raise Malformed('{field} is not finite', field=name)
    make_read_only(rows)
    return rows
