# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 72: masses and charges attract each other by a power of their distance."""

import itertools
import math

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.errors import WorldFull
from physsim_ros.model.requests import ChangeBody, Configure
from physsim_ros.model.shapes import Disc
import pytest

from .scenes import DT, NOWHERE, run, simulation, spawn, steps

# G m of the sun in these worlds [m³/s²].
GM = 4.0


def planet_of(eccentricity, **settings):
    """Return a world with a planet at the perihelion of an ellipse of semi-major axis 1."""
    sim = simulation(gravity=NOWHERE, gravitation=GM / 100.0, **settings)
    spawn(sim, 'sun/0', Disc(radius=0.05), mass=100.0, anchored=True)
    speed = math.sqrt(GM * (1 + eccentricity) / (1 - eccentricity))
    place = (1.0 - eccentricity, 0.0, 0.0)
    spawn(sim, 'planet/0', Disc(radius=0.02), place, mass=1e-3, velocity=(0.0, speed))
    return sim


@pytest.mark.parametrize('eccentricity', [0.0, 0.3, 0.6])
def test_a_planet_goes_around_by_the_laws_of_kepler(report, eccentricity):
    sim = planet_of(eccentricity)
    period = math.tau / math.sqrt(GM)
    sweep = math.sqrt(GM * (1 - eccentricity**2))
    rises, last = [], None
    for snapshot in steps(sim, math.ceil(10.01 * period / DT)):
        (x, y), (vx, vy) = snapshot.poses[1, :2], snapshot.twists[1, :2]
        report.check(72, 'area law, ten turns', (x * vy - y * vx) / sweep, 1.0, 1e-6, '-')
        radius = math.hypot(x, y)
        # Of an ellipse both distances from the foci have the sum of two semi-major axes.
        other = math.hypot(x + 2 * eccentricity, y)
        report.check(72, 'ellipse, ten turns', (radius + other) / 2, 1.0, 1e-3, 'm')
        energy = (vx * vx + vy * vy) / 2 - GM / radius
        report.check(72, 'energy of an orbit', energy / (-GM / 2), 1.0, 1e-3, '-')
        if last is not None and last[1] < 0.0 <= y:
            rises.append((snapshot.step - y / (y - last[1])) * DT)
        last = x, y
    report.check(72, 'period of ten turns', rises[9] / (10 * period), 1.0, 1e-4, '-')


def sun_at(sim, x, y):
    return spawn(sim, 'sun/0', Disc(radius=0.05), (x, y, 0.0), mass=100.0, anchored=True)


@pytest.mark.parametrize(
    'put', [lambda sim, x, y: sim.place('sun/0', x, y), sun_at], ids=['place', 'spawn']
)
def test_a_sun_that_is_put_elsewhere_pulls_at_once_as_one_that_was_there(put):
    sim = planet_of(0.0)
    run(sim, 0.5)
    put(sim, 0.0, 0.3)
    x, y, yaw, vx, vy = *sim.world.snapshot().poses[1], *sim.world.snapshot().twists[1, :2]
    other = simulation(gravity=NOWHERE, gravitation=GM / 100.0)
    sun_at(other, 0.0, 0.3)
    spawn(other, 'planet/0', Disc(radius=0.02), (x, y, yaw), mass=1e-3, velocity=(vx, vy))
    here, there = (run(each, 0.1).poses[1, :2] for each in (sim, other))
    assert math.dist(here, there) < 1e-12


@pytest.mark.parametrize('power', [-1.0, 0.5, 1.0, 2.0, 2.5])
def test_a_circle_has_the_speed_of_its_power(report, power):
    sim = simulation(gravity=NOWHERE, gravitation=1.0, attraction_power=power, softening=0.0)
    spawn(sim, 'sun/0', Disc(radius=0.05), mass=4.0, anchored=True)
    speed = math.sqrt(4.0 / 1.5 ** (power - 1.0))
    spawn(sim, 'planet/0', Disc(radius=0.02), (1.5, 0.0, 0.0), velocity=(0.0, speed))
    for snapshot in steps(sim, 1200):
        radius = math.hypot(*snapshot.poses[1, :2])
        report.check(72, 'circle of a power', radius, 1.5, 1e-4, 'm')


def test_two_stars_go_around_their_common_centre(report):
    sim = simulation(gravity=NOWHERE, gravitation=2.0)
    # Of 3 kg and 1 kg, 1 m apart.
    rate = math.sqrt(2.0 * 4.0)
    spawn(
        sim, 'star/0', Disc(radius=0.1), (-0.25, 0.0, 0.0), mass=3.0, velocity=(0.0, -0.25 * rate)
    )
    spawn(sim, 'star/1', Disc(radius=0.1), (0.75, 0.0, 0.0), mass=1.0, velocity=(0.0, 0.75 * rate))
    for snapshot in steps(sim, 2400):
        center = (3.0 * snapshot.poses[0, :2] + snapshot.poses[1, :2]) / 4.0
        report.check(72, 'centre of two stars', math.hypot(*center), 0.0, 1e-12, 'm')
        apart = math.dist(snapshot.poses[0, :2], snapshot.poses[1, :2])
        report.check(72, 'distance of two stars', apart, 1.0, 1e-4, 'm')


