# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""How CPU time grows with the amount of what there is."""

from __future__ import annotations

from collections.abc import Callable
import time

# The whole has four times as much as the part. Its CPU time by that of the part: 4 where work is
# proportional, 16 by the square.
TIMES = 4
MOST = 8.0
# CPU time of the part below which the ratio says nothing [s].
LEAST = 0.005


def growth(begin: Callable[[int], Callable[[], object]], part: int, most: float = MOST) -> float:
    """
    Return the CPU time of a whole by that of a part, which is the lesser of two measurements.

    The whole, which takes the time of the test, is measured once more where it seems to cost more
    than it may.

    :param begin: makes an amount ready, and returns the call that is measured
    :param most: that the ratio may be
    """

    def cost(amount: int) -> float:
        act = begin(amount)
        began = time.thread_time()
        act()
        return time.thread_time() - began

    of_part = max(min(cost(part), cost(part)), LEAST)
    found = cost(TIMES * part) / of_part
    return found if found < most else min(found, cost(TIMES * part) / of_part)
