# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 67: belts seen from the side."""

from physsim_ros.model.shapes import Box, Chain, Disc
import pytest

from .scenes import DT, G, run, simulation, spawn, steps

BOX = Box(width=0.4, height=0.4)


def belt(sim, speed, shape=None, **properties):
    """Add a belt whose top is at height 0, and which runs to the right there."""
    shape = shape or Box(width=40.0, height=1.0)
    return spawn(sim, 'belt/0', shape, (0.0, -0.5, 0.0), anchored=True, belt=-speed, **properties)


@pytest.mark.parametrize('speed', [0.05, 0.5, 2.0])
def test_a_box_on_a_belt_starts_with_its_friction_and_is_carried(report, speed):
    sim = simulation(friction=0.4)
    belt(sim, speed)
    spawn(sim, 'box/0', BOX, (0.0, 0.2, 0.0))
    for number, now in enumerate(steps(sim, 480), 1):
        # From the friction of both, 0.4; the bound is a step of it.
        right = min(0.4 * G * number * DT, speed)
        report.check(67, 'box on a belt, speed', now.twists[1, 0], right, 0.4 * G * DT, 'm/s')
    report.check(67, 'box on a belt, speed after 2 s', now.twists[1, 0], speed, 1e-6, 'm/s')
    report.check(67, 'box on a belt, turn', now.poses[1, 2], 0.0, 1e-3, 'rad')


def test_a_belt_runs_back_on_its_lower_side(report):
    sim = simulation(friction=0.5, gravity=(0.0, G))
    spawn(sim, 'belt/0', Box(width=40.0, height=1.0), anchored=True, belt=-1.0)
    spawn(sim, 'box/0', BOX, (0.0, -0.7, 0.0))
    last = run(sim, 1.0)
    report.check(67, 'box below a belt, speed', last.twists[1, 0], -1.0, 1e-6, 'm/s')


def test_a_wheel_that_spins_against_a_belt_stands_still(report):
    sim = simulation(friction=0.5)
    belt(sim, 1.0)
    # Its rim moves with the belt.
    spawn(sim, 'wheel/0', Disc(radius=0.25), (0.0, 0.25, 0.0), spin=4.0)
    last = run(sim, 1.0)
    report.check(67, 'spinning wheel on a belt, speed', last.twists[1, 0], 0.0, 1e-3, 'm/s')
    report.check(67, 'spinning wheel on a belt, spin', last.twists[1, 2], 4.0, 1e-2, 'rad/s')


def test_a_tread_around_a_wheel_and_along_a_chain_drives(report):
    sim = simulation(friction=0.5)
    spawn(sim, 'wheel/0', Disc(radius=5.0), (0.0, -5.0, 0.0), anchored=True, belt=-0.5)
    spawn(sim, 'box/0', BOX, (0.0, 0.2, 0.0))
    chain = Chain(points=((10.0, 0.0), (30.0, 0.0)), thickness=0.1)
    spawn(sim, 'chain/0', chain, (0.0, -0.05, 0.0), anchored=True, belt=-0.5)
    spawn(sim, 'box/1', BOX, (12.0, 0.2, 0.0))
    last = run(sim, 1.0)
    # Its centre of mass is further out than the rim, and it has gone down a little.
    report.check(67, 'box on a wheel, speed', last.twists[1, 0], 0.51, 0.01, 'm/s')
    report.check(67, 'box on a chain, speed', last.twists[3, 0], 0.5, 1e-6, 'm/s')


def test_a_wheel_rolls_over_the_seam_of_two_belts(report):
    sim = simulation(friction=0.5)
    half = Box(width=10.0, height=1.0)
    for number, x in enumerate((-4.7, 5.3)):
        spawn(sim, f'belt/{number}', half, (x, -0.5, 0.0), anchored=True, belt=-20.0)
    spawn(sim, 'wheel/0', Disc(radius=0.3), (0.0, 0.3, 0.0), velocity=(0.5, 0.0))
    highest = max(now.poses[2, 1] for now in steps(sim, 480))
    report.check(67, 'wheel over a seam, height', highest, 0.3, 1e-5, 'm')
