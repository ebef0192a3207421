# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Laws 29 and 30: nothing far away changes anything here, and contacts report the whole weight."""

import itertools
import random

import numpy as np
from physsim_ros.model.requests import Command
from physsim_ros.model.shapes import Box, Disc
import pytest

from .scenes import DT, floor, G, join, run, simulation, spawn
from ..slow import slow

FAR = 50.0


def pendulum(sim):
    spawn(sim, 'here/0', Box(width=1.0, height=0.1), (0.5, 4.0, 0.0))
    join(sim, 'here/0', 'axle', [(0.0, 4.0)], a='here/0', b='world')


def machine(sim):
    for number in range(4):
        spawn(sim, f'here/{number}', Box(width=1.0, height=0.1), (number + 0.5, 6.0, 0.0))
        other = f'here/{number - 1}' if number else 'world'
        join(sim, f'here/{number}', 'axle', [(float(number), 6.0)], a=f'here/{number}', b=other)


def stack(sim):
    for number in range(5):
        spawn(sim, f'here/{number}', Box(width=1.0, height=1.0), (0.0, number + 0.5, 0.0))


def cradle(sim):
    for number in range(5):
        x = 0.4 * number
        place = (x - 1.5, 5.5, 0.0) if number == 0 else (x, 4.0, 0.0)
        said = {'friction': 0.0, 'elasticity': 1.0}
        spawn(sim, f'here/{number}', Disc(radius=0.2), place, **said)
        anchor = (x, 4.0 + np.hypot(1.5, 1.5) if number == 0 else 6.0)
        join(sim, f'here/{number}', 'rod', [place[:2], anchor], a=f'here/{number}', b='world')


def bouncing_disc(sim):
    said = {'velocity': (6.0, -3.0), 'spin': 4.0, 'elasticity': 0.7, 'friction': 0.5}
    spawn(sim, 'here/0', Disc(radius=0.2), (0.0, 3.0, 0.0), **said)


def motor(sim):
    spawn(sim, 'far/0', Box(width=1.0, height=0.1), (FAR, 4.0, 0.0))
    said = {'a': 'far/0', 'b': 'world', 'rate': 3.0, 'max_torque': 50.0}
    join(sim, 'far/0', 'motor', [(FAR, 4.0)], **said)


def wrench(sim):
    spawn(sim, 'far/0', Disc(radius=0.3), (FAR, 0.3, 0.0))
    sim.perform(Command(names=('far/0',), wrenches=((3.0, 0.0, 0.0),)))


def grain(sim):
    spawn(sim, 'far/0', Disc(radius=0.002), (FAR, 0.002, 0.0))


def tangle(sim):
    pick = random.Random(3)
    for number in range(6):
        place = (FAR + pick.uniform(-1.0, 1.0), pick.uniform(2.0, 4.0), 0.0)
        spawn(sim, f'far/{number}', Box(width=0.6, height=0.4), place)
    for number in range(8):
        a, b = pick.sample(range(6), 2)
        point = (FAR + pick.uniform(-1.0, 1.0), pick.uniform(2.0, 4.0))
        join(sim, f'far/{number}', 'axle', [point], a=f'far/{a}', b=f'far/{b}')


