# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Laws 37 to 41: what lies on a floor slides to a stop; robots drive, stall and push on it."""

import math

import numpy as np
from physsim_ros.model.requests import Delete, DriveRobot
from physsim_ros.model.shapes import Box, Chain, Compound, contains, Disc, Polygon
import pytest

from .scenes import DT, G, NOWHERE, simulation, spawn, steps, turned
from ..building import sleepers

# Of all floors here.
MU = 0.5
BURGER, BOX = Disc(radius=0.105), Box(width=0.2, height=0.2)
DRIVE = {'kind': 'differential', 'track': 0.16, 'max_turn': 3.0, 'traction': 0.8, 'timeout': 0.0}
FULL_TURN = math.tau


def _floor(**settings):
    return simulation(gravity=NOWHERE, floor_friction=MU, **settings)


def _robot(sim, name='robot/0', pose=(0.0, 0.0, 0.0), *, shape=BURGER, mass=1.0, **changes):
    """Add a robot; return its row."""
    drive = {**DRIVE, **changes.pop('drive', {})}
    return spawn(sim, name, shape, pose, mass=mass, robot={'drive': drive, **changes})


def _drive(sim, *velocity, name='robot/0'):
    sim.perform(DriveRobot(name=name, velocity=velocity))


def _fleet(sim, count, *velocity, namespace='robot', **changes):
    """Add robots beside each other, and drive all at a velocity."""
    names = [f'{namespace}/{number}' for number in range(count)]
    for number, name in enumerate(names):
        _robot(sim, name, (0.0, float(number), 0.0), **changes)
    # Once all are there, so that their table is made once.
    for name in names:
        _drive(sim, *velocity, name=name)


def _after(sim, seconds):
    """Return the snapshot after a time [s]."""
    sim.world.step(round(seconds / DT))
    return sim.world.snapshot()


def _arc(start, speed, turn, seconds):
    """Return the pose after an arc from another one."""
    x, y, yaw = start
    if turn == 0.0:
        dx, dy = turned((speed * seconds, 0.0), yaw)
        return np.array([x + dx, y + dy, yaw])
    end = yaw + turn * seconds
    dx, dy = math.sin(end) - math.sin(yaw), math.cos(yaw) - math.cos(end)
    return np.array([x + speed / turn * dx, y + speed / turn * dy, end])


@pytest.mark.parametrize('speed', [0.05, 0.5, 2.0, 10.0])
@pytest.mark.parametrize('shape', [Disc(radius=0.2), Box(width=0.4, height=0.2)], ids=repr)
def test_a_body_slides_to_a_stop_and_stays_there(report, shape, speed):
    sim = _floor()
    spawn(sim, 'body/0', shape, (0.0, 0.0, 0.7), velocity=turned((speed, 0.0), 0.4).tolist())

    stopped = _after(sim, speed / (MU * G) + 2 * DT)
    way = math.hypot(*stopped.poses[0, :2])

    # The time of the stop lies within a step.
    report.check(37, 'sliding: way v²/(2 μ g)', way, speed**2 / (2 * MU * G), MU * G * DT**2, 'm')
    assert not stopped.twists.any()
    assert np.array_equal(_after(sim, 10.0).poses, stopped.poses)


def test_a_disc_that_only_spins_stops_by_the_friction_at_two_thirds_of_its_radius(report):
    radius, spin = 0.3, 10.0
    sim = _floor()
    spawn(sim, 'disc/0', Disc(radius=radius), mass=2.0, spin=spin)

    last = next(each for each in steps(sim, 240) if each.twists[0, 2] == 0.0)

    exact = spin * (radius**2 / 2) / (2 / 3 * MU * G * radius)
    report.check(37, 'spinning disc: time', last.step * DT, exact, DT, 's')


def test_what_turns_slides_further():
    ways = []
    for spin in (0.0, 3.0, 20.0):
        sim = _floor()
        spawn(sim, 'disc/0', Disc(radius=0.2), velocity=(1.0, 0.0), spin=spin)
        ways.append(_after(sim, 5.0).poses[0, 0])

    assert ways == sorted(ways)
    assert ways[2] > 1.5 * ways[0]


