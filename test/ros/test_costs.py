# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""No operation on a large world takes the thread of the world for long."""

from __future__ import annotations

import pytest
from tools.bench.full_files import KINDS
from tools.bench.stretches import OPERATIONS, stretches_of

pytestmark = pytest.mark.slow

# Greatest CPU time of a stretch [s], and what a busy machine may take of it.
MOST, MARGIN = 0.3, 2.0


@pytest.mark.parametrize('kind', KINDS)
def test_no_operation_stops_the_clock_for_long(kind: str) -> None:
    stretches = stretches_of(KINDS[kind])
    assert stretches.keys() == OPERATIONS.keys()
    assert max(stretches.values()) < MARGIN * MOST, stretches
