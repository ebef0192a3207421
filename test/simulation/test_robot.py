# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Robots of a simulation without ROS: driven, read, reset, and continued from a saved moment."""

from collections.abc import Callable
from copy import copy
import math
import pickle

import numpy as np
from physsim_ros import (
    Box,
    Delete,
    Disc,
    find_world,
    load_world,
    Properties,
    Robot,
    robot_spawn,
    SavedMoment,
    Simulation,
    Spawn,
    WorldSettings,
)
from physsim_ros.model.errors import BadProperty, InPast, OutOfHistory, UnknownBody
from physsim_ros.model.requests import Configure, Grab
from physsim_ros.simulation.entries import Origin
import pytest

NOISY = {'from': 'turtlebot3_burger', 'odometry': {'slip': [0.05, 0.05]}}


def corridor(**options: float) -> Robot:
    simulation = Simulation(**options)
    simulation.load(load_world(find_world('corridor')))
    simulation.perform(robot_spawn(NOISY))
    simulation.load(simulation.save())
    return Robot(simulation, 'robot/0')


def wander(robot: Robot, periods: int) -> list[object]:
    """Drive into walls and along them; return all that is read."""
    readings: list[object] = []
    for period in range(periods):
        robot.drive(0.22, 1.5 * math.sin(0.2 * period))
        robot.simulation.run(0.1)
        readings.append((robot.scan().tolist(), robot.odom(), robot.truth(), robot.bumped))
        readings.append(robot.read('imu'))
    return readings


def test_a_robot_drives_until_told_otherwise():
    robot = corridor()
    robot.drive(0.2)
    robot.simulation.run(3.0)
    assert robot.truth().twist == pytest.approx((0.2, 0.0, 0.0), abs=1e-6)
    assert robot.truth().pose[0] == pytest.approx(0.2 * 3.0, abs=0.02)
    robot.drive(0.0, 1.0)
    robot.simulation.run(1.0)
    assert robot.truth().twist == pytest.approx((0.0, 0.0, 1.0), abs=1e-6)
    assert robot.odom().pose != robot.truth().pose


def test_a_body_is_placed_at_rest_whether_it_is_anchored_or_not():
    simulation = Simulation()
    for name, properties in (
        ('post/0', Properties(anchored=True)),
        ('ball/0', Properties(velocity=(3.0, 0.0))),
    ):
        simulation.perform(Spawn(name=name, shape=Disc(radius=0.1), properties=properties))
        simulation.place(name, 5.0, 2.0, 0.5)
        snapshot = simulation.frame.snapshot
        row = snapshot.row(name)
        assert snapshot.poses[row].tolist() == [5.0, 2.0, 0.5]
        assert not snapshot.twists[row].any()
    with pytest.raises(UnknownBody, match="nearest is 'ball/0'"):
        simulation.place('bal/0', 0.0, 0.0)


def test_a_scan_measures_the_wall_ahead():
    robot = corridor()
    robot.place(0.0, 0.0, math.pi)
    scan = robot.scan()
    assert scan.shape == (360,)
    # The wall of 5 cm is at -0.6 m, the laser 32 mm behind the middle; noise of 1 cm.
    assert scan[0] == pytest.approx(0.6 - 0.025 + 0.032, abs=0.05)
    assert robot.scan('scan') is not scan
    assert np.array_equal(robot.scan('scan'), scan)


def test_a_robot_that_meets_a_wall_is_bumped():
    robot = corridor()
    robot.place(0.0, 0.0, math.pi)
    robot.drive(0.2)
    assert not robot.bumped
    robot.simulation.run(4.0)
    assert robot.bumped
    robot.drive(-0.2)
    robot.simulation.run(1.0)
    # It was, since it was read before.
    assert robot.bumped
    robot.simulation.run(0.1)
    assert not robot.bumped


@pytest.mark.parametrize('options', [{}, {'history': 0.0}, {'publish_rate': 10.0}])
def test_an_episode_is_repeated_by_its_seed(options):
    robot = corridor(**options)
    simulation = robot.simulation
    episodes = []
    for seed in (1, 2, 1):
        simulation.reset(seed)
        assert simulation.settings.seed == seed
        assert simulation.step == 0
        episodes.append(wander(robot, 40))
    assert episodes[0] == episodes[2]
    assert episodes[0] != episodes[1]


def test_a_reset_without_a_seed_has_the_noise_of_the_world():
    robot = corridor()
    first = wander(robot, 5)
    robot.simulation.reset()
    assert wander(robot, 5) == first
    robot.simulation.reset(7)
    robot.simulation.reset(8)
    robot.simulation.undo()
    assert robot.simulation.settings.seed == 7


def test_without_a_past_the_bits_are_the_same_and_no_frame_is_kept():
    kept, forgotten = corridor(), corridor(history=0.0)
    assert wander(kept, 60) == wander(forgotten, 60)
    assert kept.simulation.world.digest() == forgotten.simulation.world.digest()
    assert kept.simulation.past.frames.size > 0
    assert forgotten.simulation.past.frames.size == 0
    # Of the requests and checkpoints, those since the last checkpoint.
    assert forgotten.simulation.past.budget.used < kept.simulation.past.budget.used / 5
    forgotten.simulation.seek(forgotten.simulation.frame.snapshot.stamp)
    with pytest.raises(OutOfHistory):
        forgotten.simulation.seek(0)


