# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Laws 51 to 53: paths are kept in time, starts are waited for, pedestrians avoid each other."""

from itertools import pairwise
import math

import numpy as np
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import ChangeBody, Command, Delete, DriveRobot
from physsim_ros.model.shapes import Box, Chain, Disc
import pytest

from .scenes import DT, NOWHERE, simulation, spawn

PERSON = Disc(radius=0.25)
CORNER = [[1.0, 1.0], [3.0, 1.0], [3.0, 2.0]]
PATH = {'kind': 'path', 'points': CORNER, 'times': [0.0, 2.0, 3.0]}
DRIVES = {
    'differential': {'kind': 'differential', 'track': 0.16, 'max_speed': 2.0, 'max_turn': 6.0},
    'omni': {'kind': 'omni', 'max_speed': 2.0},
    'car': {'kind': 'car', 'wheelbase': 0.15, 'max_speed': 2.0, 'max_turn': 6.0},
}


def _floor():
    return simulation(gravity=NOWHERE, floor_friction=0.5)


def _poses(sim, times):
    """Return (t, n, 3) float64: poses at times [s]."""
    poses, world = [], sim.world
    for time in times:
        world.step(round(time / DT) - world.step_count)
        poses.append(world.snapshot().poses)
    return np.array(poses)


@pytest.mark.parametrize(
    ('repeat', 'exact'),
    [
        ('once', {1.0: (2, 1), 2.5: (3, 1.5), 3.0: (3, 2), 9.0: (3, 2)}),
        ('to_and_fro', {1.0: (2, 1), 3.5: (3, 1.5), 5.0: (2, 1), 6.0: (1, 1), 8.0: (3, 1)}),
    ],
)
def test_a_kinematic_body_is_on_its_path_at_each_time(report, repeat, exact):
    sim = _floor()
    spawn(sim, 'cart/0', PERSON, (1.0, 1.0, 0.0), kinematic=True, actor={**PATH, 'repeat': repeat})

    poses = _poses(sim, exact)

    worst = abs(poses[:, 0, :2] - [*exact.values()]).max()
    report.check(51, f'distance from a path, {repeat}', worst, 0.0, 1e-9, 'm')


def test_a_loop_begins_anew_with_its_times(report):
    sim = _floor()
    loop = {**PATH, 'repeat': 'loop', 'times': [0.5, 2.5, 3.5, 5.5]}
    spawn(sim, 'cart/0', PERSON, (1.0, 1.0, 0.0), kinematic=True, actor=loop)

    poses = _poses(sim, (0.4, 1.5, 3.5, 4.5, 5.6, 7.0))

    exact = [(1, 1), (2, 1), (3, 2), (2, 1.5), (1, 1), (2, 1)]
    worst = abs(poses[:, 0, :2] - exact).max()
    report.check(51, 'distance from a loop', worst, 0.0, 1e-9, 'm')


def test_points_with_a_yaw_turn_the_body_about_its_origin(report):
    sim = _floor()
    turning = {'kind': 'path', 'points': [[0, 0, 0], [1, 0, 3], [1, 0, 0]], 'times': [0, 1, 2]}
    row = spawn(sim, 'door/0', Box(width=1.0, height=0.2), kinematic=True, actor=turning)

    poses = _poses(sim, (0.5, 1.0, 1.5, 2.0))

    exact = [(0.5, 0, 1.5), (1, 0, 3), (1, 0, 1.5), (1, 0, 0)]
    report.check(51, 'pose of a door', abs(poses[:, row] - exact).max(), 0.0, 1e-9, 'm')


@pytest.mark.parametrize('drive', [None, *DRIVES])
def test_what_the_floor_moves_is_on_its_path_once_it_has_caught_up(report, drive):
    sim = _floor()
    robot = {} if drive is None else {'robot': {'drive': DRIVES[drive]}}
    straight = {'kind': 'path', 'points': [[0.0, 0.0], [8.0, 0.0]], 'speed': 1.0}
    row = spawn(
        sim, 'cart/0', Disc(radius=0.1), (0.0, 0.1, 0.0), mass=5.0, actor=straight, **robot
    )

    poses = _poses(sim, (6.0,))

    # Of a drive that does not move sideways, the point ahead is led, by the radius.
    ahead = 0.1 if drive in ('differential', 'car') else 0.0
    away = math.dist(poses[0, row, :2], (6.0 - ahead, 0.0))
    report.check(51, f'distance from a path, {drive or "on foot"}', away, 0.0, 2e-3, 'm')


