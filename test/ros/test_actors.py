# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Actors over ROS: they come and change by markers, and go back with time."""

from __future__ import annotations

from physsim_ros.testing import disc, PhysSim
import pytest

PATH = {'kind': 'path', 'points': [[0, 0], [4, 0]], 'speed': 1.0}


def test_a_marker_makes_an_actor_and_another_one_changes_it(physsim: PhysSim) -> None:
    physsim.spawn(disc('cart/0', diameter=0.4, kinematic=True, actor=PATH))
    physsim.run(1.0)
    assert physsim.pose('cart/0').x == pytest.approx(1.0, abs=1e-6)
    back = {**PATH, 'points': [[1, 0], [1, 3]]}
    physsim.spawn(disc('cart/0', diameter=0.4, at=(1.0, 0.0), actor=back))
    physsim.run(1.0)
    cart = physsim.pose('cart/0')
    assert (cart.x, cart.y) == pytest.approx((1.0, 1.0), abs=1e-6)


def test_an_actor_goes_back_with_time_and_comes_again_to_the_bit(physsim: PhysSim) -> None:
    for number, kind in enumerate(('orca', 'social_force')):
        walks = {'kind': kind, 'points': [[2 - 4 * number, 0.1]]}
        at = (4 * number - 2, 0.0)
        physsim.spawn(disc(f'person/{number}', diameter=0.4, at=at, kinematic=True, actor=walks))
    physsim.run(3.0)
    before = physsim.digest()
    physsim.seek(1.0)
    physsim.seek(3.0)
    assert physsim.digest() == before
