# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 76: one-way bodies."""

import math
import random

import numpy as np
from physsim_ros.model.shapes import Box, Chain, Disc, Polygon
import pytest

from .scenes import DT, G, join, run, simulation, spawn, steps, turned

ARC = np.linspace(0.5, math.pi - 0.5, 20)
ONE_WAY = {
    'thin slab': Box(width=6.0, height=0.02),
    'thick slab': Box(width=6.0, height=1.0),
    'valley': Chain(
        points=tuple((3 * math.cos(a), -3 * math.sin(a)) for a in ARC), thickness=0.04
    ),
    'step': Polygon(outline=((-3, 0), (3, 0), (3, 0.3), (-2, 0.3), (-2, 1.5), (-3, 1.5))),
}
TOPS = {'thin slab': 0.01, 'thick slab': 0.5, 'valley': -2.98, 'step': 0.3}
SHAPES = {'disc': Disc(radius=0.2), 'box': Box(width=0.4, height=0.4)}


def platform(sim, angle=0.0, **properties):
    """Add a platform whose top goes through the origin."""
    pose = (*turned((0.0, -0.1), angle), angle)
    said = {'anchored': True, 'one_way': (0.0, 1.0)} | properties
    return spawn(sim, 'platform/0', Box(width=20.0, height=0.2), pose, **said)


@pytest.mark.parametrize('shape', SHAPES)
@pytest.mark.parametrize('speed', [6.0, 60.0])
@pytest.mark.parametrize('angle', [0.0, 0.5, math.pi])
def test_what_is_thrown_up_passes_and_stands_when_it_comes_down(report, shape, speed, angle):
    # The world is turned with the platform.
    sim = simulation(gravity=tuple(turned((0.0, -G), angle)), elasticity=0.0)
    platform(sim, angle)
    where, velocity = turned((0.0, -1.0), angle), tuple(turned((0.3, speed), angle))
    spawn(sim, 'thrown/0', SHAPES[shape], (*where, angle), velocity=velocity, friction=1.0)
    highest = max(
        turned(now.poses[1, :2], -angle)[1] for now in steps(sim, 1440 if speed < 10 else 3600)
    )
    right = speed**2 / (2.0 * G) - 1.0
    name = f'{shape} through a platform, height'
    report.check(76, name, highest, right, 1e-3 * right, 'm')
    last = run(sim, 1.0)
    height = turned(last.poses[1, :2], -angle)[1]
    report.check(76, f'{shape} on a platform, height', height, 0.2, 5e-3, 'm')
    report.check(
        76, f'{shape} on a platform, fall', turned(last.twists[1, :2], -angle)[1], 0.0, 1e-6, 'm/s'
    )


def test_what_turns_back_within_a_platform_falls_out_of_it(report):
    sim = simulation()
    platform(sim)
    # Its lowest point rises to 5 cm below the top.
    rise = 1.0
    spawn(
        sim,
        'box/0',
        SHAPES['box'],
        (0.0, 0.15 - rise, 0.0),
        velocity=(0.0, math.sqrt(2.0 * G * rise)),
    )
    speed = math.sqrt(2.0 * G * rise)
    for number, now in enumerate(steps(sim, 240), 1):
        time = number / 240
        right = 0.15 - rise + speed * time - G * time**2 / 2.0
        report.check(76, 'box that turns back, height', now.poses[1, 1], right, 1e-6, 'm')


@pytest.mark.parametrize(('closed', 'right'), [(False, 2.0), (True, -0.6)])
def test_what_comes_from_aside_passes_unless_the_sides_are_closed(report, closed, right):
    sim = simulation(gravity=(0.0, 0.0), elasticity=0.0, friction=0.0)
    said = {'anchored': True, 'one_way': (0.0, 1.0), 'closed_sides': closed}
    spawn(sim, 'block/0', Box(width=1.0, height=1.0), **said)
    spawn(sim, 'box/0', Box(width=0.2, height=0.2), (-2.0, 0.1, 0.0), velocity=(2.0, 0.0))
    report.check(76, 'box from aside, x', run(sim, 2.0).poses[1, 0], right, 6e-3, 'm')


@pytest.mark.parametrize('count', [1, 12])
def test_a_stack_stays_on_a_platform_and_what_comes_from_below_lifts_it(report, count):
    sim = simulation()
    platform(sim)
    for number in range(count):
        spawn(sim, f'box/{number}', SHAPES['box'], (0.0, 0.2 + 0.4 * number, 0.0))
    last = run(sim, 5.0)
    report.check(76, 'stack on a platform, sink', last.poses[1, 1], 0.2, 5e-3, 'm')
    report.check(76, 'stack on a platform, speed', np.abs(last.twists).max(), 0.0, 1e-3, 'm/s')