def test_sliding_and_turning_end_at_once(report):
    sim = _floor()
    spawn(sim, 'disc/0', Disc(radius=0.2), velocity=(1.0, 0.0), spin=8.0)

    slides, turns = [], []
    for each in steps(sim, 240):
        slides.append(bool(each.twists[0, :2].any()))
        turns.append(bool(each.twists[0, 2]))

    # A disc whose slip nears rest slides and turns at a ratio of its own (Goyal and others).
    report.check(37, 'sliding and turning end', sum(slides), sum(turns), 1, 'steps')


def test_a_body_at_rest_stays_and_sleeps():
    sim = _floor()
    spawn(sim, 'box/0', Box(width=0.3, height=0.3), (0.1, 0.2, 0.3))
    first = sim.world.snapshot()

    last = _after(sim, 5.0)

    assert np.array_equal(last.poses, first.poses)
    assert sleepers(sim.world) == ['box/0']


@pytest.mark.parametrize(('speed', 'turn'), [(0.2, 0.0), (0.2, 1.0), (-0.1, -2.8), (0.0, 2.0)])
def test_a_differential_drive_keeps_to_its_arc(report, speed, turn):
    sim = _floor()
    _robot(sim, pose=(1.0, -2.0, 0.6))
    _drive(sim, speed, 0.0, turn)
    # By then it is as fast as it was told.
    start = _after(sim, 1.0).poses[0]

    off = _after(sim, 10.0).poses[0] - _arc(start, speed, turn, 10.0)

    report.check(38, 'differential drive on its arc, 10 s', abs(off[:2]).max(), 0.0, 1e-6, 'm')
    report.check(38, 'differential drive, heading', abs(off[2]), 0.0, 1e-6, 'rad')


@pytest.mark.parametrize('slope', [0.0, 5.0, -12.0])
def test_a_robot_that_starts_on_an_arc_stays_on_it(report, slope):
    sim = _floor()
    _robot(sim)
    _drive(sim, 0.2, 0.0, 0.2 * slope)

    off = 0.0
    for each in steps(sim, 480):
        x, y, _ = each.poses[0]
        radius = math.hypot(x, y - 1 / slope) - abs(1 / slope) if slope else y
        off = max(off, abs(radius))

    report.check(38, 'differential drive, starting on its arc', off, 0.0, 1e-6, 'm')


def test_a_robot_starts_as_fast_as_its_wheels_accelerate(report):
    sim = _floor()
    _robot(sim, drive={'max_speed': 1.0, 'acceleration': 2.0})
    _drive(sim, 1.0, 0.0, 0.0)

    report.check(38, 'way of a start', _after(sim, 0.25).poses[0, 0], 2.0 * 0.25**2 / 2, 1e-9, 'm')


def test_a_robot_starts_no_faster_than_its_traction_allows(report):
    sim = _floor()
    _robot(sim, drive={'max_speed': 10.0, 'acceleration': 50.0})
    _drive(sim, 10.0, 0.0, 0.0)

    way = _after(sim, 0.5).poses[0, 0]

    report.check(38, 'way of a start with wheels that slip', way, 0.8 * G * 0.5**2 / 2, 1e-9, 'm')


def test_a_robot_whose_mass_is_before_its_axle_keeps_to_its_arc(report):
    outline = ((-0.1, -0.15), (0.5, -0.15), (0.5, 0.15), (-0.1, 0.15))
    sim = _floor()
    _robot(sim, shape=Polygon(outline=outline))
    _drive(sim, 0.2, 0.0, 0.5)
    start = _after(sim, 1.0).poses[0]

    off = _after(sim, 10.0).poses[0] - _arc(start, 0.2, 0.5, 10.0)

    report.check(38, 'differential drive on its arc, 10 s', abs(off[:2]).max(), 0.0, 1e-6, 'm')


