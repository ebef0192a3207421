# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The harbour and the planets do what they are for."""

import numpy as np
import pytest

from .film import film

# Third law of Kepler in this world: a turn takes 2π √(r³ / 40).
RADII = {'planet/0': 2.0, 'planet/1': 3.0, 'planet/2': 4.0, 'planet/3': 6.5}


def test_in_the_harbour_what_is_light_floats_upright_and_a_stone_sinks():
    seen = film('harbour', 30.0)

    for name in ('hull/0', 'barge/0'):
        assert np.abs(seen.yaw(name)).max() < 0.15
        assert np.abs(seen.pose(name)[:, 1]).max() < 0.2
    # The crates stay on the barge, which drifts before the wind.
    for crate in ('crate/0', 'crate/1', 'crate/2'):
        moved = seen.pose(crate)[-1, :2] - seen.pose('barge/0')[-1, :2]
        begun = seen.pose(crate)[0, :2] - seen.pose('barge/0')[0, :2]
        assert moved == pytest.approx(begun, abs=0.1)
    assert seen.x('barge/0')[-1] > 1.5
    assert seen.pose('stone/0')[-1, 1] < -4.5
    # Its rope keeps the buoy near.
    assert abs(seen.x('buoy/0')[-1] - 6.0) < 1.5


def test_planets_stay_on_their_ways_and_the_moon_at_its_planet():
    seen = film('planets', 60.0)

    for name, radius in RADII.items():
        way = np.hypot(*seen.pose(name)[:, :2].T)
        assert way == pytest.approx(radius, rel=0.05)
    apart = seen.pose('moon/0')[:, :2] - seen.pose('planet/3')[:, :2]
    assert np.hypot(*apart.T).max() < 0.4
    comet = np.hypot(*seen.pose('comet/0')[:, :2].T)
    assert comet.min() == pytest.approx(1.2, abs=0.1)
    assert comet.max() == pytest.approx(8.0, abs=0.1)
