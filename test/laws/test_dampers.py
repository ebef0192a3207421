# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 49: dampers, damped springs and greatest forces of joints obey their formulas."""

import math

import numpy as np
from physsim_ros.model.shapes import Disc
import pytest

from .scenes import DT, G, integrated, join, NOWHERE, run, simulation, spawn, steps


@pytest.mark.parametrize('damping', [1.0, 5.0, 20.0, 100.0, 500.0, 1000.0, 1e5])
@pytest.mark.parametrize('mass', [1.0, 3.0])
def test_a_weight_on_a_damper_sinks_at_its_terminal_speed(report, mass, damping):
    sim = simulation()
    spawn(sim, 'weight/0', Disc(radius=0.1), (0.0, -2.0, 0.0), mass=mass)
    points = [(0.0, -2.0), (0.0, 0.0)]
    said = {'a': 'weight/0', 'b': 'world', 'stiffness': 0.0, 'damping': damping}
    join(sim, 'damper/0', 'spring', points, **said)

    # Ten time constants, so that 5e-5 of the speed is still to come.
    end = run(sim, max(1.0, 10.0 * mass / damping))

    exact = mass * G / damping
    what = 'weight on a damper of 1 to 100,000 N s/m, speed'
    report.check(49, what, -end.twists[0, 1], exact, 1e-3, 'm/s', relative=True)


def relaxation(stiffness, damping, mass, seconds):
    """
    Return the displacement of an overdamped oscillator, released at rest, as a share of the first.

    https://en.wikipedia.org/wiki/Damping#Damping_ratio
    """
    middle = damping / (2 * mass)
    spread = math.sqrt(middle**2 - stiffness / mass)
    slow, fast = middle - spread, middle + spread
    return (fast * math.exp(-slow * seconds) - slow * math.exp(-fast * seconds)) / (fast - slow)


# Stiffness [N/m] and damping [N s/m] at 1 kg: time constants of 0.1 to 1 s.
@pytest.mark.parametrize(
    ('stiffness', 'damping'), [(20.0, 10.0), (100.0, 100.0), (1000.0, 500.0), (5000.0, 1000.0)]
)
def test_an_overdamped_spring_relaxes_as_its_exact_solution(report, stiffness, damping):
    sim = simulation(gravity=NOWHERE)
    spawn(sim, 'mass/0', Disc(radius=0.1), (3.0, 0.0, 0.0), mass=1.0)
    said = {'stiffness': stiffness, 'damping': damping, 'rest_length': 2.0}
    join(sim, 'spring/0', 'spring', [(3.0, 0.0), (0.0, 0.0)], a='mass/0', b='world', **said)
    constant = damping / stiffness

    for number, now in enumerate(steps(sim, round(2.0 * constant / DT)), 1):
        exact = relaxation(stiffness, damping, 1.0, number * DT)
        what = f'spring of {stiffness:g} N/m, {damping:g} N s/m, displacement from 1 m'
        report.check(49, what, now.poses[0, 0] - 2.0, exact, 0.01, 'm')
    last = now.poses[0, 0] - 2.0
    what = 'overdamped springs, displacement after two time constants'
    report.check(49, what, last, exact, 0.01, 'm', relative=True)


def weight_on(kind, end, max_force, **said):
    """Return 3 kg that hang on a joint from a place below or above the origin [m]."""
    sim = simulation()
    spawn(sim, 'weight/0', Disc(radius=0.1), (0.0, -2.0, 0.0), mass=3.0)
    points = [(0.0, -2.0), (0.0, end)]
    join(sim, 'j/0', kind, points, a='weight/0', b='world', max_force=max_force, **said)
    return sim


def fall_on(kind, end, said, max_force):
    """Return how far 3 kg fall on a joint in a second [m], and the force of the joint [N]."""
    now = run(weight_on(kind, end, max_force, **said), 1.0)
    return -2.0 - now.poses[0, 1], now.forces[0]


each_joint = pytest.mark.parametrize(
    ('kind', 'end', 'said'),
    [('rod', 0.0, {}), ('rope', 0.0, {}), ('slider', -3.0, {'upper': 0.0})],
)


@each_joint
@pytest.mark.parametrize('max_force', [0.0, 10.0, 20.0])
def test_a_joint_that_is_too_weak_brakes_a_fall_with_its_greatest_force(
    report, max_force, kind, end, said
):
    fall, force = fall_on(kind, end, said, max_force)

    what, exact = f'3 kg on a {kind} of too little force', (G - max_force / 3.0) / 2
    report.check(49, f'{what}, fall in 1 s', fall, exact, 0.01, 'm', relative=True)
    report.check(49, f'{what}, force', force, max_force, 0.01, 'N')


@each_joint
def test_a_joint_that_is_strong_enough_holds(report, kind, end, said):
    fall, force = fall_on(kind, end, said, max_force=32.0)

    what = f'3 kg on a {kind} of a little more force'
    report.check(49, f'{what}, fall in 1 s', fall, 0.0, 1e-3, 'm')
    report.check(49, f'{what}, force', force, 3.0 * G, 0.01, 'N', relative=True)


def swung(stiffness, damping, anchor, rest, seconds):
    """Return where a pendulum of 1 m and 1 kg with a spring to an anchor is, by its equation."""

    def change(state):
        angle, rate = state
        at = np.array([math.sin(angle), -math.cos(angle)])
        along = np.array([math.cos(angle), math.sin(angle)])
        span = math.dist(at, anchor)
        force = stiffness * (span - rest) + damping * rate * (along @ (at - anchor)) / span
        pull = force * (along @ (at - anchor)) / span
        return np.array([rate, -G * math.sin(angle) - pull])

    angle, _ = integrated(change, np.array([math.atan2(0.6, 0.8), 0.0]), seconds, 500)
    return math.sin(angle), -math.cos(angle)


# 1e-9 N s/m is a damper that has no effect, so that its pendulum moves as one without it.
@pytest.mark.parametrize('damping', [0.0, 1e-9, 0.1])
@pytest.mark.parametrize('anchor', [(2.0, 0.0), (0.6, 0.2)])
def test_a_pendulum_with_a_damped_spring_at_its_side_swings_by_its_equation(
    report, anchor, damping
):
    sim = simulation()
    start = (0.6, -0.8)
    rest = math.dist(start, anchor)
    spawn(sim, 'bob/0', Disc(radius=0.1), (*start, 0.0), mass=1.0)
    join(sim, 'rod/0', 'rod', [start, (0.0, 0.0)], a='bob/0', b='world')
    said = {'stiffness': 1.0, 'damping': damping, 'rest_length': rest}
    join(sim, 'spring/0', 'spring', [start, anchor], a='bob/0', b='world', **said)

    at = run(sim, 2.0).poses[0, :2]

    off = math.dist(at, swung(1.0, damping, anchor, rest, 2.0))
    report.check(49, 'pendulum with a damped spring at its side, after 2 s', off, 0.0, 1e-3, 'm')
