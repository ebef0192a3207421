# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Water, wind and attraction by markers and parameters."""

from __future__ import annotations

import math

from physsim_ros.testing import box, disc, PhysSim
import pytest
from rclpy.parameter import Parameter


def set_parameters(physsim: PhysSim, **values: object) -> None:
    parameters = [Parameter(name, value=value) for name, value in values.items()]
    results = physsim.node.set_parameters(parameters)
    assert all(result.successful for result in results)


def test_a_marker_fills_a_pool_and_another_one_floats_in_it(physsim: PhysSim) -> None:
    water = {'density': 10.0, 'viscosity': 10.0}
    pool = box('pool/0', size=(10.0, 4.0), at=(0, -2), anchored=True, sensor=True, medium=water)
    physsim.spawn(pool)
    physsim.spawn(box('raft/0', size=(1.0, 0.4), at=(0.0, 0.0), density=2.5))

    physsim.run(10.0)

    # A quarter of its height is under water.
    assert physsim.pose('raft/0').y == pytest.approx(0.1, abs=1e-4)


def test_the_wind_is_a_parameter(physsim: PhysSim) -> None:
    set_parameters(physsim, gravity=[0.0, 0.0], air_viscosity=10.0, wind=[3.0, -1.0])
    physsim.spawn(disc('leaf/0', diameter=0.2, at=(0.0, 0.0), mass=0.1))

    physsim.run(2.0)

    twist = physsim.twist('leaf/0')
    assert (twist.vx, twist.vy) == pytest.approx((3.0, -1.0), abs=1e-6)


def test_charges_attract_each_other_by_a_parameter(physsim: PhysSim) -> None:
    set_parameters(physsim, gravity=[0.0, 0.0], coulomb=1.0)
    physsim.spawn(disc('ion/0', at=(-5.0, 0.0), mass=1.0, charge=2.0))
    physsim.spawn(disc('ion/1', at=(5.0, 0.0), mass=1.0, charge=-2.0))

    physsim.run(1.0)

    # 4 / 10² N on 1 kg.
    assert physsim.pose('ion/0').x + 5.0 == pytest.approx(0.02, rel=0.01)


def test_a_planet_is_back_after_the_period_of_kepler(physsim: PhysSim) -> None:
    set_parameters(physsim, gravity=[0.0, 0.0], gravitation=0.04)
    physsim.spawn(disc('sun/0', diameter=0.1, at=(0.0, 0.0), mass=100.0, anchored=True))
    # The perihelion of an ellipse of eccentricity 0.3 and semi-major axis 1.
    speed = math.sqrt(4.0 * 1.3 / 0.7)
    planet = disc('planet/0', diameter=0.04, at=(0.7, 0.0), mass=1e-3, velocity=[0.0, speed])
    physsim.spawn(planet)

    physsim.run(math.tau / math.sqrt(4.0))

    pose = physsim.pose('planet/0')
    # A frame is 1/60 s, in which it goes 4.5 cm.
    assert (pose.x, pose.y) == pytest.approx((0.7, 0.0), abs=0.03)
