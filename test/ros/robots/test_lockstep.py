# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A controller in another process acts at the same simulation time, however long it thinks."""

from __future__ import annotations

from typing import Any

import pytest

from ...outside import Outside


@pytest.mark.slow
def test_a_slow_and_a_fast_controller_drive_the_same_way(outside: Outside) -> None:
    runs: list[dict[str, Any]] = []
    for longest in (0.0, 0.1):
        with outside.start_world(world_file='boxes', speed=0.0, lockstep=30.0) as world:
            world.wait_for('ready')
            runs.append(outside.run_program('steer', longest))
            world.interrupt()
    fast, slow = runs
    assert len(fast['scans']) == pytest.approx(15, abs=1)
    assert fast['scans'] == slow['scans']
    # Frames of the first moments may be lost, until both ends have met; those that came are equal.
    poses = {stamp: (x, y) for stamp, x, y in slow['poses']}
    common = [(x, y) == poses[stamp] for stamp, x, y in fast['poses'] if stamp in poses]
    assert len(common) > 150
    assert all(common)
    assert fast['poses'][-1][1:] != pytest.approx([-1.0, 0.0], abs=0.1)
