# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Laws 44 to 47: clay, momentum of impacts in flight, pressure of a gas, and thin bodies."""

import itertools
import math
import random

import numpy as np
from physsim_ros.model.shapes import Box, Chain, Disc, Polygon
import pytest

from .scenes import cross, DT, floor, G, NOWHERE, run, simulation, spawn, steps, turned
from ..slow import slow

# Ratio of masses [1] and height of the fall [m].
CLAY = [*itertools.product((5.0, 10.0, 30.0, 100.0), (0.3, 1.0, 3.0)), (200.0, 10.0)]


@pytest.mark.parametrize(('ratio', 'height'), CLAY)
def test_clay_does_not_rise_from_a_light_plate(report, ratio, height):
    sim = simulation(elasticity=0.0)
    floor(sim)
    spawn(sim, 'plate/0', Box(width=1.0, height=0.2), (0.0, 0.1, 0.0), mass=1.0)
    clay = spawn(sim, 'clay/0', Disc(radius=0.3), (0.0, 0.5 + height, 0.0), mass=ratio)

    lowest, rise = math.inf, 0.0
    for now in steps(sim, round((math.sqrt(2 * height / G) + 1.0) / DT)):
        lowest = min(lowest, now.poses[clay, 1])
        rise = max(rise, now.poses[clay, 1] - lowest)

    what = f'clay on a plate, {ratio:g} : 1'
    report.check(44, f'{what}, rise after the impact', rise, 0.0, 2e-3, 'm')
    report.check(44, f'{what}, depth in plate and floor', 0.5 - lowest, 0.0, 0.01, 'm')


FRICTIONS = ELASTICITIES = (0.0, 0.5, 1.0)


def round_shape(pick):
    """Return a disc."""
    return Disc(radius=pick.uniform(0.1, 0.3))


def angular_shape(pick):
    """Return a box, or a polygon of three to six corners on a circle."""
    size = pick.uniform(0.1, 0.3)
    if pick.random() < 0.5:
        return Box(width=2 * size, height=size * pick.uniform(0.3, 2.0))
    count = pick.randint(3, 6)
    angles = [2 * math.pi * number / count + pick.uniform(0.0, 0.5) for number in range(count)]
    return Polygon(outline=tuple(tuple(turned((size, 0.0), angle)) for angle in angles))


def pair_in_flight(pick, shapes, **settings):
    """Return a world in which two random bodies fly at each other, and their approach [m/s]."""
    sim, approach = simulation(**settings), 0.0
    for name, side, shape in zip('ab', (-1.0, 1.0), shapes, strict=True):
        speed = pick.uniform(1.0, 20.0)
        approach += speed
        spawn(
            sim,
            f'{name}/0',
            shape(pick),
            (side, pick.uniform(-0.1, 0.1), pick.uniform(0.0, 2 * math.pi)),
            mass=10 ** pick.uniform(-1.0, 1.0),
            velocity=(-side * speed, pick.uniform(-1.0, 1.0)),
            spin=pick.uniform(-20.0, 20.0),
            friction=pick.choice(FRICTIONS),
            elasticity=pick.choice(ELASTICITIES),
        )
    return sim, approach


def angular_momentum(snapshot):
    """Return it about the common centre of mass, spin included [kg m²/s]."""
    mass, moment = snapshot.scene.inertia.T
    arms = snapshot.centers - mass @ snapshot.centers / mass.sum()
    path = cross(arms.T, snapshot.twists[:, :2].T)
    return float((mass * path + moment * snapshot.twists[:, 2]).sum())


PAIRS = {
    'discs': (round_shape, round_shape),
    'disc and polygon': (round_shape, angular_shape),
    'polygons': (angular_shape, angular_shape),
}
# By how far beside its point an impulse may act, as a share of the way of the approach in a step
# [1]. An impact is timed to first order within a sub-step, a quarter of a step: bodies that turn
# or slip on each other go on along another line than that on which they came. Of discs it is the
# fall within a sub-step that counts.
BESIDE = {'discs': 0.001, 'disc and polygon': 0.1, 'polygons': 0.25}


