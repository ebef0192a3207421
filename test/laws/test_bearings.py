# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 73: torsion springs, and the friction of bearings and slides."""

import math

import numpy as np
from physsim_ros.model.shapes import Box, Disc
import pytest

from .scenes import DT, G, join, run, simulation, spawn, steps
from .test_machines import crossings

NEUTRAL = 0.5


def torsion_pendulum(**said):
    """Return a simulation of a disc of 1 kg m² that starts half a radian below its rest."""
    sim = simulation(gravity=(0.0, 0.0))
    spawn(sim, 'disc/0', Disc(radius=0.5), mass=8.0)
    join(sim, 'axle/0', 'axle', [(0.0, 0.0)], a='disc/0', b='world', rest_angle=NEUTRAL, **said)
    return sim


@pytest.mark.parametrize('stiffness', [1.0, 40.0, 400.0])
def test_a_torsion_pendulum_has_its_period_and_keeps_its_swing(report, stiffness):
    sim, exact = torsion_pendulum(stiffness=stiffness), math.tau / math.sqrt(stiffness)
    seen = list(steps(sim, round(6.3 * exact / DT)))
    times, angles = zip(*((now.step * DT, now.poses[0, 2] - NEUTRAL) for now in seen), strict=True)
    period = np.diff(crossings(times, angles)).mean()
    report.check(73, 'torsion pendulum, period', period, exact, 1e-4, 's', relative=True)
    energies = [now.kinetic_energy + now.elastic_energy for now in seen]
    whole = stiffness * NEUTRAL**2 / 2.0
    off = np.abs(np.subtract(energies, whole)).max() / whole
    # Its velocity is half a sub-step of the phase behind its angle.
    behind = math.sqrt(stiffness) * DT / 8.0
    within = 1e-4 + behind + behind**2
    report.check(73, 'torsion pendulum, share of its energy', off, 0.0, within, '1')
    swing = round(exact / DT)
    lost = 1.0 - np.mean(energies[-swing:]) / np.mean(energies[:swing])
    report.check(73, 'torsion pendulum, energy lost in five swings', lost, 0.0, 1e-4, '1')


@pytest.mark.parametrize(('stiffness', 'damping'), [(40.0, 0.4), (40.0, 4.0), (4.0, 4.0)])
def test_a_damped_torsion_pendulum_decays(report, stiffness, damping):
    sim = torsion_pendulum(stiffness=stiffness, damping=damping)
    rate = damping / 2.0
    turn = np.emath.sqrt(stiffness - rate**2)
    for now in steps(sim, 1200):
        time = now.step * DT
        # Where it is critically damped, sin(w t) / w is t.
        sine = np.sin(turn * time) / turn if turn else time
        way = np.real(np.exp(-rate * time) * (np.cos(turn * time) + rate * sine))
        # Half a sub-step of the greatest speed.
        within = 2e-3 * NEUTRAL * math.sqrt(stiffness)
        angle = now.poses[0, 2]
        report.check(73, 'damped torsion pendulum', angle, NEUTRAL * (1 - way), within, 'rad')


def test_a_viscous_bearing_slows_a_wheel(report):
    sim = simulation(gravity=(0.0, 0.0))
    spawn(sim, 'disc/0', Disc(radius=0.5), mass=8.0, spin=3.0)
    join(sim, 'axle/0', 'axle', [(0.0, 0.0)], a='disc/0', b='world', damping=0.5)
    spin = run(sim, 2.0).twists[0, 2]
    report.check(73, 'viscous bearing, spin', spin, 3.0 * math.exp(-1.0), 1e-3, 'rad/s')


def test_a_lamp_hangs_where_its_torsion_spring_bears_it(report):
    # k (angle - rest) = -m g x, with the spring between two bodies that move.
    sim = simulation()
    spawn(sim, 'post/0', Box(width=0.2, height=2.0), (0.0, 1.0, 0.0), mass=5.0)
    join(sim, 'pin/0', 'pin', [(0.0, 0.0)], a='post/0', b='world')
    spawn(sim, 'lamp/0', Box(width=1.0, height=0.1), (0.5, 2.0, 0.0), mass=2.0)
    said = {'stiffness': 60.0, 'damping': 30.0, 'rest_angle': 0.2}
    join(sim, 'axle/0', 'axle', [(0.0, 2.0)], a='lamp/0', b='post/0', **said)
    angle = run(sim, 10.0).poses[1, 2]
    torque = 60.0 * (angle - 0.2)
    report.check(73, 'lamp, torque', torque, -2.0 * G * 0.5 * math.cos(angle), 1e-4, 'N m')