def test_a_body_that_was_moved_away_catches_up_at_twice_the_speed_of_its_path():
    sim = _floor()
    row = spawn(sim, 'cart/0', PERSON, (1.0, 1.0, 0.0), kinematic=True, actor=PATH)
    _poses(sim, (1.0,))
    sim.perform(Command(names=('cart/0',), poses=np.array([[1.0, 1.0, 0.0]])))

    speeds = [
        math.dist(*pair) / 0.1 for pair in pairwise(_poses(sim, (1.0, 1.1, 1.2))[:, row, :2])
    ]

    assert speeds == pytest.approx([2.0, 2.0])
    assert _poses(sim, (4.0,))[0, row, :2] == pytest.approx((3.0, 2.0))


def test_a_body_on_a_path_pushes_no_harder_than_its_feet_hold():
    sim = _floor()
    spawn(sim, 'wall/0', Box(width=0.2, height=4.0), (2.0, 1.0, 0.0), anchored=True)
    row = spawn(sim, 'cart/0', PERSON, (1.0, 1.0, 0.0), mass=10.0, actor=PATH)

    last = _poses(sim, (9.0,))[0, row]

    assert last[0] == pytest.approx(1.65, abs=0.01)


@pytest.mark.parametrize(
    ('start', 'seconds'),
    [
        ({'time': 1.5}, 1.5),
        # The robot drives 1 m at 1 m/s, and accelerates at 100 m/s².
        ({'gate': 'gate/0', 'by': 'robot/0'}, 1.005),
        ({'gate': 'gate/0'}, 1.005),
        ({'gate': 'gate/0', 'by': 'post/0'}, None),
        ({'near': 'robot/0', 'distance': 4.0}, 1.005),
        ({'near': 'robot/0', 'distance': 4.0, 'time': 1.0}, 2.005),
    ],
)
def test_an_actor_waits_for_its_start(start, seconds):
    sim = _floor()
    drive = {'kind': 'omni', 'max_speed': 1.0, 'acceleration': 100, 'traction': 10, 'timeout': 0}
    spawn(sim, 'robot/0', Disc(radius=0.1), mass=1.0, robot={'drive': drive})
    gate = Box(width=0.2, height=2.0)
    spawn(sim, 'gate/0', gate, (1.1, 0.0, 0.0), anchored=True, sensor=True)
    spawn(sim, 'post/0', Disc(radius=0.1), (0.0, 3.0, 0.0), anchored=True)
    path = {'kind': 'path', 'points': [[5.0, 0.0], [5.0, 5.0]], 'speed': 1.0, 'start': start}
    row = spawn(sim, 'cart/0', PERSON, (5.0, 0.0, 0.0), kinematic=True, actor=path)
    sim.perform(DriveRobot(name='robot/0', velocity=(1.0, 0.0, 0.0)))

    at = (seconds or 5.0) - 0.02
    before, after = _poses(sim, (at, at + 1.02))[:, row, 1]

    assert before == 0.0
    assert after == pytest.approx(1.0 if seconds else 0.0, abs=0.03)


def test_a_changed_actor_starts_anew_and_any_other_change_does_not():
    sim = _floor()
    row = spawn(sim, 'cart/0', PERSON, (1.0, 1.0, 0.0), kinematic=True, actor=PATH)
    _poses(sim, (1.0,))
    sim.perform(ChangeBody(name='cart/0', properties=Properties(friction=0.1)))
    assert _poses(sim, (1.5,))[0, row, 0] == pytest.approx(2.5)
    back = {'kind': 'path', 'points': [[2.5, 1.0], [2.5, 3.0]], 'times': [0.0, 1.0]}
    sim.perform(ChangeBody(name='cart/0', properties=Properties(actor=back)))
    assert _poses(sim, (2.0,))[0, row, :2] == pytest.approx((2.5, 2.0))


def test_an_actor_whose_gate_is_deleted_waits_on():
    sim = _floor()
    gate = spawn(sim, 'gate/0', PERSON, (1.0, 1.0, 0.0), anchored=True, sensor=True)
    assert gate == 0
    spawn(sim, 'cart/0', PERSON, (1.0, 1.0, 0.0), actor={**PATH, 'start': {'gate': 'gate/0'}})
    sim.perform(Delete(name='gate/0'))
    sim.perform(Command(names=('cart/0',), poses=np.array([[5.0, 1.0, 0.0]])))
    assert _poses(sim, (2.0,))[0, 0, :2] == pytest.approx((5.0, 1.0))


