# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Types of arrays, and a reduction that numpy has no single name for."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Singles = NDArray[np.float32]
Ints = NDArray[np.int64]
Flags = NDArray[np.bool_]


def greatest(numbers: Floats) -> float:
    """Return the greatest absolute value; 0 for an empty array, NaN if any is NaN."""
    return float(np.abs(numbers).max(initial=0.0))
