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

"""What is struck at several places at once leaves with the energy that it came with."""

import math

import numpy as np
from physsim_ros.engine.batch_io import EngineArrays
from physsim_ros.engine.stages.pre_solve_hook import struck
from physsim_ros.engine.stages.simultaneous_impacts import Blows, ITERATIONS, MOST
from physsim_ros.model.shapes import Box, Chain, Disc, Polygon
import pymunk
import pytest

from ...laws.scenes import energy, NOWHERE, run, simulation, spawn, steps, walls

# Frictionless, and of the greatest elasticity.
IDEAL = {'friction': 0.0, 'elasticity': 1.0}
ELL = Polygon(outline=((0, 0), (1, 0), (1, 0.3), (0.3, 0.3), (0.3, 1), (0, 1)))
GEAR = Polygon(
    outline=tuple(
        ((0.6, 0.6, 0.45, 0.45)[k % 4] * math.cos(k * math.pi / 12),
         (0.6, 0.6, 0.45, 0.45)[k % 4] * math.sin(k * math.pi / 12))
        for k in range(24)
    )
)  # fmt: skip


@pytest.mark.parametrize('sides', [40, 160])
@pytest.mark.parametrize('heading', [20.0, 60.0])
def test_a_disc_in_a_ring_of_segments_keeps_its_speed(sides, heading):
    sim = simulation(gravity=NOWHERE)
    around = np.linspace(0.0, 2.0 * math.pi, sides + 1)
    ring = tuple((1.05 * math.sin(angle), -1.05 * math.cos(angle)) for angle in around)
    spawn(sim, 'ring/0', Chain(points=ring, thickness=0.1), anchored=True, **IDEAL)
    velocity = 10.0 * math.cos(math.radians(heading)), 10.0 * math.sin(math.radians(heading))
    row = spawn(sim, 'disc/0', Disc(radius=0.1), (0.0, -0.88, 0.0), velocity=velocity, **IDEAL)

    for snapshot in steps(sim, 480):
        # [m/s]; a tenth of a percent in energy, after a hundred blows.
        assert math.hypot(*snapshot.twists[row, :2]) == pytest.approx(10.0, abs=5e-3)


@pytest.mark.parametrize('crease', [1.0, 5.0, 20.0])
@pytest.mark.parametrize('heading', [-45.0, 0.0, 45.0])
def test_a_disc_leaves_a_valley_as_fast_as_it_came(crease, heading):
    sim = simulation(gravity=NOWHERE)
    crease, heading = math.radians(crease), math.radians(heading)
    for number, side in enumerate((1, -1)):
        slope = side * crease / 2
        x = side * 5.0 * math.cos(slope) + math.sin(slope) / 2
        pose = x, 5.0 * math.sin(crease / 2) - math.cos(slope) / 2, slope
        spawn(sim, f'slab/{number}', Box(width=10.0, height=1.0), pose, anchored=True, **IDEAL)
    start = -1.5 * math.sin(heading), 0.2 + 1.5 * math.cos(heading), 0.0
    velocity = 5.0 * math.sin(heading), -5.0 * math.cos(heading)
    row = spawn(sim, 'disc/0', Disc(radius=0.2), start, velocity=velocity, **IDEAL)

    last = run(sim, 0.6)

    assert math.hypot(*last.twists[row, :2]) == pytest.approx(5.0, rel=5e-4)


@pytest.mark.parametrize('shape', [Box(width=0.6, height=0.6), Box(width=1, height=0.2), ELL])
def test_a_gas_of_angular_bodies_keeps_its_energy(shape):
    sim = simulation(gravity=NOWHERE, **IDEAL)
    walls(sim, -1.0, -1.0, 9.0, 9.0)
    numbers = np.random.default_rng(5)
    for number in range(25):
        pose = 1.6 * (number % 5), 1.6 * (number // 5), numbers.uniform(0.0, 6.0)
        velocity, spin = tuple(numbers.uniform(-4.0, 4.0, 2)), numbers.uniform(-3.0, 3.0)
        spawn(sim, f'body/{number}', shape, pose, velocity=velocity, spin=spin, **IDEAL)
    before = energy(sim.world.snapshot())

    assert energy(run(sim, 8.0)) == pytest.approx(before, rel=1e-3)


def _momentum(snapshot):
    return snapshot.scene.inertia[:, 0] @ snapshot.twists[:, :2]


@pytest.mark.parametrize('shape', [ELL, GEAR], ids=['ells', 'gears'])
def test_angular_bodies_that_meet_keep_momentum_and_energy(shape):
    for number in range(12):
        sim = simulation(gravity=NOWHERE)
        spawn(sim, 'body/0', shape, (0.0, 0.0, 0.5 * number), spin=0.3 * number, **IDEAL)
        spawn(sim, 'body/1', shape, (2.0, 0.2, 0.8 * number), velocity=(-3.0, 0.0), **IDEAL)
        before = sim.world.snapshot()

        after = run(sim, 1.5)

        assert energy(after) == pytest.approx(energy(before), rel=1e-6)
        np.testing.assert_allclose(_momentum(after), _momentum(before), rtol=1e-12, atol=1e-12)


def _iterations(*, walls, more=0):
    """Return how often the engine goes through contacts where a disc hits walls, and after it."""
    space = pymunk.Space()
    blows, seen = Blows(space, EngineArrays(space)), []
    for angle in range(walls):
        side = pymunk.Segment(space.static_body, (-1, 0.1 * angle), (1, -0.1 * angle), 0.1)
        side.elasticity = 1.0
        space.add(side)
    for number in range(more + 1):
        body = pymunk.Body(1.0, 1.0)
        # All but the first lie on a shelf of their own.
        body.position, body.velocity = (5.0 * number, 0.199), (0.0, -1.0 if number == 0 else 0.0)
        shape = pymunk.Circle(body, 0.1)
        shape.elasticity = 1.0
        space.add(body, shape)
        if number:
            side = (5.0 * number - 1, 0.0), (5.0 * number + 1, 0.0)
            space.add(pymunk.Segment(space.static_body, *side, 0.1))
    bell = pymunk.RotaryLimitJoint(space.static_body, pymunk.Body(1.0, 1.0), -1.0, 1.0)
    bell.pre_solve = lambda *_: seen.append(space.iterations)
    space.add(bell)
    space.on_collision(begin=lambda arbiter, *_: blows.begin(struck(arbiter)))
    space.step(1 / 240)
    return seen, space.iterations


def test_one_contact_needs_no_more():
    assert _iterations(walls=1) == ([10], 10)


def test_two_contacts_of_a_body_are_solved_until_they_agree():
    assert _iterations(walls=2) == ([ITERATIONS], 10)


def test_of_a_crowd_no_more_contacts_are_gone_through_than_a_step_allows():
    assert _iterations(walls=2, more=98) == ([MOST // 100], 10)
