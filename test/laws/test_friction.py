# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Laws 10 to 13, 77, 78: friction holds, brakes, tips and sets rolling by Coulomb's law."""

import math

import numpy as np
from physsim_ros.model.requests import Command
from physsim_ros.model.shapes import Box, Disc, Polygon
import pytest

from .scenes import floor, G, run, simulation, spawn, turned


def on_incline(shape, height, degrees, **settings):
    """
    Lay a body on an incline that falls to the left.

    :param height: of its centre above the incline [m]
    :return: the simulation, and the unit vector downhill
    """
    sim, angle = simulation(**settings), math.radians(degrees)
    floor(sim, angle=angle)
    spawn(sim, 'body/0', shape, (*turned((0.0, height), angle), angle))
    return sim, turned((-1.0, 0.0), angle)


def _slides(box, degrees):
    """Tell whether a block is on its way 5 s after it has been put down."""
    sim, downhill = on_incline(box, box.height / 2, degrees)
    at_4 = run(sim, 4.0).poses[1, :2]
    return (run(sim, 1.0).poses[1, :2] - at_4) @ downhill > 1e-6


BOXES = [Box(width=1.0, height=1.0), Box(width=0.3, height=0.3), Box(width=2.0, height=0.5)]


@pytest.mark.parametrize('box', BOXES, ids=repr)
def test_a_block_slides_from_the_angle_whose_tangent_is_its_friction(report, box):
    exact = math.degrees(math.atan(0.5))
    sticks, slides = exact - 0.1, exact + 0.1
    assert not _slides(box, sticks)
    assert _slides(box, slides)
    for _ in range(5):
        middle = (sticks + slides) / 2
        if _slides(box, middle):
            slides = middle
        else:
            sticks = middle

    report.check(10, 'incline, friction 0.5, sliding begins', slides, exact, 0.1, '°')


@pytest.mark.parametrize('degrees', [10, 20, 26])
def test_a_block_that_sticks_does_not_creep(report, degrees):
    sim, downhill = on_incline(BOXES[0], 0.5, degrees)
    settled = run(sim, 1.0).poses[1, :2]

    crept = (run(sim, 10.0).poses[1, :2] - settled) @ downhill

    report.check(10, 'incline, friction 0.5, creep in 10 s', crept, 0.0, 1e-6, 'm')


@pytest.mark.parametrize('box', BOXES, ids=repr)
@pytest.mark.parametrize('degrees', [27, 35, 45, 60])
def test_a_block_that_slides_has_the_acceleration_of_the_formula(report, degrees, box):
    sim, downhill = on_incline(box, box.height / 2, degrees)

    first = run(sim, 0.5).twists[1, :2] @ downhill
    last = run(sim, 1.0).twists[1, :2] @ downhill

    angle = math.radians(degrees)
    exact = G * (math.sin(angle) - 0.5 * math.cos(angle))
    report.check(11, f'sliding down {degrees}°, friction 0.5', last - first, exact, 1e-4, 'm/s²')


@pytest.mark.parametrize('degrees', [0, 20])
def test_a_block_at_rest_slides_as_far_whenever_its_velocity_is_set(report, degrees):
    distances = []
    for number in range(8):
        sim, downhill = on_incline(BOXES[0], 0.5, degrees)
        sim.world.step(240 + number)
        before = sim.world.snapshot().poses[1, :2]
        # The velocity along an incline is rounded, so that it may lift the block.
        away = 1e-9 * (number % 2) * turned(downhill, -math.pi / 2)
        sim.perform(Command(names=('body/0',), twists=((*(away - 0.05 * downhill), 0.0),)))
        sim.world.step(24)
        distances.append((before - sim.world.snapshot().poses[1, :2]) @ downhill)

    off = np.ptp(distances) / np.mean(distances)
    report.check(11, 'block set sliding, difference of distances', off, 0.0, 2e-3, '–')


@pytest.mark.parametrize('radius', [0.05, 0.5, 2.0])
@pytest.mark.parametrize('degrees', [5, 20, 40])
def test_a_disc_rolls_down_with_two_thirds(report, degrees, radius):
    sim, downhill = on_incline(Disc(radius=radius), radius, degrees)

    first = run(sim, 0.5).twists[1]
    last = run(sim, 1.0).twists[1]

    exact = 2 / 3 * G * math.sin(math.radians(degrees))
    measured = (last - first)[:2] @ downhill
    report.check(12, f'disc rolling down {degrees}°', measured, exact, 1e-9, 'm/s²')
    slip = last[:2] @ downhill - last[2] * radius
    report.check(12, 'disc rolling, slip', slip, 0.0, 1e-9, 'm/s')