@pytest.mark.parametrize('seeds', [range(30), slow(range(30, 400))], ids=['30', '370'])
@pytest.mark.parametrize('kinds', PAIRS.keys())
def test_an_impact_in_flight_keeps_momentum_and_angular_momentum(report, kinds, seeds):
    hits = 0
    for seed in seeds:
        sim, approach = pair_in_flight(random.Random(seed), PAIRS[kinds])
        sim.reports_contacts = True
        start = sim.world.snapshot()
        mass = start.scene.inertia[:, 0]
        total = float(mass @ np.hypot(*start.twists[:, :2].T))
        reduced = mass.prod() / mass.sum()
        hit = False
        for number in range(1, 31):
            frame = sim.advance_frame()
            now = frame.snapshot
            touches = len(frame.contacts.pairs) > 0
            hit = hit or touches
            fall = G * mass.sum() * number / 60
            exact = (start.momentum[0], start.momentum[1] - fall)
            off = math.dist(now.momentum, exact)
            if touches:
                # While bodies touch, their reported velocity leads by half a sub-step.
                share = off / (mass.sum() * G * DT)
                report.check(45, f'{kinds}, momentum in touch', share, 0.0, 0.126, 'm g dt')
            else:
                report.check(45, f'{kinds}, momentum', off / total, 0.0, 1e-9, '–')
            off = abs(angular_momentum(now) - angular_momentum(start))
            beside = off / (reduced * approach**2 * DT)
            what = f'{kinds}, angular momentum: impulse beside its point'
            report.check(45, what, beside, 0.0, BESIDE[kinds], 'ways')
        hits += hit
    assert hits > 0.9 * len(seeds)


@pytest.mark.parametrize('kinds', PAIRS.keys())
def test_an_impact_leaves_of_momentum_and_angular_momentum_what_damping_does(report, kinds):
    for seed in range(20):
        pick = random.Random(seed)
        sim, approach = pair_in_flight(pick, PAIRS[kinds], gravity=NOWHERE, damping=0.99)
        start = sim.world.snapshot()
        mass = start.scene.inertia[:, 0]
        total = float(mass @ np.hypot(*start.twists[:, :2].T))
        for number, now in enumerate(steps(sim, 120), 1):
            kept = 0.01 ** (number * DT)
            off = math.dist(now.momentum, np.multiply(start.momentum, kept))
            report.check(45, f'damped {kinds}, momentum', off / total, 0.0, 1e-9, '–')
        off = abs(angular_momentum(now) - kept * angular_momentum(start))
        beside = off / (mass.prod() / mass.sum() * approach**2 * DT)
        report.check(45, f'damped {kinds}, angular momentum', beside, 0.0, BESIDE[kinds], 'ways')


def walled(inside, elasticity=1.0):
    """Return a world without gravity and friction, and a room of so many metres in x from 0."""
    sim = simulation(gravity=NOWHERE, friction=0.0, elasticity=elasticity)
    for number, x in enumerate((-0.5, inside + 0.5)):
        spawn(sim, f'wall/{number}', Box(width=1.0, height=20.0), (x, 0.0, 0.0), anchored=True)
    sim.reports_contacts = True
    return sim


# Room of a ball [m] and its speed [m/s]. In a sub-step, a quarter of a step, it meets one wall:
# the room is at least its way in a sub-step.
ROOMS = [
    *itertools.product((0.4, 4.0), (3.0, 10.0, 20.0, 30.0, 60.0)),
    *itertools.product((0.05,), (3.0, 10.0, 20.0, 40.0)),
]


def corner_impact(size, speed, spin, elasticity):
    """
    Let a smooth box that turns hit a plane with a corner, from a height of 1 m.

    :return: its velocity along the normal [m/s] and its spin [rad/s] after that, of a rigid body
    """
    corners = [(x * size[0] / 2, y * size[1] / 2) for x in (-1, 1) for y in (-1, 1)]

    def lowest(time):
        return min((turned(corner, spin * time) for corner in corners), key=lambda place: place[1])

    low, high = 0.0, 1.0 / speed
    while high - low > 1e-12:
        time = (low + high) / 2
        low, high = (time, high) if 1.0 - speed * time + lowest(time)[1] > 0.0 else (low, time)
    arm = lowest(low)[0]
    moment = (size[0] ** 2 + size[1] ** 2) / 12
    impulse = (1.0 + elasticity) * (speed - spin * arm) / (1.0 + arm**2 / moment)
    return impulse - speed, spin + impulse * arm / moment


@pytest.mark.parametrize('tiles', [1, 200])
@pytest.mark.parametrize(('speed', 'spin'), [(3.0, 10.0), (10.0, -20.0), (30.0, 20.0)])
def test_a_corner_bounces_where_it_first_meets_a_floor(report, speed, spin, tiles):
    size, elasticity, width = (0.5, 0.3), 0.5, 4.0 / tiles
    sim = simulation(gravity=NOWHERE, elasticity=elasticity, friction=0.0)
    for number in range(tiles):
        x = (number + 0.5) * width - 2.0
        spawn(sim, f'tile/{number}', Box(width=width, height=0.2), (x, -0.1, 0.0), anchored=True)
    said = {'velocity': (0.0, -speed), 'spin': spin}
    box = spawn(sim, 'box/0', Box(width=size[0], height=size[1]), (0.003, 1.0, 0.0), **said)

    after = next(now for now in steps(sim, round(2.0 / DT)) if now.twists[box, 2] != spin)

    exact = corner_impact(size, speed, spin, elasticity)
    what = f'corner at {speed:g} m/s, {spin:g} rad/s'
    report.check(6, f'{what}, velocity', after.twists[box, 1], exact[0], 1e-3 * speed, 'm/s')
    report.check(6, f'{what}, spin', after.twists[box, 2], exact[1], 1e-3 * abs(spin), 'rad/s')


