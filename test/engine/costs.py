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


def growth(begin: Callable[[int], Callable[[], object]], part: int) -> float:
    """
    Return the CPU time of a whole by that of a part, each the lesser of two measurements.

    :param begin: makes an amount ready, and returns the call that is measured
    """

    def cost(amount: int) -> float:
        took = []
        for _ in range(2):
            act = begin(amount)
            began = time.thread_time()
            act()
            took.append(time.thread_time() - began)
        return min(took)

    return cost(TIMES * part) / max(cost(part), LEAST)
