# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Line strips as columns of Arrow: `LineStrip3DBatch` (Rerun 0.41) is a loop in Python."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.arrays import Singles
import pyarrow as pa
import rerun as rr

_VECTOR = pa.list_(pa.field('item', pa.float32(), nullable=False), 3)
_STRIP = pa.list_(pa.field('item', _VECTOR, nullable=False))


class _StripBatch:
    """
    Line strips as an Arrow array.

    :param corners: (c, 3) float32: of all strips [m]
    :param counts: (s,) intp: number of corners of each strip
    """

    def __init__(self, corners: Singles, counts: NDArray[np.intp]) -> None:
        self._corners, self._counts = corners, counts

    def as_arrow_array(self) -> pa.Array:
        """Return a list of corners for each strip."""
        offsets = np.concatenate(([0], np.cumsum(self._counts))).astype(np.int32)
        vectors = pa.FixedSizeListArray.from_arrays(pa.array(self._corners.ravel()), type=_VECTOR)
        return pa.ListArray.from_arrays(pa.array(offsets), vectors, type=_STRIP)


def strip_column(
    corners: Singles, counts: NDArray[np.intp] | int, lengths: Sequence[int]
) -> rr.ComponentColumn:
    """
    Return line strips as a column.

    :param corners: (c, 3) float32: of all strips [m]
    :param counts: (s,) intp: number of corners of each strip; or that of every strip
    :param lengths: number of strips of each row
    """
    each = np.broadcast_to(counts, sum(lengths)).astype(np.intp)
    batch = _StripBatch(corners, each)
    return rr.ComponentColumn(rr.LineStrips3D.descriptor_strips(), batch, lengths=lengths)