def test_the_friction_of_a_bearing_stops_a_wheel(report):
    sim = simulation(gravity=(0.0, 0.0))
    spawn(sim, 'disc/0', Disc(radius=0.5), mass=8.0, spin=3.0)
    join(sim, 'axle/0', 'axle', [(0.0, 0.0)], a='disc/0', b='world', friction=1.5)
    spins = [now.twists[0, 2] for now in steps(sim, 720)]
    report.check(73, 'friction of a bearing, spin after 1 s', spins[239], 1.5, 1e-9, 'rad/s')
    report.check(73, 'friction of a bearing, spin at rest', spins[-1], 0.0, 1e-12, 'rad/s')
    turned = sim.world.snapshot().poses[0, 2]
    report.check(73, 'friction of a bearing, turn', turned, 3.0, 0.01, 'rad')


@pytest.mark.parametrize(('friction', 'moves'), [(0.9, True), (1.1, False)])
def test_atwoods_machine_starts_where_a_weight_overcomes_its_bearing(report, friction, moves):
    radius, heavy, light, wheel = 0.2, 2.5, 1.5, 4.0
    most = (heavy - light) * G * radius
    sim = simulation()
    spawn(sim, 'wheel/0', Disc(radius=radius), (0.0, 3.0, 0.0), mass=wheel)
    said = {'friction': friction * most}
    join(sim, 'axle/0', 'axle', [(0.0, 3.0)], a='wheel/0', b='world', **said)
    for side, mass in ((-1.0, heavy), (1.0, light)):
        pose = (side * radius, 1.5, 0.0)
        spawn(sim, f'box/{2 * mass:g}', Box(width=0.2, height=0.2), pose, mass=mass)
    points = [(-radius, 1.6), (0.0, 3.0), (radius, 1.6)]
    join(sim, 'rope/0', 'rope', points, a='box/5', b='box/3', over=('wheel/0',))
    # As it starts, the half-step lead of its free fall is a sub-step late.
    early, late = (-run(sim, 0.5).twists[1, 1] for _ in range(2))
    pull = (1.0 - friction) * most / radius if moves else 0.0
    right = pull / (heavy + light + wheel / 2.0)
    name = "Atwood's machine with a bearing, acceleration"
    report.check(73, name, (late - early) / 0.5, right, 1e-6, 'm/s²')


def test_the_friction_of_a_slide_holds_a_carriage_or_slows_it(report):
    sim = simulation()
    for number, friction in enumerate((14.0, 10.0)):
        y = 2.0 * number
        spawn(sim, f'box/{number}', Box(width=0.4, height=0.2), (0.0, y, 0.0), mass=2.0)
        # Down an incline of 1 : 1, along which the weight pulls with 13.9 N.
        said = {'a': f'box/{number}', 'b': 'world', 'friction': friction}
        join(sim, f'slider/{number}', 'slider', [(0.0, y), (1.0, y - 1.0)], **said)
    early, late = (np.hypot(*run(sim, 0.5).twists[:, :2].T) for _ in range(2))
    report.check(73, 'friction of a slide that holds, speed', late[0], 0.0, 1e-6, 'm/s')
    right = G / math.sqrt(2.0) - 10.0 / 2.0
    slowed = (late - early)[1] / 0.5
    report.check(73, 'friction of a slide, acceleration', slowed, right, 1e-6, 'm/s²')


@pytest.mark.parametrize(('pull', 'friction'), [(1.5, 0.05), (1.5, 0.0), (1.1, 0.05), (1.0, 0.05)])
def test_a_tackle_of_four_strands_loses_to_its_bearings(report, pull, friction):
    # Wheels turn 4, 3, 2 and 1 times as fast as the load rises by their radius; strands are
    # vertical.
    radius, wheel, load = 0.1, 0.1, 4.0
    sim = simulation()
    spawn(sim, 'load/0', Box(width=1.0, height=0.2), (4 * radius, -0.5, 0.0), mass=load)
    along = [(4 * radius, -0.5), (4 * radius, 0.5)]
    join(sim, 'guide/0', 'slider', along, a='load/0', b='world')
    centers = [(2 * number * radius, (2.0, -0.5)[number % 2]) for number in range(4)]
    for number, center in enumerate(centers):
        spawn(sim, f'wheel/{number}', Disc(radius=radius), (*center, 0.0), mass=wheel)
        said = {'a': f'wheel/{number}', 'b': ('world', 'load/0')[number % 2], 'friction': friction}
        join(sim, f'axle/{number}', 'axle', [center], **said)
    spawn(sim, 'pull/0', Box(width=0.1, height=0.1), (-radius, 0.5, 0.0), mass=pull)
    points = [(-radius, 0.55), *centers, (7 * radius, 2.0)]
    over = tuple(f'wheel/{number}' for number in range(4))
    join(sim, 'rope/0', 'rope', points, a='pull/0', b='world', over=over)
    early, late = (run(sim, 0.3).twists[0, 1] for _ in range(2))
    lifted, drag = load + 2 * wheel, 10.0 * friction / radius
    force = (4.0 * pull - lifted) * G
    force = math.copysign(max(abs(force) - drag, 0.0), force)
    right = force / (lifted + 16.0 * pull + 15.0 * wheel)
    report.check(73, 'tackle of four, acceleration', (late - early) / 0.3, right, 1e-6, 'm/s²')
