# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Inertial measurement units: turn rate and acceleration as felt, against the formulas."""

import math

from physsim_ros.model.requests import Configure, Delete
from physsim_ros.model.robots.sensors import Imu
from physsim_ros.sensing.motion import read_imu
import pytest

from .worlds import add_robot, plane, seen
from ..building import command, DT, spawn, unlimit_wrenches


def readings(world, row, imu, steps=60):
    before = world.snapshot()
    world.step(steps)
    return read_imu(world.snapshot(), before, row, imu)


def test_a_push_is_felt_in_the_axes_of_the_robot():
    world = plane()
    row = add_robot(world, pose=(0.0, 0.0, math.pi / 2), mass=2.0)
    unlimit_wrenches(world)
    command(world, 'robot/0', wrench=(0.0, 3.0, 0.0))

    felt = readings(world, row, Imu())

    assert felt.acceleration == pytest.approx((1.5, 0.0), abs=1e-9)
    assert felt.turn_rate == 0.0
    assert felt.yaw == math.pi / 2


def test_off_the_centre_of_a_turn_the_centripetal_acceleration_is_felt():
    world = plane()
    row = add_robot(world, spin=2.0)

    felt = readings(world, row, Imu(at=(0.5, 0.0, 0.0)), steps=2)

    # The mean over two steps, in the axes of a step ago; the chord of an arc is shorter.
    ahead, aside = felt.acceleration
    assert ahead == pytest.approx(-(2.0**2) * 0.5, rel=1e-4)
    assert aside == pytest.approx(0.0, abs=1e-9)
    assert felt.yaw == pytest.approx(2.0 * 2 * DT)
    assert felt.turn_rate == pytest.approx(2.0)


def test_a_turn_that_grows_is_felt_in_the_axes_of_its_mean():
    world = plane()
    row = add_robot(world, mass=2.0)
    unlimit_wrenches(world)
    command(world, 'robot/0', wrench=(3.0, 0.0, 0.01))

    felt = readings(world, row, Imu())

    # Of the turn since before, half at the mean of the rates.
    ago = felt.yaw - felt.turn_rate * 60 * DT / 4.0
    assert felt.turn_rate > 0.1
    along = 1.5 * math.cos(ago), -1.5 * math.sin(ago)
    assert felt.acceleration == pytest.approx(along, abs=1e-9)


def test_a_pose_that_is_set_is_no_turn_of_the_axes():
    world = plane()
    world.apply(Configure(changes={'gravity': (0.0, -9.81)}))
    row = add_robot(world)
    before = world.snapshot()
    world.step(4)
    command(world, 'robot/0', pose=(0.0, 0.0, 1.0), twist=(0.0, 0.0, 0.0))

    felt = read_imu(world.snapshot(), before, row, Imu())

    up = 9.81 * math.sin(1.0), 9.81 * math.cos(1.0)
    assert felt.acceleration == pytest.approx(up)


def test_in_free_fall_nothing_is_felt_and_at_rest_the_weight_is():
    world = plane()
    world.apply(Configure(changes={'gravity': (0.0, -9.81)}))
    row = add_robot(world)
    still = world.snapshot()

    felt = readings(world, row, Imu())

    assert felt.acceleration == pytest.approx((0.0, 0.0), abs=1e-9)
    assert read_imu(still, None, row, Imu()).acceleration == pytest.approx((0.0, 9.81))
    assert read_imu(still, still, row, Imu()).acceleration == pytest.approx((0.0, 9.81))


def test_a_robot_that_was_not_there_before_has_no_acceleration():
    world = plane()
    spawn(world, 'thing/0')
    before = world.snapshot()
    row = add_robot(world, pose=(5.0, 0.0, 0.0), velocity=[1.0, 0.0])
    world.step(1)

    assert read_imu(world.snapshot(), before, row, Imu()).acceleration == (0.0, 0.0)


def test_the_row_of_a_body_may_change():
    world = plane()
    spawn(world, 'thing/0', pose=(9.0, 9.0, 0.0))
    row = add_robot(world, mass=1.0)
    unlimit_wrenches(world)
    command(world, 'robot/0', wrench=(1.0, 0.0, 0.0))
    before = world.snapshot()
    world.apply(Delete(name='thing/0'))
    world.step(10)

    felt = read_imu(world.snapshot(), before, row - 1, Imu())

    # Stamps are whole nanoseconds.
    assert felt.acceleration == pytest.approx((1.0, 0.0), abs=1e-7)


def test_noise_is_that_of_the_seed():
    world = plane()
    row = add_robot(world)
    imu = Imu(noise=(0.1, 0.01))

    felt = read_imu(seen(world, 1), None, row, imu)

    assert felt == read_imu(seen(world, 1), None, row, imu)
    assert felt != read_imu(seen(world, 2), None, row, imu)
    assert 0.0 < abs(felt.turn_rate) < 0.06
    assert 0.0 < math.hypot(*felt.acceleration) < 0.9
