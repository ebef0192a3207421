# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Laws 1 and 2: free flight is exact, and so is what is reported of it."""

import math

import numpy as np
from physsim_ros.model.requests import Command
from physsim_ros.model.shapes import Box, Compound, Disc, Polygon
import pytest

from .scenes import DT, G, simulation, spawn, steps

SHAPES = {
    'disc': Disc(radius=0.5),
    'box': Box(width=1.0, height=0.3),
    # Their centres of mass are not where their poses are.
    'polygon': Polygon(outline=((0.0, 0.0), (2.0, 0.0), (2.0, 0.5), (0.5, 0.5), (0.5, 2.0))),
    'compound': Compound(element=Disc(radius=0.2), centers=((0.0, 0.0), (1.0, 0.3))),
}
VELOCITIES = [(0.0, 0.0), (3.0, 8.0), (-20.0, 5.0), (0.0, -40.0)]


@pytest.mark.parametrize('velocity', VELOCITIES)
@pytest.mark.parametrize('shape', SHAPES.values(), ids=SHAPES.keys())
def test_a_projectile_follows_the_parabola(report, shape, velocity):
    sim = simulation()
    spawn(sim, 'body/0', shape, (1.0, -2.0, 0.4), velocity=velocity, spin=3.0)
    start = sim.world.snapshot()
    energy = start.kinetic_energy + start.potential_energy

    for snapshot in steps(sim, 480):
        t = snapshot.step * DT
        x, y = start.centers[0] + np.array(velocity) * t + (0.0, -G * t * t / 2)
        off = math.dist(snapshot.centers[0], (x, y))
        vx, vy, spin = snapshot.twists[0]
        report.check(1, 'projectile for 2 s, position', off, 0.0, 1e-9, 'm')
        report.check(1, 'the same, yaw', snapshot.poses[0, 2], 0.4 + 3.0 * t, 1e-9, 'rad')
        off = math.dist((vx, vy), (velocity[0], velocity[1] - G * t))
        report.check(2, 'projectile for 2 s, reported velocity', off, 0.0, 1e-9, 'm/s')
        report.check(2, 'the same, reported spin', spin, 3.0, 1e-9, 'rad/s')
        now = snapshot.kinetic_energy + snapshot.potential_energy
        report.check(2, 'the same, total energy', now, energy, 1e-9, '–', relative=True)


@pytest.mark.parametrize('gravity', [(0.0, 0.0), (3.0, 4.0), (-20.0, 0.1)])
def test_gravity_may_point_anywhere(report, gravity):
    sim = simulation(gravity=gravity)
    spawn(sim, 'body/0', Disc(radius=0.5), velocity=(2.0, -1.0))

    *_, last = steps(sim, 480)

    exact = np.array((2.0, -1.0)) * 2.0 + np.array(gravity) * 2.0
    off = math.dist(last.poses[0, :2], exact)
    report.check(1, 'projectile for 2 s, position', off, 0.0, 1e-9, 'm')


def test_a_constant_force_adds_to_gravity(report):
    sim = simulation(command_timeout=0.0)
    spawn(sim, 'body/0', Box(width=1.0, height=0.5), mass=2.0)
    sim.perform(Command(names=('body/0',), wrenches=((6.0, 0.0, 0.5),)))

    *_, last = steps(sim, 480)

    moment = 2.0 * (1.0 + 0.25) / 12
    off = math.dist(last.poses[0, :2], (3.0 * 2.0, -G * 2.0))
    report.check(1, 'a force of 3 m/s² for 2 s, position', off, 0.0, 1e-9, 'm')
    report.check(1, 'a torque for 2 s, yaw', last.poses[0, 2], 0.5 / moment * 2.0, 1e-9, 'rad')
    report.check(2, 'a torque for 2 s, spin', last.twists[0, 2], 0.5 / moment * 2.0, 1e-9, 'rad/s')