def elastic_discs(sim):
    pick = random.Random(4)
    for number in range(100):
        place = (FAR + 0.5 * (number % 10), 0.5 + 0.5 * (number // 10), 0.0)
        said = {'elasticity': 1.0, 'velocity': (pick.uniform(-3.0, 3.0), 0.0)}
        spawn(sim, f'far/{number}', Disc(radius=0.2), place, **said)


def boxes(sim):
    for number in range(400):
        place = (FAR + 1.0 * (number % 40), 0.5 + number // 40, 0.0)
        spawn(sim, f'far/{number}', Box(width=1.0, height=1.0), place)


# Each of both at least once.
QUICK = {
    (pendulum, motor),
    (machine, wrench),
    (stack, tangle),
    (cradle, elastic_discs),
    (pendulum, boxes),
    (bouncing_disc, grain),
}
PAIRS = itertools.product(
    (pendulum, machine, stack, cradle, bouncing_disc),
    (motor, wrench, grain, tangle, elastic_discs, boxes),
)


@pytest.mark.parametrize(
    ('here', 'far'), [pair if pair in QUICK else slow(*pair) for pair in PAIRS]
)
def test_far_away_changes_nothing(report, here, far):
    alone, beside = (simulation(command_timeout=0.0) for _ in range(2))
    for sim in (alone, beside):
        floor(sim)
        here(sim)
    count = len(alone.world)
    far(beside)
    off = np.abs(run(alone, 1.5).poses - run(beside, 1.5).poses[:count]).max()
    # Chains of contacts are solved in the order in which the engine has found them.
    tolerance = 1e-9 if here in (pendulum, machine, bouncing_disc) else 2e-3
    report.check(29, f'{here.__name__} beside {far.__name__}', off, 0.0, tolerance, 'm')


@pytest.mark.parametrize('turn', [0.0, 1e-15])
def test_an_elastic_box_that_just_touches_falls_flat_whatever_is_elsewhere(report, turn):
    alone, beside = (simulation(gravity=(0.0, 0.0)) for _ in range(2))
    for sim in (alone, beside):
        floor(sim, elasticity=1.0)
        # After ten steps its lower face lies in the floor's, but for rounding.
        said = {'velocity': (0.0, -2.4), 'elasticity': 1.0}
        spawn(sim, 'here/0', Box(width=0.5, height=0.5), (0.0, 0.25 + 2.4 * 10 * DT, turn), **said)
    for number in range(3):
        place = (FAR + 0.397 * number, 0.2, 0.0)
        spawn(beside, f'far/{number}', Disc(radius=0.2), place, elasticity=1.0)
    twists = [run(sim, 0.25).twists[1] for sim in (alone, beside)]

    report.check(29, f'flat fall turned by {turn:g}, spin', twists[0][2], 0.0, 1e-3, 'rad/s')
    off = np.abs(twists[0] - twists[1]).max()
    report.check(29, f'flat fall turned by {turn:g} beside discs', off, 0.0, 1e-9, 'm/s')


def weight_on(sim, name, seconds=1.0):
    """Return the upward impulse on a body in a time, less that which it gives [N s]."""
    sim.reports_contacts = True
    run(sim, 3.0)
    total = 0.0
    for _ in range(round(60 * seconds)):
        frame = sim.advance_frame()
        row = frame.snapshot.scene.names.index(name)
        contacts = frame.contacts
        total -= contacts.impulses[contacts.pairs[:, 0] == row, 1].sum()
        total += contacts.impulses[contacts.pairs[:, 1] == row, 1].sum()
    return total


@pytest.mark.parametrize('machine_of', ['ground', 'stack', 'pinned', 'axled', 'welded'])
def test_contacts_report_the_whole_weight(report, machine_of):
    sim = simulation()
    floor(sim)
    top = 0.0
    if machine_of == 'stack':
        spawn(sim, 'under/0', Box(width=1.0, height=1.0), (0.0, 0.5, 0.0))
        top = 1.0
    elif machine_of == 'pinned':
        spawn(sim, 'under/0', Box(width=3.0, height=0.2), (0.0, 2.0, 0.0))
        join(sim, 'pin/0', 'pin', [(-1.5, 2.0)], a='under/0', b='world')
        top = 2.1
    elif machine_of == 'axled':
        spawn(sim, 'under/0', Box(width=3.0, height=0.2), (0.0, 2.0, 0.0))
        for number, x in enumerate((-1.4, 1.4)):
            join(sim, f'axle/{number}', 'axle', [(x, 2.0)], a='under/0', b='world')
        top = 2.1
    elif machine_of == 'welded':
        for number in range(3):
            place = (number - 1.0, 2.0, 0.0)
            spawn(sim, f'under/{number}', Box(width=1.0, height=0.2), place)
            other = f'under/{number - 1}' if number else 'world'
            join(sim, f'p/{number}', 'pin', [(number - 1.5, 2.0)], a=f'under/{number}', b=other)
        join(sim, 'p/3', 'pin', [(1.5, 2.0)], a='under/2', b='world')
        top = 2.1
    spawn(sim, 'load/0', Box(width=0.8, height=0.8), (0.0, top + 0.4, 0.0), mass=2.0)

    impulse = weight_on(sim, 'load/0')

    report.check(
        30, f'2 kg on {machine_of}, impulse in 1 s', impulse, 2 * G, 0.01, 'N s', relative=True
    )
