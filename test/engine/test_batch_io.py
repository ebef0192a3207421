# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Arrays that are read from a space are freed with the space."""

from __future__ import annotations

import gc

from physsim_ros.engine.batch_io import BatchIO
import pymunk
from pymunk import batch
import pytest

psutil = pytest.importorskip('psutil')

# Discs in one place, of which each touches each, and the bytes of two numbers for each pair.
DISCS = 150
READ = DISCS * (DISCS - 1) // 2 * 16


def test_the_memory_of_what_was_read_is_freed_with_the_space() -> None:
    space = pymunk.Space()
    for _ in range(DISCS):
        body = pymunk.Body(1.0, 1.0)
        space.add(body, pymunk.Circle(body, 1.0))
    space.step(1 / 240)
    fields = batch.ArbiterFields.TOTAL_IMPULSE

    def read(times: int) -> int:
        for _ in range(times):
            assert BatchIO(space).read_contacts(fields)[1].nbytes == READ
        gc.collect()
        return psutil.Process().memory_info().rss

    before = read(10)
    assert read(300) < before + 100 * READ