def test_an_omni_drives_sideways_and_turns_at_once(report):
    sim = _floor()
    _robot(sim, drive={'kind': 'omni', 'max_speed': 1.0})
    _drive(sim, 0.3, 0.4, 1.0)
    start = _after(sim, 1.0)

    last = _after(sim, FULL_TURN)

    off = abs(last.poses[0] - start.poses[0] - (0.0, 0.0, round(FULL_TURN / DT) * DT)).max()
    # A whole number of steps is no full turn: 0.5 m/s over half a step.
    report.check(38, 'omni drive: a circle closes', off, 0.0, 0.5 * DT, 'm')
    speed = math.hypot(*last.twists[0, :2])
    report.check(38, 'omni drive: speed', speed, 0.5, 1e-9, 'm/s')


def test_a_car_turns_no_closer_than_it_steers(report):
    steering, base = 0.4, 0.3
    sim = _floor()
    _robot(sim, drive={'kind': 'car', 'wheelbase': base, 'steering': steering, 'max_speed': 0.5})
    _drive(sim, 0.3, 0.0, 3.0)
    start = _after(sim, 1.0).poses[0]

    off = _after(sim, 5.0).poses[0] - _arc(start, 0.3, 0.3 * math.tan(steering) / base, 5.0)

    report.check(38, 'car on its closest circle', abs(off).max(), 0.0, 1e-6, 'm')


def test_a_car_does_not_turn_in_place():
    sim = _floor()
    _robot(sim, drive={'kind': 'car'})
    _drive(sim, 0.0, 0.0, 3.0)

    assert not _after(sim, 1.0).poses.any()


def test_a_robot_stops_after_its_timeout(report):
    sim = _floor()
    _robot(sim, drive={'timeout': 0.5, 'acceleration': 2.0})
    _drive(sim, 0.2, 0.0, 0.0)

    last = _after(sim, 2.0)

    # It accelerates for 0.1 s, and brakes for as long after the timeout.
    report.check(38, 'way until the timeout', last.poses[0, 0], 0.2 * 0.5, 1e-9, 'm')
    assert not last.twists.any()


@pytest.mark.parametrize('speed', [0.02, 0.2])
def test_a_robot_at_a_wall_pushes_with_the_force_of_its_traction(report, speed):
    sim = _floor()
    spawn(sim, 'wall/0', Box(width=0.2, height=4.0), (0.4, 0.0, 0.0), anchored=True)
    row = _robot(sim, mass=1.5)
    _drive(sim, speed, 0.0, 0.0)
    pressed = _after(sim, 14.0)
    sim.world.reports_contacts = True
    sim.world.contacts(pressed)

    last = _after(sim, 1.0)

    force = abs(sim.world.contacts(last).impulses[0, 0])
    report.check(39, 'force of a robot at a wall', force, 0.8 * 1.5 * G, 1e-6, 'N')
    before, after = pressed.poses[row, 0], last.poses[row, 0]
    report.check(39, 'way of a robot at a wall, 1 s', after, before, 1e-9, 'm')
    # Its wheels slip, and so does its odometry.
    wheels = last.robots['odometry'][0, 0] - pressed.robots['odometry'][0, 0]
    report.check(39, 'way of wheels that slip, 1 s', wheels, speed, 1e-9, 'm')


def test_a_robot_goes_on_at_its_speed_when_the_wall_is_gone(report):
    sim = _floor()
    spawn(sim, 'wall/0', Box(width=0.2, height=4.0), (0.4, 0.0, 0.0), anchored=True)
    _robot(sim)
    _drive(sim, 0.2, 0.0, 0.0)
    _after(sim, 5.0)
    sim.perform(Delete(name='wall/0'))

    speeds = [each.twists[0, 0] for each in steps(sim, 60)]

    report.check(39, 'speed after a stall: overshoot', max(speeds), 0.2, 0.001, 'm/s')
    report.check(39, 'speed after a stall', speeds[-1], 0.2, 1e-6, 'm/s')


