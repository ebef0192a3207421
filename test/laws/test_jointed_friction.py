# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 61: friction of bodies that have joints holds, slides, tips and drives as statics says."""

import itertools
import math

import numpy as np
from physsim_ros.model.shapes import Box, Disc
import pytest

from .scenes import floor, G, join, run, simulation, spawn, steps

# The greatest distance by which what stands may sink [m]: a fiftieth of the slop of contacts.
SETTLED = 1e-4


def _add(ornament, sim, body, point):
    """Add something that has a joint and changes nothing."""
    if ornament == '1 g pinned':
        spawn(sim, 'ornament/0', Disc(radius=0.02), (*point, 0.0), mass=0.001, group=1)
        join(sim, 'ornament/1', 'pin', [point], a='ornament/0', b=body)
    elif ornament == 'slack rope':
        join(sim, 'ornament/1', 'rope', [point, (0.0, 30.0)], a=body, b='world', length=60.0)
    elif ornament == 'damper of nothing':
        said = {'stiffness': 0.0, 'damping': 1e-9}
        join(sim, 'ornament/1', 'spring', [point, (0.0, 30.0)], a=body, b='world', **said)


def fridge(arm, **said):
    """Return a fridge that is pushed by 1.05 times what friction holds, at a height [m]."""
    sim, width, height, mass = simulation(elasticity=0.0, friction=0.4), 0.6, 1.8, 50.0
    floor(sim)
    force = {'force': (1.05 * 0.4 * mass * G, 0.0), 'at': (-width / 2, arm - height / 2)}
    shape, pose = Box(width=width, height=height), (0.0, height / 2, 0.0)
    spawn(sim, 'fridge/0', shape, pose, mass=mass, forces=(force,), **said)
    return sim


ORNAMENTS = ['nothing', '1 g pinned', 'slack rope', 'damper of nothing']


@pytest.mark.parametrize('ornament', ORNAMENTS)
@pytest.mark.parametrize(('share', 'tips'), [(0.9, False), (1.2, True)])
def test_a_fridge_tips_when_it_is_pushed_above_half_its_width_by_its_friction(
    ornament, share, tips
):
    sim = fridge(share * 0.3 / 0.4 / 1.05, group=1)
    _add(ornament, sim, 'fridge/0', (0.0, 0.9))

    turned = abs(run(sim, 2.0).poses[1, 2])

    assert turned > 1.5 if tips else turned < 0.02


@pytest.mark.parametrize('speed', [0.005, 0.02, 0.3])
def test_jointed_boxes_that_a_winch_draws_slide_at_its_rate_without_a_hop(report, speed):
    sim = simulation(friction=0.7, elasticity=0.0)
    floor(sim)
    rows = [
        spawn(sim, f'box/{mass}', Box(width=0.5, height=0.5), (mass - 1.5, 0.25, 0.0), mass=mass)
        for mass in (1, 2)
    ]
    join(sim, 'rod/0', 'rod', [(-0.5, 0.25), (0.5, 0.25)], a='box/1', b='box/2')
    points = [(0.5, 0.25), (5.5, 0.25)]
    join(sim, 'winch/0', 'rope', points, a='box/2', b='world', rate=-speed, lower=0.1)

    moved = list(steps(sim, 240))[20:]

    heights = [snapshot.poses[rows, 1] for snapshot in moved]
    hop = float(np.ptp(heights, axis=0).max())
    report.check(61, 'boxes drawn by a winch, hop', hop, 0.0, 8e-6, 'm')
    for snapshot in moved:
        ratio = float(snapshot.twists[rows, 0].min()) / speed
        report.check(61, 'boxes drawn by a winch, speed', ratio, 1.0, 1e-7, '–')


def car(share):
    """Return a car with a share of the torque at which its front bears no weight, and that [N]."""
    radius, base, height, mass, wheel = 0.3, 1.6, 0.6, 10.0, 0.5
    moment = wheel * radius**2 / 2
    load = mass * base / 2 + wheel * base
    most = G * load / (mass * height + 2 * wheel * radius + 2 * moment / radius)
    torque = (mass + 2 * wheel + 2 * moment / radius**2) * most * radius
    sim = simulation(elasticity=0.0, friction=3.0)
    floor(sim)
    spawn(sim, 'car/0', Box(width=2.0, height=0.3), (0, height, 0), mass=mass, group=1)
    for number, x in enumerate((-base / 2, base / 2)):
        pose = (x, radius, 0.0)
        spawn(sim, f'wheel/{number}', Disc(radius=radius), pose, mass=wheel, group=1)
    said = {'rate': -1000.0, 'max_torque': torque * share}
    join(sim, 'motor/0', 'motor', [(-base / 2, radius)], a='wheel/0', b='car/0', **said)
    join(sim, 'axle/0', 'axle', [(base / 2, radius)], a='wheel/1', b='car/0')
    return sim, (mass / 2 + wheel) * G


