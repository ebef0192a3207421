# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Laws 18, 19 and 43: what is stacked stands, and does not sink, creep, sway or lean."""

import math
import random

import numpy as np
from physsim_ros.model.shapes import Box, Disc
from physsim_ros.simulation.simulation import Simulation
import pytest

from .scenes import floor, join, pyramid, run, simulation, spawn, steps, walls
from ..slow import slow

ORDERS = {
    'bottom up': list(range(10)),
    'top down': list(range(9, -1, -1)),
    'shuffled': random.Random(1).sample(range(10), 10),
}


def fastest(snapshot):
    """Return the speed of the fastest body [m/s]."""
    return float(np.hypot(*snapshot.twists[:, :2].T).max())


def _stack(size, order, ground=floor):
    """Stack boxes that touch exactly; return the simulation and their rows from the bottom up."""
    sim = simulation()
    ground(sim)
    box, rows = Box(width=size, height=size), {}
    for level in order:
        rows[level] = spawn(sim, f'box/{level}', box, (0.0, size * (level + 0.5), 0.0))
    return sim, [rows[level] for level in range(10)]


def _platform(sim):
    """Hang a light platform by three rods, on which it cannot swing, its top at height 0."""
    spawn(sim, 'platform/0', Box(width=4.0, height=0.2), (0.0, -0.1, 0.0), mass=0.5)
    for number, (x, top) in enumerate(((-2.0, -2.0), (2.0, 2.0), (-2.0, 2.0))):
        ends = [(x, -0.1), (top, 10.0)]
        join(sim, f'rod/{number}', 'rod', ends, a='platform/0', b='world')


@pytest.mark.parametrize('order', ORDERS.values(), ids=ORDERS.keys())
@pytest.mark.parametrize(
    ('size', 'ground'), [(1.0, floor), (0.5, floor), (0.3, floor), (0.5, _platform)]
)
def test_a_stack_of_ten_boxes_stands_still(report, size, ground, order):
    sim, rows = _stack(size, order, ground)

    at_5 = run(sim, 5.0)
    most = 0.0
    for _ in range(300):
        end = sim.advance_frame().snapshot
        most = max(most, fastest(end))

    sunk = size * (np.arange(10) + 0.5) - end.poses[rows, 1]
    report.check(18, '10 boxes, sink in 10 s', float(np.abs(sunk).max()), 0.0, 3e-3, 'm')
    crept = float(np.abs(end.poses[rows] - at_5.poses[rows]).max())
    report.check(18, '10 boxes, creep from 5 s to 10 s', crept, 0.0, 1e-4, 'm, rad')
    report.check(18, '10 boxes, speed after 5 s', most, 0.0, 1e-3, 'm/s')
    tilt = float(np.abs(end.poses[rows, 2]).max())
    report.check(18, '10 boxes, tilt', tilt, 0.0, 5e-3, 'rad')


def _until_asleep(size, rate):
    """Return when a stack of ten falls asleep [s], and the speed of its last step before [m/s]."""
    sim = Simulation(physics_rate=rate)
    floor(sim)
    for level in range(10):
        pose = (0.0, size * (level + 0.5), 0.0)
        spawn(sim, f'box/{level}', Box(width=size, height=size), pose)
    last = math.inf
    for snapshot in steps(sim, round(10.0 * rate)):
        if (speed := fastest(snapshot)) == 0.0:
            break
        last = speed
    return snapshot.step / rate, last


@pytest.mark.parametrize('size', [1.0, 0.3])
def test_a_stack_sways_no_more_when_it_falls_asleep(report, size):
    _, speed = _until_asleep(size, 240.0)

    report.check(18, '10 boxes, speed as they fall asleep', speed, 0.0, 1e-4, 'm/s')


def test_a_stack_comes_to_rest_about_as_soon_at_any_physics_rate(report):
    # Half a second of rest, and it sleeps.
    often, seldom = (_until_asleep(1.0, rate)[0] - 0.5 for rate in (960.0, 120.0))

    ratio = seldom / often
    report.check(18, '10 boxes at 120 and 960 Hz, ratio of times to rest', ratio, 2.0, 1.0, '–')


def test_a_stack_stands_on_the_walls_of_the_world_too(report):
    sim, _ = _stack(0.5, ORDERS['bottom up'], lambda sim: walls(sim, -5.0, 0.0, 5.0, 20.0))

    end = run(sim, 6.0)

    report.check(18, '10 boxes, speed after 5 s', fastest(end), 0.0, 1e-3, 'm/s')


# Boxes of 0.3 m do not touch to the last bit, and fall a little before they all do.
@pytest.mark.parametrize(('size', 'tolerance'), [(1.0, 2e-3), (0.5, 2e-3), (0.3, 3e-3)])
@pytest.mark.parametrize('gap', [0.0, 0.1])
def test_a_pyramid_of_105_boxes_stands_still(report, gap, size, tolerance):
    sim = simulation()
    floor(sim)
    heights = pyramid(sim, size, gap)

    end = run(sim, 10.0)

    sunk = float(np.abs(np.array(heights) - end.poses[1:, 1]).max())
    what = f'pyramid of 105 boxes of {size:g} m, sink in 10 s'
    report.check(19, what, sunk, 0.0, tolerance, 'm')
    report.check(19, 'pyramid of 105, speed after 10 s', fastest(end), 0.0, 1e-3, 'm/s')


def test_a_stack_of_elastic_boxes_does_not_sink_where_balls_bounce_off_it(report):
    sim, pick, size = simulation(elasticity=0.8, friction=0.6), random.Random(1), 0.5
    walls(sim, -4.0, 0.0, 4.0, 12.0)
    heights = size * (np.arange(8) + 0.5)
    for level, height in enumerate(heights.tolist()):
        spawn(sim, f'box/{level}', Box(width=1.0, height=size), (0.0, height, 0.0), mass=20.0)
    run(sim, 2.0)
    for number in range(10):
        place = (pick.choice((-1.0, 1.0)) * pick.uniform(1.5, 3.5), pick.uniform(0.5, 5.0), 0.0)
        velocity = (pick.uniform(-6.0, 6.0), pick.uniform(-6.0, 6.0))
        said = {'mass': 0.1, 'elasticity': 1.0, 'velocity': velocity}
        spawn(sim, f'ball/{number}', Disc(radius=0.1), place, **said)

    sunk = max(float((heights - each.poses[:8, 1]).max()) for each in steps(sim, 960))

    report.check(18, 'elastic boxes that balls hit, sink in 4 s', sunk, 0.0, 3e-3, 'm')


@pytest.mark.parametrize('seconds', [20.0, slow(60.0)])
@pytest.mark.parametrize('count', [20, 40])
def test_a_tower_of_boxes_stands(report, count, seconds):
    size = 0.5
    sim = simulation(elasticity=0.0)
    floor(sim)
    heights = size * (np.arange(count) + 0.5)
    for number, height in enumerate(heights.tolist()):
        spawn(sim, f'box/{number}', Box(width=size, height=size), (0.0, height, 0.0))

    end = run(sim, seconds)

    what = f'tower of {count} boxes'
    report.check(43, f'{what}, lean of the top', end.poses[-1, 0], 0.0, 0.1, 'm')
    sunk = float(np.abs(end.poses[1:, 1] - heights).max())
    report.check(43, f'{what}, sink', sunk, 0.0, 0.01, 'm')
    report.check(43, f'{what}, speed at the end', fastest(end), 0.0, 1e-3, 'm/s')