def test_a_command_takes_a_robot_off_its_path_until_its_timeout():
    sim = _floor()
    drive = {**DRIVES['omni'], 'timeout': 1.0}
    away = {'kind': 'path', 'points': [[0, 0], [9, 0]], 'speed': 0.5}
    row = spawn(sim, 'robot/0', Disc(radius=0.1), mass=1.0, robot={'drive': drive}, actor=away)
    _poses(sim, (1.0,))
    sim.perform(DriveRobot(name='robot/0', velocity=(0.0, 1.0, 0.0)))

    off, back = _poses(sim, (2.0, 8.0))[:, row]

    assert off[1] > 0.5
    assert back[:2] == pytest.approx((4.0, 0.0), abs=1e-3)


# Pedestrians


def _gaps(sim, seconds):
    """Return the least distance of two bodies' centres at the end of each 0.1 s [m]."""
    gaps = []
    for _ in range(round(10 * seconds)):
        sim.world.step(24)
        places = sim.world.snapshot().poses[:, :2]
        away = np.hypot(*(places[:, None] - places[None]).transpose(2, 0, 1))
        gaps.append(away[np.triu_indices(len(away), 1)].min())
    return np.array(gaps)


@pytest.mark.parametrize('kinematic', [True, False])
@pytest.mark.parametrize('max_speed', [1.34, 2.0])
@pytest.mark.parametrize(
    ('count', 'radius', 'seconds'),
    [(2, 4.0, 7.0), (5, 4.0, 7.0), (8, 4.0, 7.5), (12, 4.0, 8.0), (20, 4.0, 9.0), (30, 8.0, 20.0)],
)
def test_pedestrians_of_orca_cross_a_circle_without_contact(
    report, count, radius, seconds, max_speed, kinematic
):
    sim = _floor()
    angles = np.arange(count) * math.tau / count
    starts = radius * np.column_stack((np.cos(angles), np.sin(angles)))
    for number, (x, y) in enumerate(starts.tolist()):
        over = {'kind': 'orca', 'points': [[-x, -y]], 'max_speed': max_speed}
        made = {'mass': 75.0, 'kinematic': kinematic, 'actor': over}
        spawn(sim, f'person/{number}', PERSON, (x, y, 0.0), **made)

    least = _gaps(sim, seconds).min()

    report.check(52, f'gap of {count} of ORCA', min(least - 0.5, 0.0), 0.0, 1e-9, 'm')
    last = sim.world.snapshot().poses[:, :2]
    assert np.hypot(*(last + starts).T).max() < 0.3


STANDING = {
    'post': (Disc(radius=0.3), {'anchored': True}),
    'pillar': (Box(width=0.5, height=0.5), {'anchored': True}),
    'cart': (Box(width=0.5, height=0.5), {'kinematic': True}),
    'crate': (Box(width=0.5, height=0.5), {'mass': 5.0}),
    'person': (PERSON, {'mass': 70.0, 'actor': {'kind': 'social_force', 'points': [[0.0, 0.0]]}}),
}


@pytest.mark.parametrize('heading', [0.0, 0.5, 2.0])
@pytest.mark.parametrize('kind', ['social_force', 'orca'])
@pytest.mark.parametrize('what', STANDING)
def test_a_pedestrian_passes_what_stands_exactly_in_its_way(what, kind, heading):
    sim = _floor()
    shape, properties = STANDING[what]
    spawn(sim, 'what/0', shape, (0.0, 0.0, heading), **properties)
    goal = 4.0 * math.cos(heading), 4.0 * math.sin(heading)
    walks = {'kind': kind, 'points': [goal]}
    row = spawn(sim, 'person/0', PERSON, (-goal[0], -goal[1], 0.0), mass=70.0, actor=walks)
    sim.world.step(round(30.0 / DT))
    assert math.dist(sim.world.snapshot().poses[row, :2], goal) < 0.3


def _walls(sim, *walls):
    """Spawn anchored boxes: width, height, x, y [m]."""
    for number, (width, height, x, y) in enumerate(walls):
        wall = Box(width=width, height=height)
        spawn(sim, f'wall/{number}', wall, (x, y, 0.0), anchored=True)


# Walls of a door in the line x = 0, by its width [m].
def _door(width):
    return [(0.2, 5.0, 0.0, side * (width / 2 + 2.5)) for side in (-1, 1)]


