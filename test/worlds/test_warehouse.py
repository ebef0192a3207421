# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The warehouse: parcels go round the corner and come to rest, and the guard goes round."""

import numpy as np
import pytest

from .film import simulation

pytestmark = pytest.mark.slow


def test_parcels_come_round_the_corner_and_queue_at_the_table():
    sim = simulation('warehouse')
    while sim.step < 40 * sim.physics_rate:
        sim.advance_frame()
    snapshot = sim.world.snapshot()

    rows = [row for row, name in enumerate(snapshot.scene.names) if name.startswith('parcel/')]
    x, y = snapshot.poses[rows, :2].T
    assert len(rows) == 8
    # Between the rails, or on the table behind them.
    assert ((x > 2.2) & (x < 3.8) & (y < 3.2) & (y > -2.0)).all()
    # The first one lies still; a belt would carry it at 0.5 m/s.
    assert np.hypot(*snapshot.twists[rows[0], :2]) < 0.05


def test_the_guard_goes_round_in_a_circle():
    sim = simulation('warehouse')
    row = sim.world.scene.names.index('guard/0')
    center, radius = np.array((4.6, -2.4)), 0.2 / 0.25
    off = []
    while sim.step < 30 * sim.physics_rate:
        sim.advance_frame()
        off.append(np.hypot(*(sim.world.snapshot().poses[row, :2] - center)) - radius)

    # It starts at rest, with an acceleration of 2.5 m/s².
    assert np.abs(off).max() < 0.02