def test_two_robots_head_on_stand_still(report):
    sim = _floor()
    for number, (x, yaw) in enumerate(((-0.5, 0.0), (0.5, math.pi))):
        _robot(sim, f'robot/{number}', (x, 0.0, yaw))
        _drive(sim, 0.2, 0.0, 0.0, name=f'robot/{number}')
    met = _after(sim, 5.0)

    last = _after(sim, 10.0)

    way = abs(last.poses - met.poses).max()
    report.check(39, 'two robots head on: way, 10 s', way, 0, 1e-9, 'm')


def test_the_heavier_of_two_robots_head_on_wins():
    sim = _floor()
    for number, (x, yaw, mass) in enumerate(((-0.5, 0.0, 1.0), (0.5, math.pi, 1.5))):
        _robot(sim, f'robot/{number}', (x, 0.0, yaw), mass=mass)
        _drive(sim, 0.2, 0.0, 0.0, name=f'robot/{number}')

    last = _after(sim, 6.0)

    assert last.poses[0, 0] < -0.5
    assert last.twists[:, 0] == pytest.approx([-0.2, -0.2], abs=1e-3)


@pytest.mark.parametrize('mass', [0.3, 1.0, 1.5])
def test_a_robot_pushes_a_box_at_its_own_speed(report, mass):
    sim = _floor()
    _robot(sim, shape=BOX)
    spawn(sim, 'box/0', BOX, (0.4, 0.0, 0.0), mass=mass)
    _drive(sim, 0.2, 0.0, 0.0)
    start = _after(sim, 4.0)

    last = _after(sim, 4.0)

    speed = (last.poses[1, 0] - start.poses[1, 0]) / 4.0
    report.check(40, 'speed of a pushed box', speed, 0.2, 0.01, 'm/s', relative=True)
    off = last.poses[1, 1:]
    report.check(40, 'a pushed box goes straight', abs(off).max(), 0.0, 1e-6, 'm')


def test_a_robot_does_not_push_what_is_heavier_than_its_traction(report):
    # The limit is 0.8 / 0.5 of its own mass.
    sim = _floor()
    _robot(sim, shape=BOX)
    spawn(sim, 'box/0', BOX, (0.4, 0.0, 0.0), mass=1.7)
    _drive(sim, 0.2, 0.0, 0.0)
    start = _after(sim, 5.0)

    last = _after(sim, 10.0)

    report.check(40, 'a box that is too heavy: way', last.poses[1, 0], start.poses[1, 0], 0.0, 'm')


def test_a_pushed_box_stops_when_the_robot_does(report):
    sim = _floor()
    _robot(sim, shape=BOX, drive={'acceleration': 100.0})
    spawn(sim, 'box/0', BOX, (0.4, 0.0, 0.0), elasticity=0.0)
    _drive(sim, 0.3, 0.0, 0.0)
    start = _after(sim, 3.0).poses[1, 0]
    _drive(sim, 0.0, 0.0, 0.0)

    last = _after(sim, 3.0)

    way = last.poses[1, 0] - start
    report.check(40, 'a pushed box that is let go', way, 0.3**2 / (2 * MU * G), 1e-3, 'm')
    assert not last.twists.any()


def test_what_was_pressed_against_a_wall_is_not_pressed_for_ever(report):
    sim = _floor(bounds=(-2.0, -2.0, 0.5, 2.0))
    sim.reports_contacts = True
    _robot(sim, shape=BOX)
    spawn(sim, 'box/0', BOX, (0.35, 0.0, 0.0), elasticity=0.0)
    _drive(sim, 0.3, 0.0, 0.0)
    for _ in range(120):
        pushed = sim.advance_frame().contacts.impulses
    assert np.abs(pushed).max() > 0.1

    sim.perform(Delete(name='robot/0'))
    for _ in range(120):
        left = sim.advance_frame().contacts.impulses

    # Friction could hold what the wall presses; a push decays instead.
    report.check(39, 'push of a wall that nothing pushes', np.abs(left).max(), 0.0, 1e-8, 'N s')


