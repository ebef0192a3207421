# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Round numbers for scales and grids."""

import math


def nice_number(value: float) -> float:
    """Return the least number of 1, 2, 5 times a power of ten that is at least a value > 0."""
    power = 10.0 ** math.floor(math.log10(value))
    return next(
        step * power for step in (1.0, 2.0, 5.0, 10.0) if step * power >= value * (1 - 1e-9)
    )