@pytest.mark.parametrize('elasticity', [0.5, 0.0])
def test_a_disc_that_rolls_on_a_floor_goes_on_for_ever(report, elasticity):
    sim = simulation(elasticity=elasticity)
    floor(sim)
    disc = spawn(sim, 'disc/0', Disc(radius=0.5), (0.0, 0.5, 0.0), velocity=(0.05, 0.0), spin=-0.1)

    end = run(sim, 10.0)

    report.check(12, 'disc rolling on a floor at 5 cm/s', end.twists[disc, 0], 0.05, 1e-9, 'm/s')


@pytest.mark.parametrize('radius', [0.1, 0.5])
@pytest.mark.parametrize('speed', [2.0, 5.0])
def test_a_disc_that_slides_comes_to_roll_at_two_thirds_of_its_speed(report, speed, radius):
    sim = simulation(friction=0.3)
    floor(sim)
    disc = spawn(sim, 'disc/0', Disc(radius=radius), (0.0, radius, 0.0))
    run(sim, 1.0)
    sim.perform(Command(names=('disc/0',), twists=((speed, 0.0, 0.0),)))

    rolls_at = None
    for step in range(2 * 240):
        sim.world.step(1)
        vx, _, spin = sim.world.snapshot().twists[disc]
        if rolls_at is None and abs(vx + spin * radius) < 1e-6:
            rolls_at = (step + 1) / 240

    exact = speed / (3 * 0.3 * G)
    report.check(13, 'disc set sliding, rolls after', rolls_at, exact, 0.02, 's/s', relative=True)
    vx = sim.world.snapshot().twists[disc, 0]
    report.check(13, 'the same, speed then', vx, speed * 2 / 3, 1e-3, '–', relative=True)


@pytest.mark.parametrize('width', [0.1, 0.5])
@pytest.mark.parametrize('friction', [0.9, 1.4, 2.0, 3.0])
def test_a_box_tips_about_its_corner_whatever_the_friction(report, friction, width):
    box = Box(width=width, height=1.0)
    degrees = 1.5 * math.degrees(math.atan(box.width / box.height))
    ground, said = math.radians(degrees), {'friction': friction, 'elasticity': 0.0}
    sim, _ = on_incline(box, box.height / 2, degrees, **said)
    depth, kept, fallen = 0.0, None, 0.0
    begin = sim.world.snapshot().potential_energy
    while fallen < 1.2:
        sim.world.step(1)
        now = sim.world.snapshot()
        x, y, yaw = now.poses[1]
        fallen = abs(yaw - ground)
        height = turned((x, y), -ground)[1]
        below = box.width / 2 * math.sin(fallen) + box.height / 2 * math.cos(fallen)
        depth = max(depth, below - height)
        if kept is None and fallen > 0.5:
            kept = now.kinetic_energy / (begin - now.potential_energy)

    what = f'box of {width} m tips, friction {friction}'
    report.check(78, f'{what}, depth of its corner', depth, 0.0, 1e-4, 'm')
    report.check(78, f'{what}, energy', kept, 1.0, 5e-3, '–')


@pytest.mark.parametrize(('count', 'spin'), [(12, 3.0), (24, 3.0), (24, 2.0), (48, 3.0)])
def test_a_regular_polygon_that_rolls_loses_energy_at_its_corners_alone(report, count, spin):
    """It turns about a corner until the next one hits the floor, and keeps the spin about that."""
    radius, angle = 0.5, math.tau / count
    turns = [angle * (number + 0.5) - math.pi / 2 for number in range(count)]
    outline = tuple((radius * math.cos(turn), radius * math.sin(turn)) for turn in turns)
    height, aside = radius * math.cos(angle / 2), radius * math.sin(angle / 2)
    sim = simulation(friction=1.0, elasticity=0.0)
    floor(sim)
    velocity = (spin * height, spin * aside)
    said = {'velocity': velocity, 'spin': -spin}
    wheel = spawn(sim, 'wheel/0', Polygon(outline=outline), (0.0, height, 0.0), **said)
    mass, moment = sim.world.snapshot().scene.inertia[wheel]

    end = run(sim, 2.0)

    hits = math.floor(-end.poses[wheel, 2] / angle)
    about_corner = moment + mass * radius**2
    kept = (moment + mass * radius**2 * math.cos(angle)) / about_corner
    (*along, turning), rise = end.twists[wheel], end.centers[wheel, 1] - height
    left = (mass * np.dot(along, along) + moment * turning**2) / 2 + mass * G * rise
    share = left / (about_corner * spin**2 / 2)
    report.check(77, 'polygon that rolls, energy', share, kept ** (2 * hits), 2e-3, '–')
