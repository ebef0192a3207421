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

"""A blow runs through bodies in touch as through stiff ones, one contact after the other."""

import numpy as np
from physsim_ros.engine.stages.impact_propagation import MOST
from physsim_ros.model.requests import Delete
from physsim_ros.model.shapes import Box, Disc
import pytest

from ...laws.scenes import energy, simulation, spawn, steps

SPEED = 2.0
RADIUS = 0.1


def row(sim, count, struck, *, apart=0.0, shape=None, y=0.0, **properties):
    """Spawn a row in which some fly at the others, which rest in touch."""
    for number in range(count):
        flies = number < struck
        # In a step they go 8 mm: these are still on their way for three.
        x = number * (2 * RADIUS + apart) - (0.03 if flies else 0.0)
        said = {'elasticity': 1.0, 'friction': 0.0} | properties
        said['velocity'] = (SPEED if flies else 0.0, 0.0)
        spawn(sim, f'row{y:g}/{number}', shape or Disc(radius=RADIUS), (x, y, 0.0), **said)


def after(sim, count=60):
    *_, last = steps(sim, count)
    return last


@pytest.mark.parametrize('shape', [Disc(radius=RADIUS), Box(width=2 * RADIUS, height=0.3)])
@pytest.mark.parametrize('struck', [1, 2, 3, 4])
@pytest.mark.parametrize('apart', [0.0, 0.0003])
def test_as_many_leave_as_came(shape, struck, apart):
    sim = simulation(gravity=(0.0, 0.0))
    row(sim, 5, struck, shape=shape, apart=apart)
    speeds = after(sim).twists[:, 0] / SPEED
    np.testing.assert_allclose(speeds, np.arange(5) >= 5 - struck, atol=0.02)


@pytest.mark.parametrize('mass', [0.3, 1.0, 4.0])
def test_a_blow_by_another_mass_keeps_momentum_and_energy(mass):
    sim = simulation(gravity=(0.0, 0.0))
    row(sim, 4, 0)
    properties = {'elasticity': 1.0, 'friction': 0.0, 'velocity': (SPEED, 0.0), 'mass': mass}
    spawn(sim, 'striker/0', Disc(radius=RADIUS), (-2 * RADIUS - 0.03, 0.0, 0.0), **properties)
    before = sim.world.snapshot()
    masses = before.scene.inertia[:, 0]
    last = after(sim)
    assert masses @ last.twists[:, 0] == pytest.approx(masses @ before.twists[:, 0], rel=1e-9)
    assert energy(last) == pytest.approx(energy(before), rel=0.02)
    assert (np.diff(last.poses[:4, 0]) > 2 * RADIUS - 0.006).all()


def test_what_is_not_elastic_takes_a_blow_together():
    sim = simulation(gravity=(0.0, 0.0))
    row(sim, 4, 1, elasticity=0.0)
    np.testing.assert_allclose(after(sim).twists[:, 0], SPEED / 4, atol=0.02)


def test_what_presses_does_not_wait():
    sim = simulation()
    for number in range(4):
        spawn(
            sim,
            f'stack/{number}',
            Box(width=0.4, height=0.2),
            (0.0, 0.1 + 0.2 * number, 0.0),
            elasticity=0.9,
        )
    spawn(sim, 'ground/0', Box(width=9.0, height=1.0), (0.0, -0.5, 0.0), anchored=True)
    list(steps(sim, 480))
    spawn(sim, 'ball/0', Disc(radius=0.1), (0.0, 1.2, 0.0), elasticity=0.9, velocity=(0.0, -3.0))
    for each in steps(sim, 60):
        # Boxes of a stack never come into each other by more than a contact has always had.
        assert (np.diff(each.poses[:4, 1]) > 0.2 - 0.02).all()


def test_a_pile_that_is_shaken_is_not_looked_at():
    sim = simulation(gravity=(0.0, 0.0))
    rows = MOST // 5 + 2
    for number in range(rows):
        row(sim, 5, 3, y=float(number))
    before = sim.world.snapshot()
    speeds = after(sim).twists[:, 0].reshape(rows, 5)
    # Each row takes the blow alike, and momentum stays.
    np.testing.assert_allclose(speeds, np.broadcast_to(speeds[0], speeds.shape), atol=1e-9)
    assert speeds[0].sum() == pytest.approx(before.twists[:5, 0].sum(), rel=1e-9)


def test_a_body_that_goes_while_it_is_struck_is_let_go():
    sim = simulation(gravity=(0.0, 0.0))
    row(sim, 5, 3)
    list(steps(sim, 4))
    sim.world.apply(Delete(name='row0/3'))
    left = sim.world.snapshot().twists[:, 0].sum()
    assert after(sim).twists[:, 0].sum() == pytest.approx(left, rel=1e-9)