def _belt(sim, length, speed, name='belt/0', yaw=0.0):
    """Add a conveyor about the origin."""
    said = {'anchored': True, 'sensor': True, 'surface_velocity': (speed, 0.0)}
    spawn(sim, name, Box(width=length, height=1.0), (0.0, 0.0, yaw), **said)


def on_conveyors(*speeds):
    """Return a box on conveyors that lie on each other; the last row is that of the box."""
    sim = _floor()
    for number, speed in enumerate(speeds):
        _belt(sim, 6.0, speed, name=f'belt/{number}', yaw=0.3)
    spawn(sim, 'box/0', BOX)
    return sim


@pytest.mark.parametrize('speeds', [(0.4,), (-0.4, 0.4), (0.2, 0.3, 0.4)])
def test_a_conveyor_carries_at_its_speed_and_of_several_the_last(report, speeds):
    sim = on_conveyors(*speeds)
    start = _after(sim, 1.0).poses[-1]

    last = _after(sim, 2.0)

    way = last.poses[-1, :2] - start[:2]
    exact = turned((0.4 * 2.0, 0.0), 0.3)
    report.check(40, 'way on a conveyor', abs(way - exact).max(), 0.0, 1e-9, 'm')


def _polygon(points):
    return Polygon(outline=tuple(map(tuple, points)))


def _disc(points):
    return Compound(element=Disc(radius=0.7), centers=tuple(map(tuple, points)))


def _chain(points):
    return Chain(points=tuple(map(tuple, points)), thickness=0.3)


@pytest.mark.parametrize('held', ['anchored', 'kinematic'])
@pytest.mark.parametrize('middle', [(0.0, 0.0), (3.0, -2.0)])
@pytest.mark.parametrize(
    ('shape_of', 'points'),
    [
        (_polygon, ((-0.9, -0.6), (0.9, -0.6), (0.2, 0.1), (-0.5, 0.8))),
        (_chain, ((-0.9, -0.5), (0.1, 0.4), (0.9, 0.2))),
        (_disc, ((0.0, 0.0),)),
    ],
)
def test_a_conveyor_carries_what_has_its_centre_on_it(shape_of, points, middle, held):
    sim = _floor()
    shape = shape_of(points + np.array(middle))
    said = {held: True, 'sensor': True, 'surface_velocity': (0.4, 0.0)}
    spawn(sim, 'belt/0', shape, (0.0, 0.0, 0.0), **said)
    # Not on a grid, which would lie on edges.
    places = np.linspace(-0.93, 0.97, 9)
    points = [(x + middle[0], y + middle[1]) for x in places for y in places]
    for number, (x, y) in enumerate(points):
        spawn(sim, f'disc/{number}', Disc(radius=0.05), (x, y, 0.0))

    twists = _after(sim, DT).twists[1:]

    carried = twists.any(axis=1).tolist()
    assert carried == [contains(shape.form.pieces, x, y) for x, y in points]
    assert 10 < sum(carried) < len(points) - 10


def test_a_conveyor_that_turns_turns_what_lies_on_it(report):
    sim = _floor()
    said = {'kinematic': True, 'sensor': True, 'surface_velocity': (0.01, 0.0), 'spin': 0.5}
    spawn(sim, 'belt/0', Box(width=6.0, height=6.0), **said)
    row = spawn(sim, 'box/0', BOX)

    last = _after(sim, 1.0)

    report.check(40, 'turn of a conveyor', last.twists[row, 2], 0.5, 1e-9, 'rad/s')


def test_what_leaves_a_conveyor_slides_to_a_stop(report):
    sim = _floor()
    _belt(sim, 2.0, 1.0)
    row = spawn(sim, 'box/0', BOX)

    last = _after(sim, 10.0)

    # It leaves within a step after its centre of mass has passed the edge.
    exact = 1.0 + 1.0 / (2 * MU * G)
    report.check(40, 'behind a conveyor', last.poses[row, 0], exact, 2 * DT, 'm')
    assert not last.twists.any()


