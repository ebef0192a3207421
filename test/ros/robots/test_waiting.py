# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A world in lockstep waits for the answer of a controller to a scan, where there will be one."""

from __future__ import annotations

from builtin_interfaces.msg import Time
from geometry_msgs.msg import TwistStamped
from physsim_ros.model.requests import Spawn
from physsim_ros.model.shapes import Disc
from physsim_ros.ros.robots.lockstep import Lockstep
from physsim_ros.simulation.entries import Origin, TakeBack
from physsim_ros.testing import PhysSim
import pytest
from sensor_msgs.msg import LaserScan

from .driver import Driver, driver_of
from ..journey import SECOND
from ...client import Client, set_parameter, stamp_of


def test_a_scan_after_a_rewind_waits_for_an_answer_of_its_own(flat: PhysSim) -> None:
    flat.robot('turtlebot3_burger')
    driver = driver_of(flat, looks=True, kind=TwistStamped)
    flat.run(2.0)
    commands = flat.node.fleet.scene_robots.topics['robot/0'].drive_topic
    assert len(driver.scans) > 5
    assert commands.awaited is None
    driver.hear = lambda _: None  # type: ignore[method-assign] # it hears, and does not answer
    driver.destroy_subscription(next(iter(driver.subscriptions)))
    driver.create_subscription(LaserScan, '/robot_0/scan', driver.hear, 10)
    flat.rewind(1.0)
    flat.run(0.5)
    assert commands.awaited is not None
    assert commands.awaited <= 1.5e9


def test_a_scan_with_a_latency_is_answered_by_the_stamp_of_its_measurement(flat: PhysSim) -> None:
    laser = {'kind': 'laser', 'beams': 4, 'latency': 0.15}
    flat.robot({'from': 'turtlebot3_burger', 'sensors': [laser]})
    driver = driver_of(flat, looks=True, kind=TwistStamped)
    flat.run(2.0)
    assert len(driver.scans) > 5
    assert flat.node.fleet.scene_robots.topics['robot/0'].drive_topic.awaited is None


def test_of_several_lasers_the_first_one_that_is_heard_is_answered(
    flat: PhysSim, client: Client
) -> None:
    lasers = [{'kind': 'laser', 'name': name, 'beams': 4} for name in ('front', 'rear')]
    flat.robot({'from': 'turtlebot3_burger', 'sensors': lasers})
    flat.add(Driver(flat.context, kind=TwistStamped, looks=False))
    commands = flat.node.fleet.scene_robots.topics['robot/0'].drive_topic
    rear = client.listen(LaserScan, '/robot_0/rear')
    flat.run(0.5)
    assert commands.awaited == stamp_of(rear[-1])
    front = client.listen(LaserScan, '/robot_0/front')
    flat.run(until=lambda: front and stamp_of(rear[-1]) > stamp_of(front[-1]))
    assert commands.awaited == stamp_of(front[-1])


def test_a_controller_is_not_waited_for_with_a_scan_from_before_it_came(
    flat: PhysSim, client: Client
) -> None:
    flat.robot('turtlebot3_burger')
    scans = client.listen(LaserScan, '/robot_0/scan')
    set_parameter(flat, 'lockstep', 1e3)
    flat.run(1.0)
    assert scans
    driver = Driver(flat.context, kind=TwistStamped, looks=False)
    flat.add(driver)
    assert not flat.node.fleet.lockstep.waits()
    count = len(scans)
    while len(scans) == count:
        flat.node.loop.advance_frame()
        flat.settle()
    assert flat.node.fleet.lockstep.waits()
    driver.send(0.2, stamp=scans[-1].header.stamp)
    flat.settle()
    assert not flat.node.fleet.lockstep.waits()


@pytest.fixture
def waiting(flat: PhysSim) -> PhysSim:
    """Give a world in which a robot has a scan that its stamped controller has not answered."""
    flat.robot('turtlebot3_burger')
    driver = Driver(flat.context, kind=TwistStamped)
    driver.send = lambda *_, **__: None  # type: ignore[method-assign] # it hears, and is silent
    flat.add(driver)
    flat.run(1.0)
    set_parameter(flat, 'lockstep', 1e3)
    assert flat.node.fleet.lockstep.waits()
    return flat


def test_a_frozen_past_does_not_wait_for_an_answer(waiting: PhysSim) -> None:
    set_parameter(waiting, 'robots_in_past', 'freeze')
    waiting.rewind(0.5)
    assert not waiting.node.fleet.lockstep.waits()
    waiting.run(0.4)
    assert not waiting.node.fleet.lockstep.waits()


def test_each_scan_is_waited_for_once(waiting: PhysSim) -> None:
    # The wait of 1,000 s becomes a short one, which ends.
    set_parameter(waiting, 'lockstep', 1e-6)
    waiting.wait_until(lambda: not waiting.node.fleet.lockstep.waits())
    set_parameter(waiting, 'lockstep', 1e3)
    assert not waiting.node.fleet.lockstep.waits()
    # A frame without a scan.
    waiting.step()
    assert not waiting.node.fleet.lockstep.waits()
    set_parameter(waiting, 'lockstep', 0.0)
    waiting.run(0.2)
    set_parameter(waiting, 'lockstep', 1e3)
    assert waiting.node.fleet.lockstep.waits()


def test_a_past_that_is_simulated_again_is_no_row_of_frames_for_controllers(
    flat: PhysSim, monkeypatch: pytest.MonkeyPatch
) -> None:
    simulation = flat.node.simulation
    spawn = Spawn(name='a/0', shape=Disc(radius=0.1))
    simulation.requests.submit(spawn, Origin('~/spawn', author='Anna'))
    flat.run(10.0)
    monkeypatch.setattr(Lockstep, 'is_on', True)
    simulation.requests.submit(TakeBack(), Origin('~/undo', author='Anna'))
    ticks = 0
    while simulation.past.cursor.is_amending or len(simulation.world):
        flat.node.loop.tick(ticks * SECOND // 60)
        ticks += 1
    # Of 600 frames; a tick makes as many as there is time for.
    assert ticks < 100


def test_a_rewind_does_not_wait_for_a_controller_that_is_silent(waiting: PhysSim) -> None:
    set_parameter(waiting, 'speed', -1.0)
    for frame in range(40):
        waiting.node.tick(round(1e12 + frame * SECOND / 60))
    assert waiting.time == pytest.approx(0.4, abs=0.05)


@pytest.mark.parametrize('service', ['reset', 'undo', 'clear'])
def test_a_service_that_takes_a_scan_or_its_robot_away_ends_the_wait(
    waiting: PhysSim, client: Client, service: str
) -> None:
    waiting.node.tick(0)
    assert client.call(f'~/{service}').success
    waiting.node.tick(SECOND // 60)
    assert waiting.names == ()
    assert not waiting.node.fleet.lockstep.waits()
    waiting.node.tick(2 * SECOND // 60)
    waiting.node.tick(3 * SECOND // 60)
    assert waiting.time == pytest.approx(1.0 * (service == 'clear'), abs=0.1)


def test_commands_without_a_stamp_are_not_waited_for(waiting: PhysSim) -> None:
    sender = Driver(waiting.context, kind=TwistStamped, looks=False)
    sender.send(0.1)
    waiting.settle()
    assert not waiting.node.fleet.lockstep.waits()
    waiting.run(1.0)
    sender.send(0.1, stamp=Time(nanosec=1))
    waiting.settle()
    assert waiting.node.fleet.lockstep.waits()
