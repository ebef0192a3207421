# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 75: rolling resistance."""

import math

from physsim_ros.model.shapes import Box, Disc
import pytest

from .scenes import floor, G, join, run, simulation, spawn

RADIUS = 0.25


@pytest.mark.parametrize(('coefficient', 'speed'), [(0.01, 0.5), (0.02, 1.0), (0.1, 2.0)])
@pytest.mark.parametrize(('of_floor', 'of_disc'), [(0.0, 1.0), (1.0, 0.5)])
def test_a_disc_rolls_as_far_as_its_energy_takes_it(report, coefficient, speed, of_floor, of_disc):
    sim = simulation(friction=0.8)
    # The greater of the two counts.
    floor(sim, rolling_resistance=of_floor * coefficient)
    said = {'spin': -speed / RADIUS, 'rolling_resistance': of_disc * coefficient}
    said['velocity'] = (speed, 0.0)
    spawn(sim, 'disc/0', Disc(radius=RADIUS), (0.0, RADIUS, 0.0), **said)
    # Of a disc, k² / r² is a half.
    last = run(sim, 1.6 * speed / (coefficient * G))
    right = 1.5 * speed**2 / (2.0 * coefficient * G)
    way = last.poses[1, 0]
    report.check(75, 'disc that rolls to rest, way', way, right, 5e-3, 'm', relative=True)
    report.check(75, 'the same, speed at rest', last.twists[1, 0], 0.0, 1e-6, 'm/s')


@pytest.mark.parametrize('coefficient', [0.02, 0.1])
def test_a_cart_of_light_wheels_rolls_as_far_as_the_formula_says(report, coefficient):
    sim, speed = simulation(friction=0.8), 1.0
    floor(sim)
    velocity = {'velocity': (speed, 0.0), 'group': 1}
    spawn(sim, 'cart/0', Box(width=1.0, height=0.2), (0.0, RADIUS, 0.0), mass=20.0, **velocity)
    for number, x in enumerate((-0.4, 0.4)):
        said = {'spin': -speed / RADIUS, 'rolling_resistance': coefficient, **velocity}
        spawn(sim, f'wheel/{number}', Disc(radius=RADIUS), (x, RADIUS, 0.0), mass=0.01, **said)
        join(sim, f'axle/{number}', 'axle', [(x, RADIUS)], a=f'wheel/{number}', b='cart/0')
    last = run(sim, 1.2 * speed / (coefficient * G))
    right = speed**2 / (2.0 * coefficient * G)
    way = last.poses[1, 0]
    report.check(75, 'cart that rolls to rest, way', way, right, 5e-3, 'm', relative=True)
    report.check(75, 'the same, speed at rest', last.twists[1, 0], 0.0, 1e-6, 'm/s')


@pytest.mark.parametrize('share', [0.95, 1.05])
@pytest.mark.parametrize('cart', [True, False])
def test_what_rolls_stands_on_a_slope_below_its_coefficient(report, share, cart):
    coefficient = 0.1
    angle = math.atan(share * coefficient)
    sim = simulation(friction=0.8)
    floor(sim, angle=angle)
    up = (-math.sin(angle), math.cos(angle))
    wheels = ((-0.4, 0), (0.4, 1)) if cart else ((0.0, 0),)
    for x, number in wheels:
        place = (x * up[1] + RADIUS * up[0], -x * up[0] + RADIUS * up[1])
        said = {'rolling_resistance': coefficient, 'mass': 1.0, 'group': 1}
        spawn(sim, f'wheel/{number}', Disc(radius=RADIUS), (*place, 0.0), **said)
    if cart:
        pose = (RADIUS * up[0], RADIUS * up[1], angle)
        spawn(sim, 'cart/0', Box(width=1.0, height=0.2), pose, mass=8.0, group=1)
        for x, number in wheels:
            place = (x * up[1] + RADIUS * up[0], -x * up[0] + RADIUS * up[1])
            join(sim, f'axle/{number}', 'axle', [place], a=f'wheel/{number}', b='cart/0')
    early, late = run(sim, 1.0).poses[1, :2], run(sim, 1.0).poses[1, :2]
    way = math.dist(early, late)
    mass, moment = (10.0, 1.0) if cart else (1.0, 0.5)
    # From rest at the start, in the second second.
    pull = max(G * (math.sin(angle) - coefficient * math.cos(angle)), 0.0)
    right = 1.5 * pull * mass / (mass + moment)
    report.check(75, 'on a slope, way in a second', way, right, 5e-3, 'm')