@pytest.mark.parametrize('kind', ['social_force', 'orca'])
@pytest.mark.parametrize(
    ('walls', 'start'),
    [
        # Straight at a wall, and at its end.
        ([(0.2, 4.0, 0.0, 0.0)], (-3.0, 0.0)),
        ([(0.2, 4.0, 0.0, 0.0)], (-3.0, -1.8)),
        # A gap in which a person of 0.5 m fits, and one in which nobody does.
        ([(0.5, 0.5, 0.0, side * 0.53) for side in (-1, 1)], (-3.0, 0.0)),
        ([(0.5, 0.5, 0.0, side * 0.4) for side in (-1, 1)], (-3.0, 0.0)),
        # A corridor, and behind the walls of a door.
        ([(4.0, 0.2, 0.0, side * 0.4) for side in (-1, 1)], (-3.0, 0.0)),
        (_door(0.7), (-1.0, 1.5)),
        # In a wall.
        ([(1.0, 1.0, -3.0, 0.0)], (-3.4, 0.0)),
        ([(1.0, 1.0, -3.0, 0.0)], (-3.0, 0.0)),
    ],
)
def test_a_pedestrian_finds_the_way_where_walls_leave_one(walls, start, kind):
    sim = _floor()
    _walls(sim, *walls)
    goal = 3.0, start[1]
    walks = {'kind': kind, 'points': [goal]}
    row = spawn(sim, 'person/0', PERSON, (*start, 0.0), mass=70.0, actor=walks)
    sim.world.step(round(30.0 / DT))
    assert math.dist(sim.world.snapshot().poses[row, :2], goal) < 0.3


@pytest.mark.parametrize(
    ('shift', 'tilt', 'side'),
    [
        (0.0, 0.0, -1.0),
        (-3e-8, 0.0, 1.0),
        (3e-8, 0.0, -1.0),
        # Both ways are equal, and one begins with less of a turn.
        (0.0, 0.5, -1.0),
        (0.0, -0.5, 1.0),
    ],
)
def test_a_pedestrian_takes_the_shorter_way_of_equal_ways_that_of_less_turn_or_the_right(
    shift, tilt, side
):
    sim = _floor()
    wall = Chain(points=((0.0, -2.0), (0.0, 2.0)), thickness=0.2)
    spawn(sim, 'wall/0', wall, (0.0, shift, tilt), anchored=True)
    walks = {'kind': 'orca', 'points': [[3.0, 0.0]]}
    row = spawn(sim, 'person/0', PERSON, (-3.0, 0.0, 0.0), kinematic=True, actor=walks)
    sim.world.step(1)
    assert sim.world.snapshot().twists[row, 1] * side > 0.5


@pytest.mark.parametrize('thickness', [0.2, 0.6])
def test_a_pedestrian_walks_along_the_tangent_to_the_end_of_a_wall(thickness):
    sim = _floor()
    wall = Chain(points=((0.0, -2.0), (0.0, 2.0)), thickness=thickness)
    spawn(sim, 'wall/0', wall, (0.0, 0.3, 0.0), anchored=True)
    walks = {'kind': 'orca', 'points': [[3.0, 0.0]]}
    row = spawn(sim, 'person/0', PERSON, (-3.0, 0.0, 0.0), kinematic=True, actor=walks)
    sim.world.step(1)
    vx, vy, _ = sim.world.snapshot().twists[row]
    away = math.asin((PERSON.radius + thickness / 2.0) / math.hypot(3.0, 1.7))
    assert math.atan2(vy, vx) == pytest.approx(math.atan2(-1.7, 3.0) - away)


