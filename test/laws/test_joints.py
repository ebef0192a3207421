# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Laws 32, 34 and 58: joints under loads and each other; their warm start over checkpoints."""

import math
import random

import numpy as np
from physsim_ros.model.shapes import Box, Disc
import pytest

from .scenes import DT, energy, G, join, run, simulation, spawn, steps
from ..slow import slow


def double_pendulum():
    """Return two bars that swing from each other."""
    sim = simulation()
    for number in range(2):
        spawn(sim, f'bar/{number}', Box(width=1.0, height=0.1), (0.5 + number, 0.0, 0.0))
        other = f'bar/{number - 1}' if number else 'world'
        points = [(float(number), 0.0)]
        join(sim, f'j/{number}', 'axle', points, a=f'bar/{number}', b=other)
    return sim


@pytest.mark.parametrize('power', range(3, 9))
def test_a_spring_is_as_stiff_as_it_says(report, power):
    sim, stiffness = simulation(), 10.0**power
    spawn(sim, 'mass/0', Disc(radius=0.1), mass=1.0)
    said = {'stiffness': stiffness, 'damping': math.sqrt(stiffness), 'a': 'mass/0', 'b': 'world'}
    join(sim, 'spring/0', 'spring', [(0.0, 0.0), (0.0, 1.0)], **said)
    last = run(sim, 5.0)
    exact = G / stiffness
    what = f'1 kg on {stiffness:g} N/m, extension'
    report.check(32, what, -last.poses[0, 1], exact, 0.01, 'm', relative=True)


def beam_on_joints(kind, count, **said):
    """Return a beam of 3 kg that hangs level on several joints."""
    sim = simulation()
    spawn(sim, 'beam/0', Box(width=2.0, height=0.1), mass=3.0)
    for number in range(count):
        x = -0.9 + 1.8 * number / (count - 1)
        points = [(x, 0.0)] if kind == 'pin' else [(x, 0.0), (x, 1.0)]
        join(sim, f'joint/{number}', kind, points, a='beam/0', b='world', **said)
    return sim


@pytest.mark.parametrize('count', [3, 4, 5])
@pytest.mark.parametrize('kind', ['rope', 'rod', 'pin'])
def test_joints_share_a_load_that_statics_leaves_open(report, kind, count):
    last = run(beam_on_joints(kind, count, break_force=1.1 * 3.0 * G / count), 1.0)

    assert len(last.forces) == count
    for force in last.forces:
        what = f'a {kind} of several that carry 3 kg, force'
        report.check(58, what, force, 3.0 * G / count, 0.01, 'N', relative=True)


KINDS = ('axle', 'pin', 'rod', 'slider', 'rope', 'gear')


def tangle(seed, kinds=KINDS):
    """Return six boxes with joints that contradict each other, above a floor; and its motors."""
    pick, sim = random.Random(seed), simulation()
    spawn(sim, 'floor/0', Box(width=100.0, height=1.0), (0.0, -0.5, 0.0), anchored=True)
    places = [(pick.uniform(-2.0, 2.0), pick.uniform(2.0, 5.0)) for _ in range(6)]
    for number, place in enumerate(places):
        box = Box(width=pick.uniform(0.3, 1.0), height=pick.uniform(0.3, 1.0))
        spawn(sim, f'b/{number}', box, (*place, 0.0), mass=10 ** pick.uniform(-1, 1))
    motors = []
    for number in range(8):
        b = pick.randrange(6)
        a = pick.choice([f'b/{other}' for other in range(6) if other != b] + ['world'])
        kind = pick.choice(kinds)
        x, y = places[b]
        near = (x + pick.uniform(-0.5, 0.5), y + pick.uniform(-0.5, 0.5))
        far = (pick.uniform(-2.0, 2.0), pick.uniform(2.0, 5.0))
        points = [near, far] if kind in ('rod', 'slider', 'rope', 'spring') else [near]
        said = {}
        if kind == 'spring':
            said = {'stiffness': 10.0, 'damping': 0.1}
        elif kind == 'motor':
            said = {'rate': pick.uniform(-5.0, 5.0), 'max_torque': pick.choice([1.0, 10.0, 50.0])}
            rows = [sim.world.snapshot().scene.names.index(each) for each in (a, f'b/{b}')
                    if each != 'world']  # fmt: skip
            motors.append((rows, said['max_torque']))
        join(sim, f'j/{number}', kind, points, a=f'b/{b}', b=a, **said)
    return sim, motors


def energy_from_nowhere(sim, motors):
    """Return the greatest gain of energy in two seconds, as a share of what could fall."""
    last = before = sim.world.snapshot()
    most = float(before.scene.inertia[:, 0].sum()) * G * 5.0
    work = gain = 0.0
    for now in steps(sim, 480):
        for rows, torque in motors:
            spins = np.array([each.twists[rows, 2] for each in (last, now)])
            # That of the background is none.
            work += torque * DT * float(np.abs(spins[:, 0] - spins[:, 1:].sum(axis=1)).max())
        gain = max(gain, energy(now) - energy(before) - work)
        last = now
    return gain / most


@pytest.mark.parametrize('seed', [*range(4), *map(slow, range(4, 20))])
def test_joints_that_contradict_each_other_give_no_energy(report, seed):
    gain = energy_from_nowhere(*tangle(seed))
    report.check(34, 'tangle, energy gained', gain, 0.0, 0.05, '–')


@pytest.mark.slow
def test_motors_and_springs_among_them_give_no_energy_either(report):
    seeds = random.Random(34).sample(range(1_000_000), 60)
    gains = [energy_from_nowhere(*tangle(seed, (*KINDS, 'spring', 'motor'))) for seed in seeds]
    what = 'tangle with motors and springs, energy gained'
    report.check(34, f'{what} by nine in ten', float(np.percentile(gains, 90)), 0.0, 0.05, '–')
    # Joints that are drawn together lift their bodies, which is counted as a gain.
    report.check(34, f'{what} by any', max(gains), 0.0, 0.2, '–')


@pytest.mark.parametrize('seed', [33, slow(44)])
def test_motors_that_jam_on_the_ground_give_no_energy(report, seed):
    gain = energy_from_nowhere(*tangle(seed, (*KINDS, 'spring', 'motor')))
    report.check(34, 'tangle that jams, energy gained', gain, 0.0, 0.05, '–')


def test_a_loaded_chain_does_not_stir_at_a_checkpoint(report):
    sim = simulation()
    for number in range(30):
        place = (0.0, -0.2 * (number + 0.5), 0.0)
        spawn(sim, f'link/{number}', Box(width=0.05, height=0.2), place, mass=0.1)
        other = f'link/{number - 1}' if number else 'world'
        points = [(0.0, -0.2 * number)]
        join(sim, f'axle/{number}', 'axle', points, a=f'link/{number}', b=other)
    sim.world.step(960)
    sim.world.renew()
    for now in steps(sim, 24):
        fastest = float(np.abs(now.twists).max())
        report.check(26, 'chain at rest, after a checkpoint', fastest, 0.0, 5e-3, 'm/s')
