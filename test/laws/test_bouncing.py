# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Laws 8 and 21: what bounces keeps the energy that its elasticity leaves it."""

import math

import numpy as np
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Disc, Polygon
from physsim_ros.simulation.simulation import Simulation
import pytest

from .scenes import DT, energy, floor, G, NOWHERE, run, simulation, spawn, steps, walls

TRIANGLE = ((0.3, 0.0), (-0.2, 0.25), (-0.2, -0.25))


@pytest.mark.parametrize('shape', [Disc(radius=0.1), Disc(radius=0.5), Box(width=0.4, height=0.4)])
@pytest.mark.parametrize('elasticity', [0.9, 0.5])
def test_a_body_bounces_to_the_square_of_its_elasticity(report, elasticity, shape):
    sim = simulation(elasticity=elasticity)
    floor(sim)
    half = shape.radius if isinstance(shape, Disc) else shape.height / 2
    row = spawn(sim, 'body/0', shape, (0.0, 1.0 + half, 0.0))

    heights = [1.0]
    rising = False
    last = 1.0
    # The time of four bounces: https://en.wikipedia.org/wiki/Bouncing_ball
    time = math.sqrt(2 / G) * (1 + 2 * sum(elasticity**bounce for bounce in range(1, 5)))
    for snapshot in steps(sim, math.ceil(time / DT)):
        height = snapshot.poses[row, 1] - half
        if rising and height < last:
            heights.append(last)
        rising, last = height > last, height

    first = heights[1] / heights[0]
    report.check(8, f'bounce from 1 m, e = {elasticity:g}', first, elasticity**2, 0.02, '–',
                 relative=True)  # fmt: skip
    assert len(heights) >= 4


@pytest.mark.parametrize('elasticity', [1.0, 0.8])
@pytest.mark.parametrize('rate', [120.0, 240.0])
def test_a_ball_loses_the_same_share_of_its_height_in_each_bounce(report, rate, elasticity):
    sim = Simulation(settings=WorldSettings(elasticity=elasticity), physics_rate=rate)
    floor(sim)
    row = spawn(sim, 'ball/0', Disc(radius=0.1), (0.0, 1.1, 0.0))
    heights = np.array([snapshot.poses[row, 1] - 0.1 for snapshot in steps(sim, round(6 * rate))])
    highest = (heights[1:-1] > heights[:-2]) & (heights[1:-1] >= heights[2:])

    # Impacts take place between two steps, and gravity acts on after them.
    shares = heights[1:-1][highest][:6] / elasticity ** (2 * np.arange(1, 7))
    report.check(8, 'six bounces, height by e²', np.abs(shares - 1.0).max(), 0.0, 5e-4, '–')


@pytest.mark.parametrize('shape', [Disc(radius=0.5), Box(width=1.0, height=1.0)])
def test_what_bounces_off_its_like_turns_round_where_their_outlines_meet(report, shape):
    sim = simulation(gravity=NOWHERE, elasticity=1.0, friction=0.0)
    spawn(sim, 'still/0', shape, (3.0, 0.0, 0.0), anchored=True)
    row = spawn(sim, 'flying/0', shape, velocity=(3.0, 0.0))

    place = run(sim, 1.5).poses[row, 0]

    report.check(21, 'bounce at 3 m/s, place 2.5 m later', place, -0.5, 1e-10, 'm')


@pytest.mark.parametrize('speed', [60.0, 120.0])
@pytest.mark.parametrize('side', [1.0, -1.0])
def test_a_fast_ball_keeps_its_energy_above_a_floor_and_below_a_ceiling(report, side, speed):
    """Below a ceiling nothing bounds a loss, as a gain is above a floor."""
    sim = simulation(gravity=(0.0, -side * G), elasticity=1.0, friction=0.0)
    floor(sim)
    spawn(sim, 'ball/0', Disc(radius=0.05), (0.0, 3.0, 0.0), velocity=(0.0, -speed))
    before = sim.world.snapshot()

    share = energy(run(sim, 0.3)) / energy(before) - 1.0

    report.check(21, 'fast elastic ball, energy', share, 0.0, 1e-5, '–')


# Outlines that stand on y = 0.
FLAT = {
    'upright': ((-0.25, 0.0), (0.25, 0.0), (0.25, 1.0), (-0.25, 1.0)),
    'wide': ((-1.0, 0.0), (1.0, 0.0), (1.0, 0.5), (-1.0, 0.5)),
    'trapezium': ((-0.3, 0.0), (0.3, 0.0), (0.15, 0.8), (-0.15, 0.8)),
    'wedge': ((-0.5, 0.0), (0.5, 0.0), (0.5, 0.3), (-0.5, 0.9)),
    'arch': (
        *((-0.5, 0.0), (-0.3, 0.0), (-0.3, 0.6), (0.3, 0.6)),
        *((0.3, 0.0), (0.5, 0.0), (0.5, 0.8), (-0.5, 0.8)),
    ),
}