@pytest.mark.parametrize(('gap', 'speed'), ROOMS)
def test_a_ball_between_walls_goes_the_way_of_its_reported_velocity(report, gap, speed):
    radius, seconds = 0.05, 5.0
    sim = walled(gap + 2 * radius)
    disc, place = Disc(radius=radius), (radius + gap / 2, 0.0, 0.0)
    ball = spawn(sim, 'ball/0', disc, place, mass=1.0, velocity=(speed, 0.0))

    impulse = 0.0
    for _ in range(round(seconds * 60)):
        frame = sim.advance_frame()
        impulse += float(np.abs(frame.contacts.impulses[:, 0]).sum())
        now = frame.snapshot
        report.check(46, 'ball between walls, speed', abs(now.twists[ball, 0]), speed, 1e-6, 'm/s')

    # From the impacts, where it is and where it heads, follows which way it has gone.
    impacts = round(impulse / (2 * speed))
    exact = 2 * speed * impacts
    report.check(46, 'ball between walls, impulse', impulse, exact, 1e-6, '–', relative=True)
    place = now.poses[ball, 0] - radius
    assert (now.twists[ball, 0] > 0) == (impacts % 2 == 0)
    way = impacts * gap + (place if impacts % 2 == 0 else gap - place) - gap / 2
    what = f'ball between walls {gap:g} m apart, way'
    report.check(46, what, way, speed * seconds, 0.01, '–', relative=True)


@pytest.mark.parametrize('length', [0.2, 1.0])
def test_the_pressure_of_a_gas_is_that_of_its_speeds(report, length):
    pick, radius, count, seconds = random.Random(1), 0.01, 30, 5.0
    sim = walled(length)
    free, mass = length - 2 * radius, 0.01
    exact = 0.0
    for number in range(count):
        speed, place = pick.uniform(5.0, 60.0), pick.uniform(0.0, free)
        # Discs of one group pass through each other: an ideal gas.
        pose = (radius + place, 0.3 * (number - count / 2), 0.0)
        said = {'mass': mass, 'velocity': (speed, 0.0), 'group': 1}
        spawn(sim, f'disc/{number}', Disc(radius=radius), pose, **said)
        exact += 2 * mass * speed * math.floor((place + speed * seconds) / free)

    impulse = 0.0
    for _ in range(round(seconds * 60)):
        impulse += float(np.abs(sim.advance_frame().contacts.impulses[:, 0]).sum())

    what = f'gas between walls {length:g} m apart, force'
    report.check(46, what, impulse / seconds, exact / seconds, 0.01, 'N', relative=True)


def thin_shape(pick):
    """Return a plank or a triangle of 10 to 50 cm, 1 to 10 cm thick, and its corners."""
    length, thickness = pick.uniform(0.1, 0.5), pick.uniform(0.01, 0.05)
    if pick.random() < 0.5:
        plank = Box(width=length, height=thickness)
        return plank, plank.corners()
    tip = (pick.uniform(-length / 2, length / 2), 2 * thickness)
    triangle = Polygon(outline=((-length / 2, 0.0), (length / 2, 0.0), tip))
    return triangle, triangle.outline


def throw(pick):
    """
    Throw a thin body of elasticity 0 at a wall of 1 or 2 cm that stands, or comes towards it.

    :return: the least distance of its corners from the middle of the wall at the end, of its
        centre at any time, and half the thickness of the wall [m]
    """
    sim = simulation(gravity=NOWHERE, elasticity=0.0)
    thickness = pick.choice((0.01, 0.02))
    slab = Box(width=thickness, height=40.0)
    line = Chain(points=((0.0, -20.0), (0.0, 20.0)), thickness=thickness)
    wall = pick.choice((slab, line))
    pushed = pick.random() < 0.3
    push = pick.uniform(0.0, 30.0) if pushed else 0.0
    spawn(sim, 'wall/0', wall, anchored=not pushed, kinematic=pushed, velocity=(push, 0.0))
    shape, points = thin_shape(pick)
    speed = pick.uniform(5.0, 40.0)
    row = spawn(
        sim,
        'thin/0',
        shape,
        (1.0, 0.0, pick.uniform(0.0, 2 * math.pi)),
        velocity=(-speed, pick.uniform(-0.5, 0.5) * speed),
        spin=pick.uniform(-30.0, 30.0),
        friction=pick.choice(FRICTIONS),
    )
    least = math.inf
    for now in steps(sim, round(0.5 / DT)):
        least = min(least, now.centers[row, 0] - now.poses[0, 0])
    pose = now.poses[row]
    nearest = min(pose[0] + turned(point, pose[2])[0] for point in points)
    return nearest - now.poses[0, 0], least, thickness / 2