@pytest.mark.parametrize('kind', ['social_force', 'orca'])
def test_a_crowd_goes_through_a_door_both_ways(kind):
    sim = _floor()
    _walls(sim, *_door(1.2))
    starts = [
        (side * (2.0 + 0.8 * (n // 3)), (n % 3 - 1) * 0.8) for n in range(5) for side in (-1, 1)
    ]
    for number, (x, y) in enumerate(starts):
        walks = {'kind': kind, 'points': [[-2.0 * x, y]]}
        person = Disc(radius=0.22)
        spawn(sim, f'person/{number}', person, (x, y, 0.0), mass=70.0, actor=walks)
    sim.world.step(round(40.0 / DT))
    poses = sim.world.snapshot().poses
    here = np.array([poses[row - len(starts), 0] for row in range(len(starts))])
    assert (here * [-np.sign(x) for x, _ in starts] > 1.0).all()


@pytest.mark.parametrize('kind', ['social_force', 'orca'])
def test_who_starts_on_a_robot_or_a_person_parts_and_a_goal_in_a_wall_is_not_reached(kind):
    sim = _floor()
    _walls(sim, (1.0, 1.0, 3.0, 0.0))
    spawn(sim, 'robot/0', Disc(radius=0.2), mass=2.0, robot={'drive': {'kind': 'omni'}})
    goals = {'person/0': (3.0, 0.0), 'person/1': (-3.0, 0.0)}
    for name, goal in goals.items():
        spawn(sim, name, PERSON, mass=70.0, actor={'kind': kind, 'points': [goal]})
    sim.world.step(round(20.0 / DT))
    last = sim.world.snapshot()
    assert np.isfinite(last.poses).all()
    here = {name: last.poses[last.row(name), :2] for name in goals}
    assert math.dist(here['person/1'], goals['person/1']) < 0.3
    # Before the wall, at most at its side.
    assert 0.7 < math.dist(here['person/0'], goals['person/0']) < 1.5


def test_a_pedestrian_of_orca_walks_round_what_does_not_give_way():
    sim = _floor()
    spawn(sim, 'post/0', Disc(radius=0.3), (3.0, 0.0, 0.0), anchored=True)
    spawn(sim, 'box/0', Box(width=0.4, height=0.4), (6.0, 0.0, 0.0), kinematic=True)
    row = spawn(sim, 'person/0', PERSON, mass=75.0, actor={'kind': 'orca', 'points': [[9.0, 0.0]]})
    path = _poses(sim, np.arange(0.1, 9.0, 0.1))[:, row, :2]

    assert math.dist(path[-1], (9.0, 0.0)) < 0.3
    assert np.hypot(*(path - (3.0, 0.0)).T).min() > 0.55 - 1e-3
    assert np.hypot(*(path - (6.0, 0.0)).T).min() > 0.45 - 1e-3


def test_a_pedestrian_of_orca_passes_a_door_and_touches_no_wall():
    sim = _floor()
    for side in (-1, 1):
        spawn(
            sim, f'wall/{side}', Box(width=0.2, height=3.0), (3.0, 2.1 * side, 0.0), anchored=True
        )
    points = [[3.0, 0.0], [6.0, 1.0]]
    row = spawn(
        sim,
        'person/0',
        PERSON,
        (0.0, 1.0, 0.0),
        kinematic=True,
        actor={'kind': 'orca', 'points': points},
    )
    path = _poses(sim, np.arange(0.1, 8.0, 0.1))[:, row, :2]

    assert math.dist(path[-1], points[-1]) < 0.3
    corners = np.array([(x, y) for x in (2.9, 3.1) for y in (-0.6, 0.6)])
    assert np.hypot(*(path[:, None] - corners[None]).transpose(2, 0, 1)).min() > 0.25 - 1e-3


def test_a_pedestrian_alone_approaches_its_speed_in_the_relaxation_time(report):
    sim = _floor()
    alone = {'kind': 'social_force', 'points': [[100.0, 0.0]], 'speed': 1.2}
    spawn(sim, 'person/0', PERSON, kinematic=True, actor=alone)
    sim.world.step(round(1.0 / DT))

    # Helbing and Molnár 1995, equation (2): v = v⁰ (1 - exp(-t / τ)); a step is 1/120 of τ.
    speed = sim.world.snapshot().twists[0, 0]
    report.check(53, 'speed after 1 s', speed, 1.2 * (1.0 - math.exp(-2.0)), 5e-3, 'm/s')


@pytest.mark.parametrize('pieces', [1, 2, 39, 40])
def test_the_force_of_a_wall_is_that_of_its_potential_in_one_piece_or_many(report, pieces):
    sim, width = _floor(), 20.0 / pieces
    for number in range(pieces):
        # Of unlike heights, with their faces in one plane.
        height, x = 0.2 + 0.1 * (number % 3), (number + 0.5) * width - 10.0
        wall = Box(width=width, height=height)
        spawn(sim, f'wall/{number}', wall, (x, -height / 2, 0.0), anchored=True)
    stands = {'kind': 'social_force', 'points': [[0.0, 0.6]], 'max_speed': 100.0}
    row = spawn(sim, 'person/0', PERSON, (0.0, 0.6, 0.0), kinematic=True, actor=stands)
    sim.world.step(1)
    # U⁰ / R exp(-r / R), in one step.
    by_wall = 10.0 / 0.2 * math.exp(-0.6 / 0.2) * DT
    velocity = sim.world.snapshot().twists[row, :2]
    report.check(53, f'velocity by a wall of {pieces}', velocity[1], by_wall, 1e-9, 'm/s')
    assert abs(velocity[0]) < 1e-9


@pytest.mark.parametrize(('across', 'in_way'), [(0.1, 1.0), (0.425, 0.5), (0.7, 0.0)])
def test_the_force_of_a_post_pushes_back_by_the_part_of_it_in_the_way(report, across, in_way):
    sim = _floor()
    spawn(sim, 'post/0', Disc(radius=0.3), (0.8, across, 0.0), kinematic=True)
    walks = {'kind': 'social_force', 'points': [[50.0, 0.0]], 'speed': 1.0, 'max_speed': 100.0}
    row = spawn(sim, 'person/0', PERSON, kinematic=True, actor=walks)
    sim.world.step(1)
    distance = math.hypot(0.8, across)
    away = np.array((-0.8, -across)) / distance
    force = 10.0 / 0.2 * math.exp(-(distance - 0.3) / 0.2) * away * (in_way, 1.0)
    # A push from straight ahead is turned to the right by 0.1 rad.
    turn = -0.1 * force[0] / math.hypot(*force)
    cos, sin = math.cos(turn), math.sin(turn)
    pushed = force @ [[cos, sin], [-sin, cos]] * DT
    velocity = sim.world.snapshot().twists[row, :2] - (1.0 / 0.5 * DT, 0.0)
    worst = abs(velocity - pushed).max()
    report.check(53, f'velocity by a post {across:g} m beside the way', worst, 0.0, 1e-9, 'm/s')


def test_the_force_of_a_pedestrian_is_that_of_its_potential(report):
    stands = {'kind': 'social_force', 'max_speed': 100.0}
    sim = _floor()
    for number, x in enumerate((0.0, 0.8)):
        walks = {**stands, 'points': [[x + 50.0, 0.0]], 'speed': 1e-3, 'behind': 1.0}
        spawn(sim, f'person/{number}', PERSON, (x, 0.0, 0.0), kinematic=True, actor=walks)
    sim.world.step(1)
    # V⁰ / σ exp(-b / σ) away from one that stands, whose b is the distance.
    by_person = 2.1 / 0.3 * math.exp(-0.8 / 0.3) * DT
    change = math.hypot(*sim.world.snapshot().twists[0, :2])
    report.check(53, 'velocity by a pedestrian', change, by_person, 1e-5, 'm/s')


def test_lanes_form_where_pedestrians_of_social_force_walk_against_each_other(report):
    sim, pick = _floor(), np.random.default_rng(0)
    length, width, count = 40.0, 5.0, 40
    for side in (-1, 1):
        wall = Box(width=length + 20.0, height=0.2)
        spawn(sim, f'wall/{side}', wall, (0.0, side * (width / 2 + 0.1), 0.0), anchored=True)
    ahead = np.where(np.arange(count) % 2, 1.0, -1.0)
    for number, way in enumerate(ahead.tolist()):
        x, y = (
            pick.uniform(-length / 2, length / 2),
            pick.uniform(-width / 2 + 0.4, width / 2 - 0.4),
        )
        on = {'kind': 'social_force', 'points': [[1000.0 * way, 0.0]]}
        spawn(sim, f'person/{number}', Disc(radius=0.2), (x, y, 0.0), kinematic=True, actor=on)
    before = _order(sim, ahead)
    for _ in range(400):
        sim.world.step(24)
        places = sim.world.snapshot().poses[2:]
        # Pedestrians who leave at one end come in at the other.
        for number in np.flatnonzero(places[:, 0] * ahead > length / 2).tolist():
            back = places[number] - (ahead[number] * length, 0.0, 0.0)
            sim.perform(Command(names=(f'person/{number}',), poses=back[None]))

    assert before < 0.3
    report.check(53, 'order of lanes after 40 s', _order(sim, ahead), 1.0, 0.25, '')


def _order(sim, ahead):
    """
    Return the order of lanes, 0 .. 1: the mean square of who walks alike less who comes towards.

    M. Rex and H. Löwen, "Lane formation in oppositely charged colloids driven by an electric
    field", Physical Review E 75, 2007: of those who are as far to the left, within 0.4 m.
    """
    y = sim.world.snapshot().poses[2:, 1]
    beside = abs(y[:, None] - y[None]) < 0.4
    np.fill_diagonal(beside, val=False)
    alike = (beside * (ahead[:, None] * ahead[None])).sum(axis=1)
    total = beside.sum(axis=1)
    return float(((alike / np.maximum(total, 1)) ** 2)[total > 0].mean())
