# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Law 36: of a row of elastic bodies as many leave as came.

Where they have a restitution of e, each impact hands on (1 + e)/2 of the velocity.
"""

import itertools

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import Spawn
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.simulation import Simulation
import pytest

from .scenes import NOWHERE
from ..slow import slow

HALF = 0.1
COUNT = 5
DISC, BOX = Disc(radius=HALF), Box(width=2 * HALF, height=2 * HALF)
ROWS = {
    'discs': (DISC,) * COUNT,
    'boxes': (BOX,) * COUNT,
    'upright boxes': (Box(width=2 * HALF, height=3 * HALF),) * COUNT,
    'mixed': (BOX, DISC, BOX, DISC, BOX),
}
# How far the struck ones fly [m]. With 0.024 and 1 / 30 some arrive at the end of a step, where
# rounding tells whether they touch.
FLIGHTS = (0.02, 0.024, 0.0273, 1 / 30, 0.036)


def row(kind, *, struck, gap, flight, speed, rate, elasticity=1.0):
    """Make a world in which some bodies of a row, of 1 kg each, fly at the others."""
    sim = Simulation(physics_rate=rate, settings=WorldSettings(gravity=NOWHERE))
    for number, shape in enumerate(ROWS[kind]):
        flies = number < struck
        x = number * (2 * HALF + gap) - (flight if flies else 0.0)
        velocity = (speed if flies else 0.0), 0.0
        properties = Properties(elasticity=elasticity, friction=0.0, mass=1.0, velocity=velocity)
        sim.perform(
            Spawn(name=f'row/{number}', shape=shape, pose=(x, 0.0, 0.0), properties=properties)
        )
    return sim


@pytest.mark.parametrize('kind', ROWS)
@pytest.mark.parametrize('gap', [0.0, 0.001], ids=['touching', '1 mm apart'])
@pytest.mark.parametrize('rate', [240.0, slow(480.0)])
@pytest.mark.parametrize('struck', [1, 2, 3])
def test_as_many_leave_a_row_as_came(report, struck, rate, gap, kind):
    for speed, flight in itertools.product((1.0, 2.0, 5.0), FLIGHTS):
        sim = row(kind, struck=struck, gap=gap, flight=flight, speed=speed, rate=rate)

        sim.world.step(round(0.3 * rate))

        speeds = sim.world.snapshot().twists[:, 0] / speed
        for number, each in enumerate(speeds):
            exact = float(number >= COUNT - struck)
            report.check(36, f'row of 5 {kind} at {rate:g} Hz, speed', each, exact, 0.02, 'v')


@pytest.mark.parametrize('elasticity', [0.76, 0.9])
@pytest.mark.parametrize('gap', [0.0, 0.001], ids=['touching', '1 mm apart'])
@pytest.mark.parametrize('speed', [1.0, 5.0])
def test_each_impact_along_a_row_hands_on_the_same_share(report, speed, gap, elasticity):
    sim = row('discs', struck=1, gap=gap, flight=0.0273, speed=speed, rate=240.0,
              elasticity=elasticity)  # fmt: skip

    sim.world.step(72)

    exact = ((1.0 + elasticity) / 2.0) ** (COUNT - 1)
    last = sim.world.snapshot().twists[-1, 0] / speed
    report.check(36, f'row of 5 discs, e = {elasticity}, last one', last, exact, 1e-4, 'v')