@pytest.mark.parametrize('below', ['ground', 'body', 'posts'])
@pytest.mark.parametrize('name', FLAT)
@pytest.mark.parametrize('elasticity', [0.0, 0.7])
def test_a_body_that_falls_flat_bounces_flat(report, elasticity, name, below):
    sim = simulation(elasticity=elasticity)
    if below == 'posts':
        for number, side in enumerate((-0.35, 0.35)):
            post = Box(width=0.25, height=1.0)
            spawn(sim, f'post/{number}', post, (side, -0.5, 0.0), anchored=True)
    else:
        floor(sim)
    if below == 'body':
        spawn(sim, 'body/0', Box(width=4.0, height=1.0), (0.0, 0.5, 0.0), mass=1000.0)
        run(sim, 0.5)
    ground = 1.0 if below == 'body' else 0.0
    row = spawn(sim, 'flat/0', Polygon(outline=FLAT[name]), (0.0, ground + 1.0, 0.0))

    poses = np.array([snapshot.poses[row] for snapshot in steps(sim, 480)])

    law, heights = f'falls flat, e = {elasticity:g}', poses[:, 1] - ground
    report.check(8, f'{law}, tilt', abs(poses[:, 2]).max(), 0.0, 1e-4, 'rad')
    report.check(8, f'{law}, way aside', abs(poses[:, 0]).max(), 0.0, 1e-4, 'm')
    if elasticity:
        lowest = int(np.argmin(heights[:120]))
        first = max(heights[lowest:])
        report.check(8, f'{law}, bounce from 1 m', first, elasticity**2, 0.01, '–', relative=True)


@pytest.mark.parametrize('seed', [1, 2])
def test_a_gas_of_polygons_keeps_its_energy(report, seed):
    random = np.random.default_rng(seed)
    sim = simulation(gravity=NOWHERE, elasticity=1.0, friction=0.0)
    walls(sim, -3.0, -3.0, 3.0, 3.0)
    for number in range(25):
        place = (np.array((number % 5, number // 5)) - 2.0) * 1.08
        angles = 2.0 * math.pi * np.arange(number % 4 + 3) / (number % 4 + 3)
        outline = 0.35 * np.column_stack((np.cos(angles), np.sin(angles)))
        shape = Polygon(outline=tuple(map(tuple, outline.tolist())))
        heading = random.uniform(0.0, 2.0 * math.pi)
        velocity = 2.0 * math.cos(heading), 2.0 * math.sin(heading)
        pose = (*place, random.uniform(0.0, 2.0 * math.pi))
        spawn(sim, f'polygon/{number}', shape, pose, velocity=velocity)
    start = sim.world.snapshot()
    ratio = run(sim, 20.0).kinetic_energy / start.kinetic_energy
    # Without the block solver they gain 3 to 6 %.
    report.check(21, '25 polygons, e = 1, 20 s at 2 m/s, energy', ratio, 1.0, 1e-3, '–')


@pytest.mark.parametrize('friction', [0.2, 0.5, 1.5])
@pytest.mark.parametrize('tilt', [0.3, 0.7, 1.1])
def test_an_elastic_stick_with_friction_gains_no_energy(report, tilt, friction):
    sim = simulation(elasticity=1.0, friction=friction)
    floor(sim)
    stick = Box(width=1.0, height=0.1)
    spawn(sim, 'stick/0', stick, (0.0, 1.5, tilt), velocity=(2.0, 0.0))

    there = energy(sim.world.snapshot())
    most = max(energy(now) for now in steps(sim, 1200))

    law = 'elastic stick with friction, 5 s, energy gained'
    report.check(21, law, max(most / there - 1.0, 0.0), 0.0, 2e-3, '–')


@pytest.mark.parametrize('seed', range(8))
def test_a_gas_of_elastic_shapes_with_friction_gains_no_energy(report, seed):
    pick = np.random.default_rng(seed)
    sim = simulation(elasticity=1.0, friction=0.5, gravity=NOWHERE)
    walls(sim, -2.0, -2.0, 2.0, 2.0)
    shapes = (Box(width=0.8, height=0.2), Disc(radius=0.25), Polygon(outline=TRIANGLE))
    for number in range(6):
        place = (-1.3 + 1.3 * (number % 3), -1.0 + 1.6 * (number // 3), pick.uniform(-3.0, 3.0))
        said = {
            'velocity': (pick.uniform(-4.0, 4.0), pick.uniform(-4.0, 4.0)),
            'spin': pick.uniform(-6.0, 6.0),
        }
        spawn(sim, f'shape/{number}', shapes[number % 3], place, **said)

    there = sim.world.snapshot().kinetic_energy
    most = max(now.kinetic_energy for now in steps(sim, 480))

    law = 'six elastic shapes with friction, 2 s, energy gained'
    report.check(21, law, max(most / there - 1.0, 0.0), 0.0, 1e-4, '–')


def test_a_gas_of_discs_keeps_its_energy(report):
    random = np.random.default_rng(1)
    speed, seconds = 5.0, 12
    sim = simulation(gravity=NOWHERE, elasticity=1.0, friction=0.0)
    walls(sim, -5.0, -5.0, 5.0, 5.0)
    for number in range(100):
        place = np.array((number % 10, number // 10)) - 4.5
        angle = random.uniform(0, 2 * math.pi)
        shape = Disc(radius=random.uniform(0.1, 0.3))
        velocity = (speed * math.cos(angle), speed * math.sin(angle))
        spawn(sim, f'disc/{number}', shape, (*place, 0.0), velocity=velocity)
    sim.reports_contacts = True
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