def test_odometry_without_slip_is_the_way(report):
    sim = _floor()
    _robot(sim, pose=(1.0, 2.0, 0.5), drive={'max_speed': 0.3})
    _robot(sim, 'omni/0', (-3.0, 0.0, 1.5), drive={'kind': 'omni', 'max_speed': 0.3})
    off = 0.0
    starts = sim.world.snapshot().poses
    for number in range(40):
        forward, aside = 0.3 * math.sin(number), 0.2 * math.cos(2.3 * number)
        command = forward, aside, 2.0 * math.sin(0.7 * number)
        for name in ('robot/0', 'omni/0'):
            _drive(sim, *command, name=name)
        last = _after(sim, 0.25)
        for start, pose, reckoned in zip(starts, last.poses, last.robots['odometry'], strict=True):
            x, y = turned(reckoned[:2], start[2]) + start[:2]
            off = max(off, abs(np.array([x, y, start[2] + reckoned[2]]) - pose).max())

    report.check(41, 'odometry without slip, 10 s', off, 0.0, 1e-9, 'm')


def test_the_drift_of_odometry_is_as_large_as_it_says(report):
    slip, way = (0.05, 0.04), 1.6
    sim = _floor(seed=7)
    _fleet(sim, 200, 0.4, 0.0, 0.0, odometry={'slip': slip})

    last = _after(sim, way / 0.4)

    ways, headings = last.robots['odometry'][:, 0], last.robots['odometry'][:, 2]
    driven = last.poses[0, 0]
    # Headings make the way along x shorter too; both by chance, of 200 within a fifth.
    turned, gone = headings.std() / math.sqrt(driven), ways.std() / math.sqrt(driven)
    report.check(41, 'drift of the heading', turned, slip[1], 0.2, 'rad/√m', relative=True)
    report.check(41, 'drift of the way', gone, slip[0], 0.2, 'm/√m', relative=True)


def test_the_covariance_of_odometry_is_that_of_its_errors(report):
    count, slip = 200, (0.03, 0.06)
    for number, (kind, velocity) in enumerate(
        (
            ('differential', (0.4, 0.0, 0.0)),
            ('differential', (0.4, 0.0, 0.4)),
            ('omni', (0.2, 0.4, 0.0)),
            ('differential', (0.0, 0.0, 0.5)),
        )
    ):
        sim = _floor(seed=number)
        said = {'drive': {'kind': kind}, 'odometry': {'slip': slip}}
        _fleet(sim, count, *velocity, namespace='r', **said)

        states = _after(sim, 3.0).robots

        told, found = states['covariance'].mean(axis=0), np.cov(states['odometry'].T)
        for place, (row, column) in enumerate(((0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2))):
            # Of 200, a variance is within 20 % of its own, at two standard deviations; so is a
            # product, of the root of its variances.
            scale = math.sqrt(found[row, row] * found[column, column])
            off = abs(told[place] - found[row, column])
            ratio = off / scale if scale > 1e-12 else off
            report.check(41, f'covariance of odometry, way {number}', ratio, 0.0, 0.2, '1')


def test_noise_is_another_one_of_another_seed_and_another_robot():
    drifts = []
    for seed in (0, 0, 1):
        sim = _floor(seed=seed)
        _fleet(sim, 2, 0.4, 0.0, 0.0, odometry={'slip': (0.05, 0.05)})
        drifts.append(_after(sim, 1.0).robots['odometry'])

    assert np.array_equal(drifts[0], drifts[1])
    assert not np.isclose(drifts[0], drifts[2]).all(axis=1).any()
    assert not np.isclose(drifts[0][0], drifts[0][1]).all()


def test_without_a_floor_nothing_stops():
    sim = simulation(gravity=NOWHERE)
    spawn(sim, 'disc/0', Disc(radius=0.2), velocity=(1.0, 0.0), spin=2.0)

    assert _after(sim, 1.0).twists[0].tolist() == [1.0, 0.0, 2.0]
