# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Parts of the core cost what the amount of their input says, and not its square."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from ..costs import growth

# Trees and sorting make it 4.6; the square, beside what each pair costs anyhow, 8.5.
MOST = 6.5


@pytest.mark.cost
def test_pairs_that_meet_in_one_round_are_joined_at_a_cost_by_their_count(parts):
    _, lib = parts

    def pairs(count: int) -> Callable[[], object]:
        return lambda: lib.call_join_impacts(count)

    assert lib.call_join_impacts(100) == 200
    assert growth(pairs, 4000, MOST) < MOST
