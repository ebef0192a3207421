# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Laws 28 and 35: a displacement is the integral of velocity, and fast bars hit all."""

import math

import numpy as np
from physsim_ros.model.shapes import Box, Disc
import pytest

from .scenes import bar_among_discs, DT, join, NOWHERE, simulation, spawn, steps

SECOND = round(1.0 / DT)


def plough(sim, speed=30.0, mass=1000.0):
    """Add a plough that moves along x; return its row."""
    return spawn(sim, 'plough/0', Box(width=0.3, height=1.0), mass=mass, velocity=(speed, 0.0))


def check_displacement(report, sim, row, what, count=SECOND):
    """Hold the displacement of a body against its velocity; return the last snapshot."""
    first = last = sim.world.snapshot()
    integral = still = 0.0
    for snapshot in steps(sim, count):
        mean = (last.twists[row, :2] + snapshot.twists[row, :2]) / 2
        integral = integral + mean * DT
        moved = np.hypot(*(snapshot.centers[row] - last.centers[row]))
        at_rest = moved < 0.01 * np.hypot(*mean) * DT
        still = still + 1 if at_rest else 0
        assert still <= 2, 'at rest while it reports a speed'
        last = snapshot
    moved = last.centers[row] - first.centers[row]
    # Along its direction, so that small sideways motion does not count as a share of itself.
    along = integral / np.hypot(*integral)
    report.check(28, what, moved @ along, integral @ along, 0.02, 'm', relative=True)
    return last


@pytest.mark.parametrize('gap', [0.12, 0.15, 0.3])
def test_the_displacement_of_a_plough_through_two_discs(report, gap):
    sim = simulation(gravity=NOWHERE)
    row = plough(sim)
    for number in range(2):
        spawn(sim, f'disc/{number}', Disc(radius=0.05), (1.0 + gap * number, 0, 0), mass=1.0)

    check_displacement(report, sim, row, 'plough of 1,000 kg through two discs, displacement')


@pytest.mark.parametrize(
    ('speed', 'elasticity'), [(8.0, 1.0), (30.0, 0.5), (100.0, 0.0), (100.0, 1.0)]
)
def test_the_displacement_of_a_plough_through_200_light_balls(report, speed, elasticity):
    sim = simulation(gravity=NOWHERE, elasticity=elasticity)
    row = plough(sim, speed=speed)
    for number in range(200):
        place = (1.0 + 0.12 * (number // 8), 0.13 * (number % 8) - 0.46, 0.0)
        spawn(sim, f'ball/{number}', Disc(radius=0.05), place, mass=0.1)

    check_displacement(
        report, sim, row, f'plough through 200 balls, e = {elasticity:g}, displacement'
    )


@pytest.mark.parametrize('mass', [300.0, 1000.0, 3000.0])
def test_the_displacement_of_what_is_heavy_into_what_is_heavy(report, mass):
    sim = simulation(gravity=NOWHERE)
    row = plough(sim)
    other = spawn(sim, 'other/0', Box(width=0.5, height=0.5), (3.0, 0.0, 0.0), mass=mass)

    last = check_displacement(report, sim, other, 'heavy box, struck by a heavy box, displacement')
    assert last.centers[row, 0] < last.centers[other, 0]


def test_the_displacement_of_a_bullet_through_a_stack(report):
    sim = simulation(gravity=NOWHERE)
    row = spawn(sim, 'bullet/0', Disc(radius=0.03), mass=5.0, velocity=(200.0, 0.0))
    for number in range(10):
        place = (1.0 + 0.31 * number, 0.0, 0.0)
        spawn(sim, f'box/{number}', Box(width=0.3, height=0.3), place, mass=0.1)

    check_displacement(report, sim, row, 'bullet through ten light boxes, displacement')


def test_the_turn_of_a_wrecking_ball_on_an_axle(report):
    sim = simulation(gravity=NOWHERE)
    rod = spawn(sim, 'rod/0', Box(width=4.0, height=0.2), mass=500.0, spin=15.0)
    join(sim, 'axle/0', 'axle', [(0.0, 0.0)], a='rod/0')
    for number in range(30):
        angle = 0.3 + 2.5 * number / 30
        place = (1.8 * math.cos(angle), 1.8 * math.sin(angle), 0.0)
        spawn(sim, f'ball/{number}', Disc(radius=0.05), place, mass=0.1)

    turn, last = 0.0, sim.world.snapshot()
    start = last.poses[rod, 2]
    for snapshot in steps(sim, SECOND):
        turn += (last.twists[rod, 2] + snapshot.twists[rod, 2]) / 2 * DT
        last = snapshot
    # Reported angles are within half a turn.
    off = math.remainder(last.poses[rod, 2] - start - turn, math.tau)
    report.check(28, 'beam on an axle through 30 balls, turn', turn + off, turn, 0.02, 'rad',
                 relative=True)  # fmt: skip


@pytest.mark.parametrize('spin', [20.0, 100.0, 300.0])
def test_a_fast_bar_hits_all_discs(report, spin):
    sim, discs = bar_among_discs(spin)

    hit = np.zeros(40, np.bool_)
    for snapshot in steps(sim, math.ceil(2 * math.pi / spin / DT) + 2):
        hit |= np.hypot(*snapshot.twists[discs, :2].T) > 0.5 * spin * 0.4

    report.check(35, f'bar at {spin:g} rad/s, discs hit', hit.sum(), 40, 0, '–')