@pytest.mark.parametrize(
    ('share', 'lifts'), [(0.5, False), (0.9, False), (1.04, True), (1.6, True)]
)
def test_a_car_lifts_its_front_above_a_torque(report, share, lifts):
    sim, weight = car(share)
    sim.reports_contacts = True

    frames = [sim.advance_frame() for _ in range(36)]

    pitch = frames[-1].snapshot.poses[1, 2]
    names = frames[-1].snapshot.scene.names
    front = sum(
        impulse[1]
        for frame in frames[6:]
        for (_, other), impulse in zip(frame.contacts.pairs, frame.contacts.impulses, strict=True)
        if names[other] == 'wheel/1'
    ) / (30 / 60)
    if lifts:
        assert pitch > 0.05
        assert front == 0.0
    else:
        what = 'car that accelerates, force of the floor on its front wheel'
        report.check(61, what, front, (1 - share) * weight, 0.02, 'N', relative=True)
        report.check(61, 'car that accelerates, pitch', pitch, 0.0, 1e-3, 'rad')


def ladder(share):
    """Lean a ladder at a smooth wall, at a share of its limit; return that, and its middle [m]."""
    friction, length, width = 0.4, 4.0, 0.05
    angle = math.atan(2 * friction * share)
    sin, cos = math.sin(angle), math.cos(angle)
    at = ((length * sin + width * cos) / 2, (length * cos + width * sin) / 2)
    sim = simulation(elasticity=0.0, friction=friction)
    floor(sim)
    wall = Box(width=1.0, height=20.0)
    spawn(sim, 'wall/0', wall, (-0.5, 10.0, 0.0), anchored=True, friction=0.0)
    shape = Box(width=width, height=length)
    spawn(sim, 'ladder/0', shape, (*at, angle), mass=10.0, group=1)
    return sim, at


@pytest.mark.parametrize('ornament', ORNAMENTS)
@pytest.mark.parametrize('share', [0.8, 0.95])
def test_a_ladder_stands_below_its_limit(report, share, ornament):
    sim, at = ladder(share)
    _add(ornament, sim, 'ladder/0', at)

    sunk = at[1] - run(sim, 3.0).poses[2, 1]

    report.check(61, f'ladder at {share} of its limit, sink in 3 s', sunk, 0.0, SETTLED, 'm')


def stepladder(share):
    """Return a stepladder that stands at a share of its limit, by friction alone."""
    friction, length, width = 0.4, 2.0, 0.04
    angle = math.atan(2 * friction * share)
    sin, cos = math.sin(angle), math.cos(angle)
    top = length * cos + width / 2 * sin
    sim = simulation(elasticity=0.0, friction=friction)
    floor(sim)
    for number, side in enumerate((-1, 1)):
        pose = (side * length / 2 * sin, top - length / 2 * cos, side * angle)
        spawn(sim, f'side/{number}', Box(width=width, height=length), pose, mass=5.0, group=1)
    join(sim, 'top/0', 'axle', [(0.0, top)], a='side/0', b='side/1')
    return sim


@pytest.mark.parametrize(
    ('share', 'stands'), [(0.8, True), (0.9, True), (0.98, True), (1.05, False)]
)
def test_a_stepladder_stands_below_its_limit(share, stands):
    sim = stepladder(share)
    height = sim.world.snapshot().poses[-1, 1]

    sunk = height - run(sim, 3.0).poses[-1, 1]

    assert sunk < 1e-3 if stands else sunk > 0.1


# https://en.wikipedia.org/wiki/Drum_brake#Self-applying_characteristic
@pytest.mark.parametrize('sense', [1, -1], ids=['leading', 'trailing'])
def test_a_brake_shoe_slows_a_drum_by_its_lever(report, sense):
    friction, offset, force = 0.6, 0.3, 40.0
    sim = simulation(elasticity=0.0, friction=friction)
    row = spawn(sim, 'drum/0', Disc(radius=0.5), mass=40.0, spin=20.0 * sense)
    load = {'force': (0.0, -force), 'at': (0.6, 0.0)}
    lever = Box(width=1.2, height=0.1)
    spawn(sim, 'lever/0', lever, (0.0, 0.55, 0.0), mass=1.0, group=1, forces=(load,))
    join(sim, 'axle/0', 'axle', [(0.0, 0.0)], a='drum/0', b='world')
    join(sim, 'axle/1', 'axle', [(-0.6, 0.5 + offset)], a='lever/0', b='world')

    before = run(sim, 0.1).twists[row, 2]
    slowed = abs(before - run(sim, 0.4).twists[row, 2]) / 0.4

    normal = (1.2 * force + 0.6 * G) / (0.6 - sense * friction * offset)
    what = 'brake shoe, leading and trailing, deceleration of the drum'
    report.check(61, what, slowed, friction * normal * 0.5 / 5.0, 0.01, 'rad/s²', relative=True)


