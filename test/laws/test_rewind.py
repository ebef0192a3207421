# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 26: rewound to any step, a world plays on as it did the first time, to the bit."""

import math
import random

from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import (
    ChangeBody,
    Command,
    Configure,
    Delete,
    DriveRobot,
    Restore,
    Spawn,
)
from physsim_ros.model.shapes import Box, Compound, Disc, Polygon
import pytest

from .scenes import floor, G, NOWHERE, pyramid, simulation, spawn, walls
from ..simulation.histories import difference_of
from ..slow import slow

# Simulation time from one checkpoint to the next [s]: at the default of 3 s each scene would have
# to be three times as long.
CHECKPOINTS = 1.0
# Steps: 3 s, and so two checkpoints after the first, and one at the end.
LENGTH = 720
ELL = Polygon(outline=((0.0, 0.0), (2.0, 0.0), (2.0, 0.5), (0.5, 0.5), (0.5, 2.0), (0.0, 2.0)))
PAIR = Compound(element=Disc(radius=0.2), centers=((0.0, 0.0), (1.0, 0.3)))


# Worlds of other laws, and what is asked of them on the way: step -> requests. Worlds of which
# nothing is asked are sought by a relation.


def _pyramid():
    """Law 19: 105 boxes, one of which is shot at in the middle of it."""
    sim = simulation()
    floor(sim)
    pyramid(sim, 0.5, 0.1)
    ball = Spawn(name='ball/0', shape=Disc(radius=0.3), pose=(-8.0, 2.0, 0.0))
    return sim, {350: [ball, Command(names=('ball/0',), twists=((20.0, 2.0, 0.0),))]}


def _robots():
    """Laws 37 to 41: robots drive, push and stall on a floor with a conveyor."""
    sim = simulation(gravity=NOWHERE, floor_friction=0.3, seed=26)
    belt = {'anchored': True, 'sensor': True, 'surface_velocity': (0.3, 0.0)}
    spawn(sim, 'belt/0', Box(width=1.0, height=0.5), (0.5, 1.0, 0.3), **belt)
    spawn(sim, 'wall/0', Box(width=0.2, height=2.0), (1.5, 0.0, 0.0), anchored=True)
    later = {}
    for number, kind in enumerate(('differential', 'omni', 'car')):
        robot = {'drive': {'kind': kind, 'timeout': 0.4}, 'odometry': {'slip': [0.02, 0.03]}}
        pose = (0.0, 0.5 * number, 0.1 * number)
        spawn(sim, f'robot/{number}', Disc(radius=0.105), pose, mass=1.0, robot=robot)
        spawn(sim, f'box/{number}', Box(width=0.2, height=0.2), (0.4, 0.5 * number, 0.0), mass=0.6)
        for step in range(10 + number, LENGTH, 37):
            if step % 3 and (number != 1 or step < 400):
                velocity = (0.4, 0.1, 0.3 * math.sin(step))
                drive = DriveRobot(name=f'robot/{number}', velocity=velocity)
                later.setdefault(step, []).append(drive)
    later.setdefault(400, []).append(Delete(name='robot/1'))
    return sim, later


def _actors():
    """Laws 51 to 53: people, carts and a robot on their paths, started at a gate and by a time."""
    sim = simulation(gravity=NOWHERE, floor_friction=0.3, seed=26)
    spawn(sim, 'wall/0', Box(width=8.0, height=0.2), (0.0, -1.0, 0.0), anchored=True)
    spawn(sim, 'gate/0', Box(width=0.4, height=2.0), (0.5, 0.0, 0.0), anchored=True, sensor=True)
    kinds = ('orca', 'social_force')
    for number in range(8):
        x, y = math.cos(number), math.sin(number)
        walks = {'kind': kinds[number % 2], 'points': [[-x, -y], [x, y]], 'repeat': 'to_and_fro'}
        made = {'kinematic': number % 3 == 0, 'mass': 70.0, 'actor': walks}
        spawn(sim, f'person/{number}', Disc(radius=0.12), (2 * x, 2 * y, 0.0), **made)
    points = [[0.0, 2.0, 0.0], [1.0, 2.0, 1.0], [1.0, 3.0, -2.0]]
    path = {'kind': 'path', 'points': points, 'speed': 0.8, 'repeat': 'loop'}
    starts = ({}, {'time': 0.7}, {'gate': 'gate/0'}, {'near': 'person/0', 'distance': 1.0})
    for number, start in enumerate(starts):
        pose = (0.3 * number, 2.0 + 0.4 * number, 0.0)
        made = {'kinematic': number % 2 == 0, 'actor': {**path, 'start': start}}
        shape = ELL if number == 3 else Box(width=0.2, height=0.3)
        spawn(sim, f'cart/{number}', shape, pose, **made)
    robot = {
        'drive': {'kind': 'differential', 'max_speed': 1.0},
        'odometry': {'slip': [0.02, 0.03]},
    }
    spawn(sim, 'robot/0', Disc(radius=0.1), (0.0, -0.5, 0.0), robot=robot, actor=path)
    later = {
        200: [DriveRobot(name='robot/0', velocity=(0.3, 0.0, 1.0))],
        300: [ChangeBody(name='cart/0', properties=Properties(actor={**path, 'repeat': 'once'}))],
        350: [Delete(name='gate/0'), Delete(name='person/0')],
    }
    return sim, later


