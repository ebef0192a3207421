# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""An impact goes through touching elastic bodies one contact after the other."""

import math

import numpy as np
from physsim_ros.model.requests import Command, Delete
from physsim_ros.model.shapes import Box, Chain, Disc
import pytest

from ...laws.scenes import energy, NOWHERE, run, simulation, spawn, steps

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


@pytest.mark.parametrize('mass', [0.3, 1.0, 4.0])
def test_an_impact_of_another_mass_keeps_momentum_and_energy(mass):
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


def test_inelastic_bodies_take_an_impact_together():
    sim = simulation(gravity=(0.0, 0.0))
    row(sim, 4, 1, elasticity=0.0)
    np.testing.assert_allclose(after(sim).twists[:, 0], SPEED / 4, atol=0.02)


def test_contacts_under_load_are_not_left_open():
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


def test_a_body_is_deleted_while_an_impact_passes():
    sim = simulation(gravity=(0.0, 0.0))
    row(sim, 5, 3)
    list(steps(sim, 4))
    sim.world.apply(Delete(name='row0/3'))
    left = sim.world.snapshot().twists[:, 0].sum()
    assert after(sim).twists[:, 0].sum() == pytest.approx(left, rel=1e-9)


@pytest.mark.parametrize('count', [1, 2, 5])
def test_a_row_that_hits_a_wall_returns(count):
    sim = simulation(gravity=NOWHERE, elasticity=1.0)
    spawn(sim, 'wall/0', Box(width=1.0, height=2.0), (-1.0, 0.0, 0.0), anchored=True)
    row(sim, count, 0)
    for number in range(count):
        sim.perform(Command(names=(f'row0/{number}',), twists=((-SPEED, 0.0, 0.0),)))
    np.testing.assert_allclose(after(sim, 120).twists[1:, 0], SPEED, rtol=0.02)


@pytest.mark.parametrize('sides', [40, 160])
@pytest.mark.parametrize('heading', [20.0, 60.0])
def test_a_disc_in_a_ring_of_segments_keeps_its_speed(sides, heading):
    sim = simulation(gravity=NOWHERE)
    ideal = {'friction': 0.0, 'elasticity': 1.0}
    around = np.linspace(0.0, 2.0 * math.pi, sides + 1)
    ring = tuple((1.05 * math.sin(angle), -1.05 * math.cos(angle)) for angle in around)
    spawn(sim, 'ring/0', Chain(points=ring, thickness=0.1), anchored=True, **ideal)
    velocity = 10.0 * math.cos(math.radians(heading)), 10.0 * math.sin(math.radians(heading))
    disc = spawn(sim, 'disc/0', Disc(radius=0.1), (0.0, -0.88, 0.0), velocity=velocity, **ideal)

    for snapshot in steps(sim, 480):
        # [m/s]; a tenth of a percent in energy, after a hundred impacts.
        assert math.hypot(*snapshot.twists[disc, :2]) == pytest.approx(10.0, abs=5e-3)


@pytest.mark.parametrize('crease', [1.0, 2.0, 5.0, 20.0])
# Exactly along its axis both sides are hit at one speed; see the head of the stage.
@pytest.mark.parametrize('heading', [-45.0, 1.0, 45.0])
def test_a_disc_leaves_a_valley_as_fast_as_it_came(crease, heading):
    sim = simulation(gravity=NOWHERE)
    ideal = {'friction': 0.0, 'elasticity': 1.0}
    crease, heading = math.radians(crease), math.radians(heading)
    for number, side in enumerate((1, -1)):
        slope = side * crease / 2
        x = side * 5.0 * math.cos(slope) + math.sin(slope) / 2
        pose = x, 5.0 * math.sin(crease / 2) - math.cos(slope) / 2, slope
        spawn(sim, f'slab/{number}', Box(width=10.0, height=1.0), pose, anchored=True, **ideal)
    start = -1.5 * math.sin(heading), 0.2 + 1.5 * math.cos(heading), 0.0
    velocity = 5.0 * math.sin(heading), -5.0 * math.cos(heading)
    disc = spawn(sim, 'disc/0', Disc(radius=0.2), start, velocity=velocity, **ideal)

    last = run(sim, 0.6)

    assert math.hypot(*last.twists[disc, :2]) == pytest.approx(5.0, rel=5e-4)
