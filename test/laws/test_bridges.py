# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Laws 30 and 33: a load on a bridge of light planks stays on it, and presses with its weight."""

import math
import random

import numpy as np
from physsim_ros.model.shapes import Box, Disc
import pytest

from .scenes import energy, G, join, simulation, spawn, steps
from ..slow import slow

PLANKS = 10
PLANK = 0.22  # kg
SPAN = PLANKS * 1.0  # m


def bridge(kind, slack=0.0):
    """
    Return a bridge of planks of 1 m between two points of the background, and its middle.

    :param slack: by which the planks together are longer than the span [m]
    """
    sim = simulation()
    slope = math.acos((SPAN - slack) / SPAN)
    ends = [np.array((0.0, 5.0))]
    for number in range(PLANKS):
        turn = -slope if number < PLANKS // 2 else slope
        ends.append(ends[-1] + (math.cos(turn), math.sin(turn)))
        pose = (*(ends[-2] + ends[-1]) / 2, turn)
        spawn(sim, f'plank/{number}', Box(width=1.0, height=0.2), pose, mass=PLANK, group=7)
    for number, end in enumerate(ends):
        a = f'plank/{min(number, PLANKS - 1)}'
        b = f'plank/{number - 1}' if 0 < number < PLANKS else 'world'
        join(sim, f'joint/{number}', kind, [tuple(end)], a=a, b=b)
    return sim, ends[PLANKS // 2]


def put_load(sim, shape, ratio, middle, **said):
    """Put a load on planks, and return its row."""
    radius = shape.radius if isinstance(shape, Disc) else shape.height / 2
    pose = (middle[0], middle[1] + 0.1 + radius, 0.0)
    return spawn(sim, 'load/0', shape, pose, mass=ratio * PLANK, **said)


def widest(snapshot):
    """Return the widest gap of all joints [m]."""
    return float(np.hypot(*(snapshot.ends[:, 0] - snapshot.ends[:, 1]).T).max())


def depth(sim):
    """Return how deep the load lies in a plank [m], by the engine's shapes."""
    bodies = sim.world.space.bodies.by_name
    planks = [bodies[f'plank/{number}'].pm_body for number in range(PLANKS)]
    (load,) = bodies['load/0'].pm_body.shapes
    return max(_overlap(load, shape) for plank in planks for shape in plank.shapes)


def _overlap(one, other):
    if not one.bb.intersects(other.bb):
        return 0.0
    try:
        return max(-point.distance for point in one.shapes_collide(other).points)
    except AssertionError:
        # Pymunk 7.3.1 asserts that there is a point.
        return 0.0


TABLE = [
    ('axle', 0.0, Box(width=0.6, height=0.6), 3.0, 0.02),
    slow('axle', 0.0, Box(width=0.6, height=0.6), 30.0, 0.02),
    slow('axle', 0.0, Box(width=0.6, height=0.6), 100.0, 0.02),
    ('axle', 0.0, Disc(radius=0.3), 273.0, 0.03),
    slow('axle', 0.001, Disc(radius=0.3), 10.0, 0.02),
    slow('axle', 0.001, Disc(radius=0.3), 30.0, 0.02),
    slow('axle', 0.01, Disc(radius=0.3), 30.0, 0.02),
    ('axle', 0.05, Disc(radius=0.3), 30.0, 0.02),
    slow('pin', 0.0, Disc(radius=0.3), 10.0, 0.02),
    slow('pin', 0.0, Disc(radius=0.3), 100.0, 0.02),
    ('pin', 0.0, Disc(radius=0.3), 273.0, 0.03),
]


@pytest.mark.parametrize(('kind', 'slack', 'shape', 'ratio', 'deepest'), TABLE)
def test_a_load_lies_on_a_bridge(report, kind, slack, shape, ratio, deepest):
    sim, middle = bridge(kind, slack)
    load = put_load(sim, shape, ratio, middle)
    what = f'{ratio:g} : 1 on planks, {kind}, slack of {slack * 1e3:g} mm'
    for now in steps(sim, 480):
        report.check(33, f'{what}, gap', widest(now), 0.0, 0.02, 'm')
        report.check(33, f'{what}, depth', depth(sim), 0.0, deepest, 'm')
    # A slack of 5 cm lets the middle sink by half a metre from the straight line.
    lowest = middle[1] - 0.1 * SPAN / 2 * math.sqrt(2.0 * slack / SPAN) - 0.05
    assert now.poses[load, 1] > lowest + 0.1


@pytest.mark.parametrize('kind', [slow('axle'), 'pin'])
def test_a_bridge_is_told_the_weight_that_lies_on_it(report, kind):
    sim, middle = bridge(kind)
    load = put_load(sim, Box(width=0.6, height=0.6), 30.0, middle)
    sim.reports_contacts = True
    pressed = np.zeros(2)
    for _ in range(60):
        before = sim.advance_frame().snapshot.twists[load, 1]
    for _ in range(120):
        frame = sim.advance_frame()
        contacts = frame.contacts
        pressed -= contacts.impulses[contacts.pairs[:, 0] == load].sum(axis=0)
        pressed += contacts.impulses[contacts.pairs[:, 1] == load].sum(axis=0)
    # A load on a straight chain trembles by millimetres: its momentum is part of the balance.
    mass = 30.0 * PLANK
    weight = mass * (2.0 * G + frame.snapshot.twists[load, 1] - before)
    what = f'30 : 1 on planks, {kind}, impulse in 2 s'
    # A flight that begins or ends: half a sub-step of gravity.
    report.check(30, what, pressed[1], weight, mass * G / 1920.0, 'N s')


@pytest.mark.parametrize('ratio', [10.0, slow(100.0)])
def test_a_disc_rolls_over_a_bridge(report, ratio):
    sim, _ = bridge('axle')
    radius = 0.3
    rolling = {'velocity': (2.0, 0.0), 'spin': -2.0 / radius}
    put_load(sim, Disc(radius=radius), ratio, (0.7, 5.0), **rolling)
    for _ in steps(sim, 960):
        report.check(33, f'disc of {ratio:g} : 1 rolls, depth', depth(sim), 0.0, 0.02, 'm')
    x, y, _ = sim.world.snapshot().poses[-1]
    assert x > 2.0
    assert y > 5.0


def banked():
    """Return a bridge on axles between two banks."""
    sim, _ = bridge('axle')
    for number, (x, width) in enumerate(((-0.5, 1.0), (11.5, 3.0))):
        box = Box(width=width, height=1.0)
        spawn(sim, f'bank/{number}', box, (x, 4.6, 0.0), anchored=True, group=7)
    return sim


def roller(sim):
    """Let 50 kg roll over it."""
    place = (1.0, 5.61, 0.0)
    spawn(sim, 'roller/0', Disc(radius=0.5), place, mass=50.0, velocity=(2.0, 0.0), spin=-4.0)


def rubble(sim, seed=0):
    """Drop 80 boxes of 5 kg on it; by a seed they lie a micrometre elsewhere."""
    pick = random.Random(seed)
    for number in range(80):
        x = 0.6 + 0.45 * (number % 20) + pick.uniform(-1e-6, 1e-6)
        place = (x, 5.5 + 0.45 * (number // 20), 0.0)
        spawn(sim, f'box/{number}', Box(width=0.4, height=0.4), place, mass=5.0)


def other_rubble(sim):
    """Drop the boxes in another way."""
    rubble(sim, seed=1)


@pytest.mark.parametrize('load', [roller, rubble, slow(other_rubble)])
def test_light_planks_stay_closed_under_a_heavy_load(report, load):
    sim = banked()
    load(sim)
    before = sim.world.snapshot()
    fell = gained = 0.0
    gaps = []
    for now in steps(sim, 480):
        gaps.append(widest(now))
        fell = max(fell, before.potential_energy - now.potential_energy)
        gained = max(gained, energy(now) - energy(before))
    # An impact between two light planks can part them for a step.
    most = float(np.percentile(gaps, 99))
    what = f'{load.__name__} on ten planks'
    report.check(33, f'{what}, gap in 99 % of the steps', most, 0.0, 0.02, 'm')
    loads = now.poses[12:]
    between = (loads[:, 0] > 0.0) & (loads[:, 0] < 10.0)
    assert (loads[between, 1] > 5.0).all()
    # Kinetic energy and the fall of loads can become a gain; a roller that is borne hardly falls.
    there = before.kinetic_energy + fell
    report.check(33, f'{what}, energy gain', gained / there, 0.0, 0.01, '–')
