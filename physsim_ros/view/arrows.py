# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Arrows over the bodies: contacts and velocities."""

from __future__ import annotations

from collections.abc import Sequence
import math

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.view import columns
import rerun as rr

# Greatest mean number of arrows in a frame of each kind: of more, fewer frames have arrows.
_BUDGET = 150


def sampling_period(count: int) -> int:
    """Return the period at which arrows are sent [frames], for a number of them."""
    return max(1, math.ceil(count / _BUDGET))


def arrow_columns(
    origins: Floats, vectors: Floats, height: float, lengths: Sequence[int]
) -> list[rr.ComponentColumn]:
    """
    Return arrows in the plane as columns.

    :param origins: (k, 2) float64: of all rows [m]
    :param vectors: (k, 2) float64 [m]
    :param height: z of the arrows [m]
    :param lengths: number of arrows of each row
    """
    places = np.full((len(origins), 3), height, dtype=np.float32)
    places[:, :2] = origins
    ways = np.zeros((len(vectors), 3), dtype=np.float32)
    ways[:, :2] = vectors
    return [
        columns.column(columns.ORIGINS, places, lengths),
        columns.column(columns.VECTORS, ways, lengths),
    ]