def pickled(saved: SavedMoment) -> SavedMoment:
    return pickle.loads(pickle.dumps(saved))  # noqa: S301 - its own


@pytest.mark.parametrize('copied', [copy, pickled])
def test_a_saved_moment_is_continued_to_the_bit(copied):
    robot = corridor()
    simulation = robot.simulation
    # Against a wall, and with a box that it pushes.
    box = Spawn(
        name='box/0',
        shape=Box(width=0.2, height=0.2),
        pose=(0.3, 0.0, 0.1),
        properties=Properties(mass=0.5),
    )
    simulation.perform(box)
    wander(robot, 33)
    saved = copied(simulation.checkpoint())
    step, bumped, imu = simulation.step, robot.bumped, robot.read('imu')
    first = wander(robot, 60)
    digest = simulation.world.digest()
    for another in (simulation, Simulation(history=0.0)):
        another.restore(saved)
        assert another.applier.drives.commands['robot/0'] == saved.driving[0]
        again = Robot(another, 'robot/0')
        assert (another.step, again.bumped, again.read('imu')) == (step, bumped, imu)
        assert wander(again, 60) == first
        assert another.world.digest() == digest


def test_a_saved_moment_has_the_requests_that_waited_and_no_hand():
    simulation, another = Simulation(), Simulation()
    simulation.perform(Spawn(name='ball/0', shape=Disc(radius=0.2)))
    simulation.perform(Grab(hand='h', point=(0.0, 0.0)))
    simulation.requests.submit(Spawn(name='box/0', shape=Box(width=0.2, height=0.2)), topic='t')

    another.restore(simulation.checkpoint())

    assert 'box/0' in another.world
    for each in (simulation, another):
        assert not each.world.grips
        each.run(1.0)
    assert simulation.world.digest() == another.world.digest()


def test_a_moment_of_another_physics_rate_is_refused_and_changes_nothing():
    robot = corridor()
    robot.simulation.run(1.0)
    another = corridor(physics_rate=480.0).simulation
    digest = another.world.digest()

    with pytest.raises(BadProperty) as refused:
        another.restore(robot.simulation.checkpoint())

    assert refused.value.field == 'physics_rate'
    assert another.world.digest() == digest


# Ways to replace a world, by a robot in a used world and one in a fresh world. Both must be alike
# then.
BEGINNINGS: dict[str, Callable[[Robot, Robot], object]] = {
    'begin': lambda used, fresh: used.simulation.begin(fresh.simulation.loaded),
    'reset': lambda used, _: used.simulation.reset(),
    'open_world': lambda used, fresh: used.simulation.open_world(fresh.simulation.loaded),
    'restore': lambda used, fresh: used.simulation.restore(fresh.simulation.checkpoint()),
}


@pytest.mark.parametrize('name', BEGINNINGS)
def test_readings_after_a_beginning_depend_on_no_world_before_it(name):
    used, fresh = corridor(), corridor()
    fresh.simulation.begin(fresh.simulation.loaded)
    used.drive(-0.2, 1.0)
    used.simulation.run(1.0)
    used.read('imu')
    used.simulation.run(0.5)
    used.simulation.frames.is_read = False
    used.simulation.ticks.pass_frames(3)

    BEGINNINGS[name](used, fresh)

    for robot in (used, fresh):
        robot.drive(0.2)
        # Nobody reads the frames up to then.
        robot.simulation.run(2.0)
    for sensor in (each.name for each in fresh.description.sensors):
        np.testing.assert_equal(used.read(sensor), fresh.read(sensor))


@pytest.mark.parametrize('name', BEGINNINGS)
def test_requests_that_wait_are_of_the_world_before(name):
    used, fresh = corridor(), corridor()
    fresh.simulation.begin(fresh.simulation.loaded)
    used.simulation.requests.submit(Spawn(name='b/0', shape=Disc(radius=0.1)), topic='~/spawn')

    BEGINNINGS[name](used, fresh)

    used.simulation.run(0.1)
    assert 'b/0' not in used.simulation.world
    assert [each.subject for each in used.simulation.frame.answers] == ['b/0']


def test_a_restored_simulation_has_a_past_of_its_own_and_is_reset_as_the_first():
    robot = corridor()
    wander(robot, 20)
    saved = robot.simulation.checkpoint()
    simulation = Simulation()
    simulation.restore(saved)
    assert simulation.status.oldest == simulation.status.now == pytest.approx(2.0)
    robot = Robot(simulation, 'robot/0')
    wander(robot, 50)
    digest = simulation.world.digest()
    simulation.seek(3_000_000_000)
    with pytest.raises(InPast):
        simulation.checkpoint()
    simulation.seek(round(simulation.status.newest * 1e9))
    assert simulation.world.digest() == digest
    with pytest.raises(OutOfHistory):
        simulation.seek(1_000_000_000)
    simulation.reset()
    assert simulation.step == 0
    assert 'box/0' not in simulation.world
    assert Robot(simulation, 'robot/0').truth().pose == (0.0, 0.0, 0.0)


