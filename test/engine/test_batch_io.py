# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

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