def test_three_bodies_keep_energy_and_momenta(report):
    sim = simulation(gravity=NOWHERE, gravitation=1.0, softening=0.2)
    said = [
        ((0.0, 1.0), (0.6, 0.1), 1.0),
        ((-1.0, 0.0), (-0.2, 0.4), 2.0),
        ((1.0, -0.5), (0.0, -0.6), 1.5),
    ]
    for number, (place, velocity, mass) in enumerate(said):
        spawn(
            sim, f'body/{number}', Disc(radius=1e-3), (*place, 0.0), mass=mass, velocity=velocity
        )
    masses = np.array([mass for *_, mass in said])

    def energy(snapshot):
        pairs = itertools.combinations(range(3), 2)
        places = snapshot.poses[:, :2]
        potential = sum(
            -masses[a] * masses[b] / math.hypot(*(places[a] - places[b]), 0.2) for a, b in pairs
        )
        return snapshot.kinetic_energy + potential

    begun, first = energy(sim.world.snapshot()), masses @ sim.world.snapshot().twists[:, :2]
    for snapshot in steps(sim, 2400):
        report.check(72, 'energy of three bodies', energy(snapshot) / begun, 1.0, 1e-3, '-')
        momentum = masses @ snapshot.twists[:, :2] - first
        report.check(72, 'momentum of three bodies', math.hypot(*momentum), 0.0, 1e-12, 'N s')


def test_a_slingshot_gives_a_probe_up_to_twice_the_speed_of_the_planet(report):
    sim = simulation(gravity=NOWHERE, gravitation=1.0)
    spawn(sim, 'planet/0', Disc(radius=0.01), mass=1e4, velocity=(-10.0, 0.0))
    # In the frame of the planet it comes with 30 m/s and an impact parameter b.
    b, u = 3.0, 30.0
    spawn(sim, 'probe/0', Disc(radius=0.01), (-2000.0, b, 0.0), mass=1e-6, velocity=(20.0, 0.0))
    sim.world.step(240 * 140)
    last = sim.world.snapshot()
    # Rutherford: the deflection is 2 atan(G m / b u²), from afar.
    turn = 2 * math.atan(1e4 / (b * u * u))
    exact = math.hypot(u * math.cos(turn) - 10.0, u * math.sin(turn))
    speed = math.hypot(*last.twists[1, :2])
    report.check(72, 'speed after a slingshot', speed / exact, 1.0, 0.01, '-')
    assert speed > 1.5 * 20.0


@pytest.mark.parametrize(('one', 'other'), [(2.0, 3.0), (-2.0, 3.0), (-2.0, -3.0)])
def test_charges_accelerate_by_the_law_of_coulomb(report, one, other):
    sim = simulation(gravity=NOWHERE, coulomb=5.0, softening=0.0)
    spawn(sim, 'ion/0', Disc(radius=0.1), (0.0, 0.0, 0.3), mass=2.0, charge=one)
    spawn(sim, 'ion/1', Disc(radius=0.1), (4.0, 0.0, 0.0), mass=4.0, charge=other)
    spawn(sim, 'neutral/0', Disc(radius=0.1), (0.0, 2.0, 0.0), mass=4.0)
    sim.world.step(1)
    snapshot = sim.world.snapshot()
    force = 5.0 * one * other / 16.0
    report.check(72, 'charge: left', snapshot.twists[0, 0] / DT, -force / 2.0, 1e-4, 'm/s²')
    report.check(72, 'charge: right', snapshot.twists[1, 0] / DT, force / 4.0, 1e-4, 'm/s²')
    report.check(72, 'no charge', math.hypot(*snapshot.twists[2, :2]), 0.0, 0.0, 'm/s')


def test_softening_bounds_the_force(report):
    sim = simulation(gravity=NOWHERE, gravitation=1.0, softening=0.5)
    spawn(sim, 'sun/0', Disc(radius=0.1), mass=10.0, anchored=True, sensor=False, group=1)
    spawn(sim, 'dust/0', Disc(radius=0.1), (0.2, 0.0, 0.0), mass=1.0, group=1)
    sim.world.step(1)
    exact = -10.0 * 0.2 / (0.2**2 + 0.5**2) ** 1.5
    speed = sim.world.snapshot().twists[1, 0]
    report.check(72, 'softened force', speed / DT / exact, 1.0, 1e-3, '-')


def test_a_clump_that_lies_still_is_pulled_by_what_passes():
    sim = simulation(gravity=NOWHERE, gravitation=1.0, elasticity=0.0)
    for number in range(3):
        spawn(sim, f'clump/{number}', Disc(radius=0.1), (0.2 * number, 0.0, 0.0), mass=1.0)
    run(sim, 3.0)
    spawn(sim, 'star/0', Disc(radius=0.1), (50.0, 0.0, 0.0), mass=1e5, anchored=True)
    assert run(sim, 1.0).poses[0, 0] > 5.0


def test_more_than_five_hundred_do_not_attract_each_other():
    sim = simulation(gravity=NOWHERE, gravitation=1.0)
    for number in range(500):
        spawn(sim, f'star/{number}', Disc(radius=0.1), (float(number), 0.0, 0.0))
    with pytest.raises(WorldFull):
        spawn(sim, 'star/500', Disc(radius=0.1), (0.0, 5.0, 0.0))
    spawn(sim, 'gate/0', Disc(radius=0.1), (0.0, 5.0, 0.0), sensor=True)
    sim.perform(Configure(changes={'gravitation': 0.0}))
    spawn(sim, 'star/500', Disc(radius=0.1), (0.0, 9.0, 0.0))
    with pytest.raises(WorldFull):
        sim.perform(Configure(changes={'gravitation': 1.0}))
    sim.perform(Configure(changes={'coulomb': 1.0}))
    sim.perform(ChangeBody(name='star/500', properties=Properties(charge=1.0)))
