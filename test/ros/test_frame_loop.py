# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A tick ends in time, however long the slices of its work are."""

from __future__ import annotations

from typing import Any

from physsim_ros.engine.core_world import CoreWorld
from physsim_ros.ros import frame_loop
from physsim_ros.simulation.entries import Origin
from physsim_ros.testing import disc, PhysSim
import pytest

MS = 1_000_000


class Clock:
    """
    A clock that passes only while the core makes steps.

    :ivar cost: duration of a call of the core [ns]
    """

    def __init__(self) -> None:
        self.cost = self.now = 0

    def perf_counter_ns(self) -> int:
        return self.now


@pytest.fixture
def clock(physsim: PhysSim, monkeypatch: pytest.MonkeyPatch) -> Clock:
    """Return the clock of a started world with a body, 2 s old, which goes back to 0.5 s."""
    clock, step = Clock(), CoreWorld.step

    def step_slowly(core: CoreWorld, count: int, **more: Any) -> int:
        clock.now += clock.cost
        return step(core, count, **more)

    physsim.spawn(disc('disc/0', at=(0.0, 5.0)))
    physsim.run(2.0)
    monkeypatch.setattr(CoreWorld, 'step', step_slowly)
    monkeypatch.setattr(frame_loop, 'time', clock)
    monkeypatch.setattr(frame_loop, 'MOST_TICK_NS', 100 * MS)
    monkeypatch.setattr(physsim.node.loop, 'started', True)
    simulation = physsim.node.simulation
    simulation.past.frames.drop_from(0)
    simulation.speed = 0.0
    simulation.requests.submit_seek(500 * MS, Origin('~/seek'))
    return clock


@pytest.mark.parametrize('cost', [9, 30, 51, 99, 400])
def test_a_tick_ends_in_time_or_after_one_slice(physsim: PhysSim, clock: Clock, cost: int) -> None:
    clock.cost = cost * MS
    ticks = []
    while not ticks or physsim.node.simulation.past.cursor.is_working:
        began = clock.now
        physsim.node.tick(0)
        ticks.append(clock.now - began)
    assert len(ticks) > 1
    # Nor does it end while there is time for another slice.
    least = max(1, 100 // cost) * clock.cost
    assert [*{*ticks[:-1]}] == [least]
    assert ticks[-1] <= least
