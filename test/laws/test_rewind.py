# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 26: rewound to any step, a world plays on as it did the first time, to the bit."""

from hashlib import blake2b
import math
from pathlib import Path
import random

import numpy as np
from physsim_ros.files import load_world, save_world
from physsim_ros.model.body_properties import Properties
from physsim_ros.model.requests import (
    Anchor,
    ChangeBody,
    Command,
    Configure,
    Delete,
    DriveRobot,
    Release,
    Spawn,
)
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import Box, Compound, Disc, Polygon
from physsim_ros.simulation.simulation import Simulation
import pytest

from .scenes import floor, G, NOWHERE, pyramid, run, spawn, walls
from ..outside import run_python
from ..relations.scenes import (
    bounces,
    gas,
    incline,
    meetings,
    on_walls,
    projectiles,
    stack,
)
from ..slow import slow

# Simulation time from one checkpoint to the next [s]: at the default of 3 s each scene would have
# to be three times as long.
CHECKPOINTS = 1.0
# Steps: 3 s, and so two checkpoints after the first, and one at the end.
LENGTH = 720
# Frames of 4 steps by which a loaded world is compared: 2 s.
FRAMES = 120
ELL = Polygon(outline=((0.0, 0.0), (2.0, 0.0), (2.0, 0.5), (0.5, 0.5), (0.5, 2.0), (0.0, 2.0)))
PAIR = Compound(element=Disc(radius=0.2), centers=((0.0, 0.0), (1.0, 0.3)))


def _simulation(**settings):
    """Make an empty world that takes a checkpoint every second."""
    return Simulation(settings=WorldSettings(**settings), checkpoints=CHECKPOINTS)


# The worlds of the other laws, one of each kind, and what is asked of them on the way: step ->
# requests.


def _as(build, *args):
    """Return a scene of the relations, in a world that takes a checkpoint every second."""

    def scene():
        sim = _simulation()
        sim.begin(build(*args).save())
        return sim, {}

    return scene


def _comes_to_roll():
    """Law 13: a disc that is set sliding half a second after it was put down."""
    sim = _simulation(friction=0.3)
    floor(sim)
    spawn(sim, 'disc/0', Disc(radius=0.5), (0.0, 0.5, 0.0))
    return sim, {120: [Command(names=('disc/0',), twists=((5.0, 0.0, 0.0),))]}


def _pyramid():
    """Law 19: 105 boxes, one of which is shot at in the middle of it."""
    sim = _simulation()
    floor(sim)
    pyramid(sim, 0.5, 0.1)
    ball = Spawn(name='ball/0', shape=Disc(radius=0.3), pose=(-8.0, 2.0, 0.0))
    return sim, {350: [ball, Command(names=('ball/0',), twists=((20.0, 2.0, 0.0),))]}


def _anchored():
    """Law 24: an anchored body that is hit, let go, and held again."""
    sim = _simulation()
    walls(sim, -10.0, 0.0, 10.0, 20.0)
    spawn(sim, 'held/0', Box(width=0.4, height=0.4), (0.1, 2.0, 0.3), anchored=True)
    for number in range(5):
        at = (-2.0 - 2.0 * number, 2.0, 0.5)
        velocity = (20.0, 1.0)
        spawn(sim, f'hit/{number}', Disc(radius=0.3), at, mass=100.0, velocity=velocity)
    hold = Command(names=('held/0',), poses=((0.0, 3.0, 0.0),))
    return sim, {150: [Release(point=(0.1, 2.0))], 450: [hold, Anchor(point=(0.0, 3.0))]}


def _robots():
    """Laws 37 to 41: robots drive, push and stall on a floor with a conveyor."""
    sim = _simulation(gravity=NOWHERE, floor_friction=0.3, seed=26)
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
    sim = _simulation(gravity=NOWHERE, floor_friction=0.3, seed=26)
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
    sim = _simulation()
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
    sim = _simulation()
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
    'projectiles': _as(projectiles),
    'pairs that meet': _as(meetings),
    'walls, thin ones too': _as(on_walls),
    'bounces': _as(bounces),
    'incline': _as(incline),
    'disc that comes to roll': _comes_to_roll,
    '10 boxes': _as(stack, 10, 0.3),
    'pyramid of 105': _pyramid,
    '100 discs': _as(gas, 100),
    'anchored body': _anchored,
    'robots on a floor': _robots,
    'actors': _actors,
    'one-way platforms': _platforms,
    'all kinds of requests': _eventful,
}