def test_a_disc_rolls_along_a_hill_of_segments_and_rises_through_it(report):
    angles = np.linspace(0.7, math.pi - 0.7, 40)
    points = tuple((5.0 * math.cos(each), 5.0 * math.sin(each)) for each in angles)
    sim = simulation(elasticity=0.0)
    chain = Chain(points=points, thickness=0.02)
    spawn(sim, 'hill/0', chain, anchored=True, one_way=(0.0, 1.0))
    spawn(sim, 'disc/0', Disc(radius=0.2), (2.0, 5.5, 0.0))
    spawn(sim, 'disc/1', Disc(radius=0.2), (-2.0, 3.0, 0.0), velocity=(0.0, 9.0))
    for now in steps(sim, 200):
        distance = np.hypot(*now.poses[1:, :2].T)
        below = max(5.2 - distance[0], 0.0)
        report.check(76, 'disc on a hill, depth', below, 0.0, 0.02, 'm')
    risen = max(now.poses[2, 1] for now in steps(sim, 40))
    assert risen > 5.2


def test_boxes_on_a_lift_are_carried_up(report):
    sim = simulation()
    said = {'kinematic': True, 'anchored': False, 'velocity': (0.0, 0.5)}
    platform(sim, **said)
    spawn(sim, 'box/0', SHAPES['box'], (0.0, 0.2, 0.0))
    last = run(sim, 2.0)
    report.check(76, 'box on a lift, height', last.poses[1, 1], 1.2, 5e-3, 'm')


@pytest.mark.parametrize('shape', ONE_WAY)
def test_at_any_speed_one_side_is_open_and_the_other_one_closed(report, shape):
    chance = random.Random(1)
    for _ in range(25):
        speed, slant = 10 ** chance.uniform(0.0, 3.0), chance.uniform(-0.6, 0.6)
        angle, yaw = chance.uniform(0.0, math.tau), chance.uniform(0.0, math.tau)
        body = chance.choice((*SHAPES.values(), Disc(radius=0.05), Box(width=0.8, height=0.1)))
        up = turned((0.0, 1.0), slant)
        for side in (1.0, -1.0):
            sim = simulation(gravity=(0.0, 0.0), elasticity=0.0, friction=0.0)
            said = {'anchored': True, 'one_way': (0.0, 1.0)}
            spawn(sim, 'platform/0', ONE_WAY[shape], (0.0, 0.0, angle), **said)
            begin = side * 2.5 * up + (0.0, TOPS[shape])
            velocity = turned(-side * speed * up, angle)
            pose = (*turned(begin, angle), yaw)
            spawn(
                sim, 'thrown/0', body, pose, velocity=tuple(velocity), spin=chance.uniform(-3, 3)
            )
            # The time in which it would go 5 m.
            sim.world.step(math.ceil(5.0 / speed / DT))
            change = math.hypot(*(sim.world.snapshot().twists[1, :2] - velocity)) / speed
            if side < 0:
                report.check(76, 'from the open side, change of velocity', change, 0.0, 1e-9, '-')
            assert side < 0 or change > 0.2, f'{shape}: {speed} m/s, slant {slant}'


@pytest.mark.parametrize('speed', [1.0, 30.0, 900.0])
@pytest.mark.parametrize('shape', SHAPES)
def test_what_begins_within_a_platform_leaves_it_at_any_speed(report, shape, speed):
    for depth in (0.01, 0.05, 0.15):
        sim = simulation(gravity=(0.0, 0.0))
        platform(sim)
        spawn(sim, 'box/0', SHAPES[shape], (0.0, 0.2 - depth, 0.0), velocity=(0.0, -speed))
        sim.world.step(math.ceil(2.0 / speed / DT))
        fall = -sim.world.snapshot().twists[1, 1] / speed
        report.check(76, 'from within a platform, speed', fall, 1.0, 1e-9, '-')


def test_what_passes_through_a_one_way_body_on_an_axle_may_lie_on_others():
    # Those on it, of which none bears on the axle, belong to no island of joints.
    sim = simulation(gravity=(0.0, 0.0))
    spawn(sim, 'gate/0', Box(width=6.0, height=6.0), one_way=(0.0, 1.0))
    join(sim, 'axle/0', 'axle', [(0.0, 0.0)], a='gate/0')
    for number in range(3):
        spawn(sim, f'box/{number}', Box(width=0.5, height=0.5), (0.45 * number, -1.0, 0.0))
    last = run(sim, 0.5)
    assert np.isfinite(last.poses).all()