def test_a_checkpoint_in_a_running_history_can_be_rewound_over():
    robot = corridor()
    digests = {}
    for _ in range(10):
        wander(robot, 7)
        robot.simulation.checkpoint()
        digests[robot.simulation.frame.snapshot.stamp] = robot.simulation.world.digest()
    for stamp, digest in reversed(digests.items()):
        robot.simulation.seek(stamp)
        assert robot.simulation.world.digest() == digest
    assert not [answer for answer in robot.simulation.frame.answers if answer.code]


def test_a_robot_that_is_gone_is_not_driven_on():
    robot = corridor()
    robot.drive(0.2)
    robot.simulation.perform(Delete(name='robot/0'))
    robot.simulation.run(1.0)
    with pytest.raises(UnknownBody):
        robot.truth()
    # Nor is another one of its name.
    robot.simulation.perform(robot_spawn('turtlebot3_burger'))
    robot.simulation.run(1.0)
    assert robot.truth().pose == pytest.approx((0.0, 0.0, 0.0))


def test_a_robot_may_be_spawned_by_a_request_that_waits_behind_a_seek():
    simulation = Simulation(settings=WorldSettings(gravity=(0.0, 0.0)))
    simulation.run(1.0)
    simulation.requests.submit_seek(500_000_000, Origin('~/seek'))
    simulation.requests.submit(robot_spawn('turtlebot3_burger'), topic='~/spawn')
    Robot(simulation, 'robot/0').drive(0.2)
    assert 'robot/0' in simulation.world


def test_a_robot_that_drives_on_after_an_undo_leaves_what_there_is_to_redo():
    robot = corridor()
    robot.drive(0.2)
    robot.simulation.run(0.5)
    robot.simulation.perform(Spawn(name='b/0', shape=Disc(radius=0.1), pose=(0.0, 50.0, 0.0)))
    robot.simulation.run(1.0)

    robot.simulation.undo()
    robot.simulation.run(1.0)

    assert robot.truth().twist[0] == pytest.approx(0.2, abs=1e-6)
    robot.simulation.redo()
    assert 'b/0' in robot.simulation.world


def test_a_robot_without_a_drive_cannot_be_driven():
    robot = corridor()
    robot.simulation.perform(robot_spawn('arm', name='arm/0', at=(2.0, 0.0)))
    with pytest.raises(BadProperty, match='arm/0 has no drive'):
        Robot(robot.simulation, 'arm/0').drive(1.0)
    robot.simulation.perform(Delete(name='robot/0'))
    with pytest.raises(UnknownBody):
        robot.drive(1.0)
    assert not robot.simulation.applier.drives.commands


def queued_seek(simulation: Simulation, stamp: int) -> None:
    simulation.requests.submit_seek(stamp, Origin('~/seek'))
    simulation.apply_requests()


def another_course(simulation: Simulation) -> None:
    simulation.seek(BACK)
    simulation.perform(Configure(changes={'damping': 0.5}))
    Robot(simulation, 'robot/0').drive(0.2)
    simulation.return_to_course(1)


BACK = 500_000_000
ELSEWHERE: dict[str, Callable[[Simulation], object]] = {
    'another course': another_course,
    'another world': lambda it: it.load(load_world(find_world('boxes'))),
    'queued seek': lambda it: queued_seek(it, BACK),
    'rewind': lambda it: setattr(it, 'speed', -1.0),
    'seek': lambda it: it.seek(BACK),
}


@pytest.mark.parametrize('name', ELSEWHERE)
def test_another_moment_and_another_world_end_what_a_robot_is_held_to(name):
    robot = corridor()
    robot.drive(0.2)
    robot.simulation.run(1.0)
    ELSEWHERE[name](robot.simulation)
    assert not robot.simulation.applier.drives.commands


def test_a_queued_seek_that_is_refused_ends_no_drive():
    robot = corridor()
    robot.drive(0.2)
    queued_seek(robot.simulation, 99 * BACK)
    assert robot.simulation.applier.drives.commands


def test_what_is_no_robot_or_has_no_such_sensor_is_refused():
    robot = corridor()
    simulation = robot.simulation
    with pytest.raises(BadProperty, match='not a robot'):
        Robot(simulation, 'wall/0')
    with pytest.raises(UnknownBody, match='robots: robot/0'):
        Robot(simulation, 'robt/0')
    with pytest.raises(BadProperty, match="no sensor 'scam'; nearest is 'scan'"):
        robot.scan('scam')
    with pytest.raises(BadProperty, match='seconds'):
        simulation.run(-1.0)
    with pytest.raises(BadProperty):
        simulation.reset(-1)
    blind = Simulation(settings=WorldSettings(gravity=(0.0, 0.0)))
    blind.perform(robot_spawn('mouse'))
    with pytest.raises(BadProperty, match='no laser'):
        Robot(blind, 'robot/0').scan()