def _platforms():
    """Laws 75 and 76: what rises through one-way platforms, falls onto them and rolls to rest."""
    sim = simulation()
    walls(sim, -4.0, 0.0, 4.0, 12.0)
    for number in range(3):
        said = {'anchored': True, 'one_way': (0.0, 1.0), 'closed_sides': number == 1}
        pose = (number - 1.0, 1.0 + number, 0.1 * number)
        spawn(sim, f'platform/{number}', Box(width=3.0, height=0.2), pose, **said)
    shapes = (Disc(radius=0.2), Box(width=0.4, height=0.3), ELL)
    for number in range(12):
        said = {'velocity': (0.3 * (number % 3 - 1), 9.0), 'rolling_resistance': 0.05}
        pose = (0.5 * number - 3.0, 0.4 + 0.02 * number, 0.0)
        spawn(sim, f'thrown/{number}', shapes[number % 3], pose, **said)
    return sim, {300: [Delete(name='platform/0')]}


def _eventful():
    """Everything at once: bodies come and go, and the world itself is set otherwise."""
    sim = simulation()
    walls(sim, -4.0, 0.0, 4.0, 12.0)
    chance = random.Random(26)
    there, later = [], {}
    shapes = (Disc(radius=0.3), Box(width=0.6, height=0.4), ELL, PAIR)
    for number in range(60):
        at = chance.randrange(4, LENGTH - 4)
        name = f'body/{number}'
        pose = (chance.uniform(-3, 2), chance.uniform(1, 9), chance.uniform(-3, 3))
        lifetime = chance.choice((0.0, 0.0, 1.5))
        spawned = Spawn(name=name, shape=shapes[number % 4], pose=pose, lifetime=lifetime)
        later.setdefault(at, []).append(spawned)
        if not lifetime:
            there.append((at, name))
    for since, name in chance.sample(there, 15):
        later.setdefault(chance.randrange(since + 1, LENGTH), []).append(Delete(name=name))
    for changes in (
        {'gravity': (2.0, -5.0)},
        {'iterations': 20},
        {'damping': 0.3},
        {'bounds': (-3.5, -1.0, 4.0, 12.0)},
        {'gravity': (0.0, -G), 'friction': 0.1},
    ):
        later.setdefault(chance.randrange(LENGTH), []).append(Configure(changes=changes))
    return sim, later


SCENES = {
    'pyramid of 105': _pyramid,
    'robots on a floor': _robots,
    'actors': _actors,
    'one-way platforms': _platforms,
    'all kinds of requests': _eventful,
}


QUICK = ('one-way platforms', 'all kinds of requests')


def history_of(name):
    """Return a scene as a history: step by step, then sought and played on, and shown backward."""
    sim, later = SCENES[name]()
    chance, now = random.Random(name), 0
    operations = [
        ('begin', 240.0, 60.0, CHECKPOINTS, False),
        ('ask', Restore(state=sim.save())),
    ]
    for step in (*sorted(later), LENGTH):
        operations += [('run', 0.25, step - now), *(('ask', each) for each in later.get(step, ()))]
        now = step
    # Among them the steps of the checkpoints, and those beside them.
    steps = [*chance.sample(range(LENGTH), 4), 0, 239, 240, 241, 481, LENGTH]
    chance.shuffle(steps)
    for step in steps:
        # At whole speeds only every fourth step is shown, and all are made.
        speed = chance.choice((0.25, 1.0, 3.0))
        frames = min(60, int((LENGTH - step) / 4 / speed))
        operations += [('seek', step / LENGTH), ('run', speed, frames)]
    return [*operations, ('seek', 1.0), ('run', -0.25, LENGTH + 1), ('run', 0.25, LENGTH)]


@pytest.mark.parametrize('name', [name if name in QUICK else slow(name) for name in SCENES])
def test_each_step_is_shown_again_as_it_is_when_its_requests_are_played_from_nothing(report, name):
    difference = difference_of(history_of(name))

    report.check(26, f'{name}: shown otherwise later', bool(difference), 0, 0, 'scenes')
    assert not difference