class Player:
    """Plays a scene step by step, and holds what it showed the first time."""

    def __init__(self, scene):
        self.sim, self._later = scene()
        self._now = 0
        self.first = {0: self.sim.apply_requests().snapshot}
        self.digests = {}

    def show(self, speed, count):
        """Yield what is shown at a speed, so many times, or until time stops."""
        self.sim.speed = speed
        while count > 0 and self.sim.speed != 0.0:
            self._now += 16_666_667
            for frame in self.sim.advance(self._now):
                if frame.stepped and count > 0:
                    count -= 1
                    yield frame.snapshot
        self.sim.speed = 0.0

    def record(self, speed=0.25, digests_at=()):
        """Go through the scene for the first time, at a quarter of the speed each step shown."""
        self.sim.speed = speed
        while (step := self.sim.step) < LENGTH:
            for request in self._until(step):
                self.sim.perform(request)
            self._now += 16_666_667
            # The last frame of a step counts: with the requests made at it where time stood still
            # then, else without them.
            for frame in self.sim.advance(self._now):
                self.first[frame.snapshot.step] = frame.snapshot
            if self.sim.step in digests_at:
                self.digests[self.sim.step] = self.sim.world.digest()
        self.sim.speed = 0.0
        assert list(self.first) == list(range(0, LENGTH + 1, round(4 * speed) or 1))

    def _until(self, step):
        """Return the requests that are due, and no others again."""
        due = [at for at in sorted(self._later) if at <= step]
        return [request for at in due for request in self._later.pop(at)]

    def seek(self, step):
        """Go to a step, and return what is shown there."""
        self.sim.seek(round(step * 1e9 / 240))
        shown = self.sim.apply_requests().snapshot
        assert shown.step == step
        return shown

    def bits(self, shown):
        """Return in how many bits that differs from the first time."""
        # A step at which no frame of the first time ended is compared from its second frame on.
        first = self.first.setdefault(shown.step, shown)
        assert shown.scene.names == first.scene.names
        assert shown.stamp == first.stamp
        return sum(
            int(np.bitwise_count(one.view(np.uint64) ^ other.view(np.uint64)).sum())
            for one, other in ((first.poses, shown.poses), (first.twists, shown.twists))
        )


# In the air, in contact, and with requests on the way.
QUICK = ('projectiles', 'pairs that meet', 'one-way platforms', 'all kinds of requests')


@pytest.fixture(params=[name if name in QUICK else slow(name) for name in SCENES])
def scene(request):
    """Give the name of each scene in turn."""
    return request.param


def test_any_step_is_reached_again_and_played_on_from(report, scene):
    chance = random.Random(scene)
    # Among them the steps of the checkpoints, and those beside them.
    steps = [*chance.sample(range(LENGTH), 4), 0, 239, 240, 241, 481, LENGTH]
    chance.shuffle(steps)
    player = Player(SCENES[scene])
    player.record(digests_at=steps)

    reached = played = 0
    for step in steps:
        reached += player.bits(player.seek(step))
        if step in player.digests:
            assert player.sim.world.digest() == player.digests[step]
        # At whole speeds only every fourth step is shown, and all are made.
        speed = chance.choice((0.25, 1.0, 3.0))
        for snapshot in player.show(speed, min(100, int((LENGTH - step) / 4 / speed))):
            played += player.bits(snapshot)

    report.check(26, f'{scene}: at any step again', reached, 0, 0, 'bits')
    report.check(26, f'{scene}: played on from there', played, 0, 0, 'bits')


def test_each_step_is_shown_backward_as_it_was(report, scene):
    player = Player(SCENES[scene])
    # Three of four steps are not shown the first time: they are replayed, and equal at the second.
    player.record(1.0, digests_at=(LENGTH,))

    backward = forward = 0
    for _ in range(2):
        back = list(player.show(-0.25, LENGTH + 1))
        assert [snapshot.step for snapshot in back] == list(range(LENGTH - 1, -1, -1))
        backward += sum(player.bits(snapshot) for snapshot in back)
        forward += sum(player.bits(snapshot) for snapshot in player.show(0.25, LENGTH))
        assert player.sim.step == LENGTH
        assert player.sim.world.digest() == player.digests[LENGTH]

    report.check(26, f'{scene}: shown backward', backward, 0, 0, 'bits')
    report.check(26, f'{scene}: then played', forward, 0, 0, 'bits')


def hashes(sim):
    """Return a hash of every number of each frame that a world goes on by."""
    result = []
    for _ in range(FRAMES):
        snapshot = run(sim, 1 / 60)
        numbers = snapshot.poses.tobytes() + snapshot.twists.tobytes()
        result.append(blake2b(numbers, digest_size=8).hexdigest())
    return result


def go_on(*paths):
    """Print the hashes of saved worlds, a line each; that is what another process does."""
    for path in paths:
        print(*hashes(_loaded(path)))


def _loaded(path):
    """Return a simulation that begins with a saved world."""
    sim = _simulation()
    sim.begin(load_world(Path(path), settings=sim.settings, physics_rate=sim.physics_rate))
    return sim


def _elsewhere(paths):
    """Return the digests of saved worlds that go on in another process."""
    program = 'import sys; from test.laws.test_rewind import go_on; go_on(*sys.argv[1:])'
    return [line.split() for line in run_python('-c', program, *paths).splitlines()]


def _save(sim: Simulation, directory, name):
    """Save a world as the node does, and return the path of its file."""
    state = sim.save()
    return save_world(state, f'{name}.yaml', world_dir=directory, physics_rate=sim.physics_rate)


@pytest.mark.slow
def test_a_saved_world_goes_on_in_another_process_as_it_is_loaded_here(report, tmp_path):
    chance = random.Random(26)
    paths, here = [], []
    for number, scene in enumerate(SCENES.values()):
        sim, later = scene()
        for step in range(0, 4 * chance.randrange(30, 120), 4):
            for at in range(step, step + 4):
                for request in later.get(at, ()):
                    sim.perform(request)
            run(sim, 1 / 60)
        paths.append(_save(sim, tmp_path, number))
        loaded = _loaded(paths[-1])
        assert loaded.world.save() == sim.world.save()
        here.append(hashes(loaded))

    there = _elsewhere(paths)

    for scene, one, other in zip(SCENES, here, there, strict=True):
        different = sum(a != b for a, b in zip(one, other, strict=True))
        report.check(26, f'{scene}: saved, elsewhere', different, 0, 0, 'frames')
