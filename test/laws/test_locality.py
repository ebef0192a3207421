# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Laws 29 and 30: nothing far away changes anything here, and contacts report the whole weight."""

import numpy as np
from physsim_ros.model.shapes import Box, Disc
import pytest

from .scenes import DT, floor, G, join, run, simulation, spawn

FAR = 50.0


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
