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

"""Laws 8 and 21: what bounces keeps the energy that its elasticity leaves it."""

import math

import numpy as np
from physsim_ros.model.shapes import Box, Disc
import pytest

from .scenes import DT, G, NOWHERE, simulation, spawn, steps, turned, walls


@pytest.mark.parametrize('side', [0, 40, 90, 180, 270])
@pytest.mark.parametrize('shape', [Disc(radius=0.1), Disc(radius=0.5), Box(width=0.4, height=0.4)])
@pytest.mark.parametrize('elasticity', [0.9, 0.5])
def test_a_body_bounces_to_the_square_of_its_elasticity(report, elasticity, shape, side):
    angle = math.radians(side)
    up = turned((0.0, 1.0), angle)
    sim = simulation(gravity=tuple(-G * up), elasticity=elasticity)
    spawn(sim, 'floor/0', Box(width=20.0, height=2.0), (*(-up), angle), anchored=True)
    half = shape.radius if isinstance(shape, Disc) else shape.height / 2
    row = spawn(sim, 'body/0', shape, (*((1.0 + half) * up), angle))

    heights = [1.0]
    rising = False
    last = 1.0
    # The time of four bounces: https://en.wikipedia.org/wiki/Bouncing_ball
    time = math.sqrt(2 / G) * (1 + 2 * sum(elasticity**bounce for bounce in range(1, 5)))
    for snapshot in steps(sim, math.ceil(time / DT)):
        height = snapshot.poses[row, :2] @ up - half
        if rising and height < last:
            heights.append(last)
        rising, last = height > last, height

    first = heights[1] / heights[0]
    report.check(8, f'bounce from 1 m, e = {elasticity:g}', first, elasticity**2, 0.02, '–',
                 relative=True)  # fmt: skip
    assert len(heights) >= 4


def _gas(speed, seed):
    """Put 100 discs with random velocities into a closed box without friction and gravity."""
    random = np.random.default_rng(seed)
    sim = simulation(gravity=NOWHERE, elasticity=1.0, friction=0.0)
    walls(sim, -5.0, -5.0, 5.0, 5.0)
    for number in range(100):
        place = np.array((number % 10, number // 10)) - 4.5
        angle = random.uniform(0, 2 * math.pi)
        spawn(
            sim,
            f'disc/{number}',
            Disc(radius=random.uniform(0.1, 0.3)),
            (*place, 0.0),
            velocity=(speed * math.cos(angle), speed * math.sin(angle)),
        )
    return sim


# At five times the speed they bounce as often in a fifth of the time.
@pytest.mark.parametrize(('speed', 'seconds'), [(1.0, 60), (5.0, 12)])
def test_a_gas_of_discs_keeps_its_energy(report, speed, seconds):
    sim = _gas(speed, seed=1)
    sim.watch_contacts(True)
    start = last = sim.world.snapshot()

    bounces = 0
    for _ in range(60 * seconds):
        frame = sim.advance_frame()
        wall = frame.contacts.pairs[:, 1] == -1
        taken = frame.contacts.impulses[wall].sum(axis=0)
        change = np.array(frame.snapshot.momentum) - last.momentum
        off = float(np.abs(change + taken).max())
        report.check(21, 'momentum not given to the walls', off, 0.0, 1e-9, 'kg m/s')
        last = frame.snapshot
        bounces += len(wall)

    assert bounces > 1000, 'they hardly met'
    ratio = last.kinetic_energy / start.kinetic_energy
    law = f'100 discs, e = 1, {seconds} s at {speed:g} m/s, energy'
    report.check(21, law, ratio, 1.0, 0.01, '–')
    assert np.abs(last.centers).max() < 5.0