@pytest.mark.parametrize('seeds', [range(30), slow(range(30, 560))], ids=['30', '530'])
def test_a_thin_body_of_elasticity_0_never_passes_a_wall(report, seeds):
    passed, deepest = 0, -math.inf
    for seed in seeds:
        nearest, center, half = throw(random.Random(seed))
        passed += nearest < 0.0 or center < 0.0
        deepest = max(deepest, half - nearest)
    report.check(47, 'thin bodies at walls of 1 to 2 cm, passed', passed, 0, 0, 'bodies')
    report.check(47, 'the same, depth at the end', max(deepest, 0.0), 0.0, 0.004, 'm')


@pytest.mark.parametrize('thickness', [0.01, 0.02])
@pytest.mark.parametrize('height', [12.0, 20.0, 46.0])
def test_a_plank_that_falls_from_high_stays_on_a_thin_floor(report, height, thickness):
    sim = simulation()
    ground = Box(width=200.0, height=thickness)
    spawn(sim, 'floor/0', ground, (0.0, -thickness / 2, 0.0), anchored=True)
    plank = Box(width=0.4, height=0.05)
    row = spawn(sim, 'plank/0', plank, (0.0, height, 0.07), elasticity=0.0)

    end = run(sim, math.sqrt(2 * height / G) + 1.0)

    report.check(47, 'plank on a thin floor, height', end.poses[row, 1], 0.025, 0.002, 'm')


def test_what_rests_is_not_moved_by_what_flies_at_it(report):
    sim = simulation(gravity=NOWHERE)
    bar = Box(width=4.0, height=0.05)
    spawn(sim, 'bar/0', bar, kinematic=True, spin=300.0)
    for number in range(40):
        place = turned((1.9, 0.0), math.pi * (0.02 + 0.96 * number / 39))
        spawn(sim, f'disc/{number}', Disc(radius=0.03), (*place, 0.0), mass=0.01)

    last = sim.world.snapshot()
    for now in steps(sim, 36):
        way = np.hypot(*(now.poses[1:, :2] - last.poses[1:, :2]).T)
        speeds = [np.hypot(*each.twists[1:, :2].T) for each in (last, now)]
        resting = np.maximum(*speeds) < 0.01
        if resting.any():
            most = float(way[resting].max())
            report.check(47, 'disc at rest before a bar, moved in a step', most, 0.0, 1e-3, 'm')
        last = now

    missed = int((speeds[1] < 1.0).sum())
    report.check(47, 'discs before a bar, missed', missed, 0, 0, 'discs')


@pytest.mark.parametrize('shift', [0.0, 1e-9, 1e-3])
@pytest.mark.parametrize('elasticity', ELASTICITIES)
def test_triangles_that_meet_tip_to_tip_part_again(report, elasticity, shift):
    sim = simulation(gravity=NOWHERE, friction=0.0, elasticity=elasticity)
    triangle = Polygon(outline=((-0.2, 0.0), (0.2, 0.0), (0.0, 0.1)))
    for name, side in (('a', -1.0), ('b', 1.0)):
        place = (side, shift if side > 0 else 0.0, 0.0)
        spawn(sim, f'{name}/0', triangle, place, velocity=(-40.0 * side, 0.0))
    start = sim.world.snapshot()

    met = run(sim, 0.05)
    end = run(sim, 0.2)

    apart = end.centers[1] - end.centers[0]
    way = apart - (met.centers[1] - met.centers[0])
    exact = (met.twists[1, :2] - met.twists[0, :2]) * 0.2
    report.check(47, 'triangles tip to tip, way after the impact', math.dist(way, exact), 0.0,
                 1e-6, 'm')  # fmt: skip
    assert np.hypot(*apart) > 5.0
    gained = end.kinetic_energy / start.kinetic_energy - 1
    report.check(47, 'triangles tip to tip, energy gained', max(gained, 0.0), 0.0, 0.01, '–')