@pytest.mark.parametrize(('share', 'holds'), [(0.6, True), (0.8, True), (1.1, False)])
def test_a_strut_locks_itself_below_its_angle_of_friction(share, holds):
    friction = 0.5
    angle = math.atan(friction * share)
    sin, cos = math.sin(angle), math.cos(angle)
    sim = simulation(elasticity=0.0, friction=friction)
    spawn(sim, 'wall/0', Box(width=1.0, height=6.0), (-0.5, 0.0, 0.0), anchored=True)
    row = spawn(sim, 'box/0', Box(width=0.3, height=0.6), (0.15, 0.0, 0.0), mass=20.0)
    pose = (0.3 + cos / 2, -sin / 2, math.pi - angle)
    spawn(sim, 'strut/0', Box(width=1.0, height=0.02), pose, mass=1.0)
    join(sim, 'axle/0', 'axle', [(0.3 + cos, -sin)], a='strut/0', b='world')

    sunk = -run(sim, 1.0).poses[row, 1]

    assert sunk < 2e-3 if holds else sunk > 0.5


def _arc(center, radius, begin, end):
    """Return points of an arc, (200, 2) [m]."""
    angles = np.linspace(begin, end, 200)
    return np.stack([center + radius * np.cos(angles), radius * np.sin(angles)], axis=1)


def test_a_belt_turns_the_driven_wheel_by_the_ratio_of_radii(report):
    thickness, small, large, distance = 0.02, 0.3, 0.6, 2.0
    tilt = math.asin((large - small) / distance)
    driver = _arc(0.0, small + thickness / 2, math.pi / 2 + tilt, 3 * math.pi / 2 - tilt)
    driven = _arc(distance, large + thickness / 2, -math.pi / 2 - tilt, math.pi / 2 + tilt)
    loop = np.vstack([driver, driven, driver[:1]])
    ways = np.r_[0.0, np.cumsum(np.hypot(*np.diff(loop, axis=0).T))]
    at = np.linspace(0.0, ways[-1], round(ways[-1] / 0.09) + 1)
    points = [
        (float(np.interp(way, ways, loop[:, 0])), float(np.interp(way, ways, loop[:, 1])))
        for way in at
    ]
    sim = simulation(gravity=(0.0, 0.0), elasticity=0.0, friction=0.6)
    spawn(sim, 'driver/0', Disc(radius=small), mass=1.0)
    row = spawn(sim, 'driven/0', Disc(radius=large), (distance, 0.0, 0.0), mass=1.0)
    for number, (start, end) in enumerate(itertools.pairwise(points)):
        middle = ((start[0] + end[0]) / 2, (start[1] + end[1]) / 2)
        pose = (*middle, math.atan2(end[1] - start[1], end[0] - start[0]))
        link = Box(width=math.dist(start, end), height=thickness)
        spawn(sim, f'link/{number}', link, pose, mass=0.01, group=1)
    said = {'rate': 5.0, 'max_torque': 1000.0}
    join(sim, 'motor/0', 'motor', [(0.0, 0.0)], a='driver/0', b='world', **said)
    join(sim, 'axle/0', 'axle', [(distance, 0.0)], a='driven/0', b='world')
    count = len(points) - 1
    for number, point in enumerate(points[:-1]):
        a, b = f'link/{(number - 1) % count}', f'link/{number}'
        join(sim, f'joint/{number}', 'axle', [point], a=a, b=b)

    # Means of half a second: the links are a polygon, by which the wheels tremble.
    run(sim, 0.5)
    spins = np.array([run(sim, 1 / 60).twists[[0, row], 2] for _ in range(30)]).mean(axis=0)

    exact = (small + thickness / 2) / (large + thickness / 2)
    what = 'belt over wheels of 0.3 and 0.6 m, ratio of spins'
    report.check(61, what, spins[1] / spins[0], exact, 0.03, '1', relative=True)
