# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Robots over topics: commands in, odometry and readings out, in the world of a test."""

from __future__ import annotations

from contextlib import ExitStack
from functools import partial
import math
from typing import Any

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.msg import Odometry
from physsim_ros.model.requests import DriveRobot, Request, Spawn
from physsim_ros.model.shapes import Disc
from physsim_ros.ros.node import PhysSimNode
from physsim_ros.ros.robots import Fleet
from physsim_ros.simulation.past import Past
from physsim_ros.simulation.request_queue import TakeBack
from physsim_ros.testing import box, delete, PhysSim, Refused, shared_context, UnknownName
import pytest
import rclpy
from rclpy.context import Context
from rclpy.time import Time as SimulationTime
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import Image, Imu, JointState, LaserScan, NavSatFix, Range
from std_msgs.msg import Bool

from .driver import Driver, yaw_of
from ..journey import Journey, SECOND
from ...client import Client, Event, set_parameter


@pytest.fixture
def flat(physsim: PhysSim) -> PhysSim:
    """Give a world that is seen from above."""
    set_parameter(physsim, 'gravity', [0.0, 0.0])
    return physsim


def heard(physsim: PhysSim, client: Client, kind: type, topic: str) -> list[Any]:
    messages: list[Any] = []
    client.node.create_subscription(kind, topic, messages.append, 10)
    client.spin_until(lambda: client.node.count_publishers(topic))
    physsim.settle()
    return messages


def stamp_of(message: Any) -> int:
    """Return the time of a message [ns]."""
    return SimulationTime.from_msg(message.header.stamp).nanoseconds


@pytest.mark.parametrize('kind', [Twist, TwistStamped])
def test_a_controller_drives_up_to_a_wall_and_stops(flat: PhysSim, kind: type) -> None:
    flat.spawn(box('wall/0', at=(3.0, 0.0), size=(0.2, 4.0), anchored=True))
    robot = flat.robot('turtlebot3_burger')
    driver = Driver(flat.context, kind=kind)
    flat.add(driver)
    assert not flat.run(until=lambda: robot.bumped, timeout=20.0)
    x = robot.truth().pose.pose.position.x
    assert x == pytest.approx(2.9 - 0.5 + 0.032, abs=0.06)
    assert abs(robot.truth().twist.twist.linear.x) < 1e-9
    # Five scans a second.
    assert len(driver.scans) == pytest.approx(100, abs=2)


def test_the_same_run_has_the_same_bits_and_a_rewind_repeats_it(flat: PhysSim) -> None:
    flat.spawn(box('wall/0', at=(2.0, 0.0), size=(0.2, 4.0), anchored=True))
    flat.robot('turtlebot3_burger')
    flat.add(Driver(flat.context))
    flat.run(5.0)
    first = flat.digest()
    flat.rewind(3.0)
    flat.run(3.0)
    assert flat.digest() == first


def test_a_rewind_shows_the_messages_of_the_way_there(journey: Journey, client: Client) -> None:
    physsim = journey.physsim
    set_parameter(physsim, 'gravity', [0.0, 0.0])
    physsim.robot('turtlebot3_burger').drive(0.2)
    topics = {'scan': LaserScan, 'odom': Odometry, 'joint_states': JointState}
    messages = {
        topic: heard(physsim, client, kind, f'/robot_0/{topic}') for topic, kind in topics.items()
    }
    journey.tick(60)
    there = {topic: each.copy() for topic, each in messages.items()}
    set_parameter(physsim, 'speed', -1.0)
    journey.tick(50)
    for topic, each in messages.items():
        count = len(there[topic])
        back = each[count:]
        assert len(back) >= 4
        assert [message for message in back if message not in there[topic]] == []


def test_a_test_steers_otherwise_after_a_rewind(flat: PhysSim) -> None:
    flat.spawn(box('wall/0', at=(1.0, 0.0), size=(0.2, 4.0), anchored=True))
    robot = flat.robot('turtlebot3_burger')
    robot.drive(0.2)
    assert flat.run(until=lambda: robot.bumped, timeout=10.0)
    flat.rewind(2.0)
    robot.drive(-0.2)
    assert not flat.run(until=lambda: robot.bumped, timeout=5.0)
    assert robot.truth().pose.pose.position.x < 0.5


def test_a_command_counts_for_its_timeout(flat: PhysSim, client: Client) -> None:
    robot = flat.robot({'from': 'turtlebot3_burger', 'drive': {'timeout': 0.5}})
    driver = Driver(flat.context, looks=False)
    flat.add(driver)
    driver.send(0.2)
    flat.run(0.4)
    assert robot.truth().twist.twist.linear.x == pytest.approx(0.2, abs=1e-6)
    flat.run(0.5)
    assert robot.truth().twist.twist.linear.x == pytest.approx(0.0, abs=1e-9)


def test_a_robot_that_stops_as_no_command_comes_is_told_once_and_one_that_was_stopped_not(
    flat: PhysSim, client: Client
) -> None:
    flat.robot('turtlebot3_burger')
    driver = Driver(flat.context, looks=False)
    flat.add(driver)

    def told() -> list[Event]:
        return [event for event in client.events if event.name == '/robot_0/cmd_vel']

    for speed in (0.2, 0.0):
        driver.send(speed)
        flat.run(0.3)
    flat.run(1.0)
    assert not told()
    for _ in range(2):
        driver.send(0.2)
        flat.run(1.0)
    (event,) = told()
    assert event.code == 'ok'
    assert 'for 0.5 s' in event.message


@pytest.mark.parametrize('kind', [Twist, TwistStamped])
def test_commands_are_listed_before_anybody_publishes_where_the_process_is_the_nodes_own(
    monkeypatch: pytest.MonkeyPatch, kind: type
) -> None:
    own = partial(PhysSimNode, expected_commands=Twist)
    monkeypatch.setattr('physsim_ros.testing.world.PhysSimNode', own)
    other = Context()
    with (
        shared_context(monkeypatch) as context,
        PhysSim(context, gravity=[0.0, 0.0]) as sim,
        ExitStack() as closing,
    ):
        robot, client = sim.robot('turtlebot3_burger'), Client(sim)
        listed = dict(client.node.get_topic_names_and_types())
        assert listed['/robot_0/cmd_vel'] == ['geometry_msgs/msg/Twist']
        rclpy.init(context=other, domain_id=context.get_domain_id(), args=[])
        closing.callback(other.try_shutdown)
        driver = Driver(other, kind=kind, looks=False)

        def drives() -> bool:
            driver.send(0.2)
            sim.step()
            return bool(robot.truth().twist.twist.linear.x == pytest.approx(0.2, abs=1e-6))

        client.spin_until(drives)


def test_every_topic_has_its_type_and_rate(flat: PhysSim, client: Client) -> None:
    sensors = [
        {'kind': 'laser', 'name': 'scan', 'beams': 8, 'rate': 10},
        {'kind': 'range', 'name': 'sonar', 'radiation': 'sonar', 'rate': 20},
        {'kind': 'bumper', 'name': 'bumper', 'rate': 30},
        {'kind': 'imu', 'name': 'imu', 'rate': 60, 'gravity': 9.81},
        {'kind': 'gps', 'rate': 5, 'noise': 0.5},
        {'kind': 'joint_states', 'name': 'joint_states', 'rate': 30},
        {'kind': 'floor', 'name': 'eye', 'pixels': 5, 'rate': 15},
    ]
    robot = flat.robot({'from': 'turtlebot3_burger', 'sensors': sensors}, name='tb3/0')
    kinds = {
        'odom': (Odometry, 30),
        'ground_truth': (Odometry, 60),
        'scan': (LaserScan, 10),
        'sonar': (Range, 20),
        'bumper': (Bool, 30),
        'imu': (Imu, 60),
        'fix': (NavSatFix, 5),
        'joint_states': (JointState, 30),
        'eye': (Image, 15),
    }
    messages = {
        topic: heard(flat, client, kind, f'/tb3_0/{topic}') for topic, (kind, _) in kinds.items()
    }
    robot.drive(0.2, 0.1)
    flat.run(1.0)
    for topic, (_, rate) in kinds.items():
        assert len(messages[topic]) == pytest.approx(rate, abs=1), topic
    assert messages['scan'][0].header.frame_id == 'tb3_0/scan'
    assert len(messages['eye'][0].data) == 15
    assert messages['imu'][-1].linear_acceleration.z == 9.81
    # There is no datum.
    assert messages['fix'][-1].status.status == -1
    assert math.isnan(messages['fix'][-1].latitude)
    set_parameter(flat, 'datum', [48.0, 11.5])
    flat.run(1.0)
    fix = messages['fix'][-1]
    assert (fix.status.status, fix.position_covariance[0]) == (0, 0.25)
    assert (fix.latitude, fix.longitude) == pytest.approx((48.0, 11.5), abs=1e-4)
    odom = messages['odom'][-1]
    assert (odom.header.frame_id, odom.child_frame_id) == ('tb3_0/odom', 'tb3_0/base_footprint')
    assert min(odom.pose.covariance[place] for place in (0, 7, 35)) > 0.0
    # The wheels turn as fast as the floor goes by below them.
    rates = messages['joint_states'][-1].velocity
    assert rates[0] == pytest.approx((0.2 - 0.1 * 0.08) / 0.033, rel=1e-6)
    assert rates[1] == pytest.approx((0.2 + 0.1 * 0.08) / 0.033, rel=1e-6)


def test_what_nobody_reads_is_not_made(flat: PhysSim, monkeypatch: pytest.MonkeyPatch) -> None:
    from physsim_ros.ros.robots import messages  # noqa: PLC0415 - it is replaced here

    def fail(*_: object) -> None:
        pytest.fail('nobody reads the scan')

    flat.robot('turtlebot3_burger')
    reading = messages.READINGS[messages.Laser]._replace(message=fail)
    monkeypatch.setitem(messages.READINGS, messages.Laser, reading)
    flat.run(1.0)


def test_odometry_without_slip_is_the_way_and_truth_is_the_pose(flat: PhysSim) -> None:
    robot = flat.robot({'from': 'turtlebot3_burger', 'odometry': {'slip': [0, 0]}}, at=(1, 2, 0.5))
    robot.drive(0.2, 0.5)
    flat.run(3.0)
    odom, truth = robot.odom().pose.pose, robot.truth().pose.pose
    x, y = odom.position.x, odom.position.y
    turned = (
        1.0 + math.cos(0.5) * x - math.sin(0.5) * y,
        2.0 + math.sin(0.5) * x + math.cos(0.5) * y,
    )
    assert turned == pytest.approx((truth.position.x, truth.position.y), abs=1e-6)
    assert yaw_of(truth.orientation) - yaw_of(odom.orientation) == pytest.approx(0.5, abs=1e-6)


def test_commands_in_the_past_are_refused_once_and_nothing_branches(
    flat: PhysSim, client: Client
) -> None:
    flat.robot('turtlebot3_burger')
    driver = Driver(flat.context, looks=False)
    flat.add(driver)
    driver.send(0.2)
    flat.run(3.0)
    after = flat.digest()
    flat.rewind(2.0)
    client.events.clear()
    for _ in range(30):
        driver.send(0.0, 1.0)
        flat.step()
    flat.run(1.5)
    assert [event.code for event in client.events if event.code != 'ok'] == ['in_past']
    assert flat.node.simulation.status.course == 1
    assert flat.digest() == after


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf])
def test_commands_that_are_not_finite_are_refused_once(
    flat: PhysSim, client: Client, value: float
) -> None:
    robot = flat.robot('turtlebot3_burger')
    driver = Driver(flat.context, looks=False)
    flat.add(driver)
    client.events.clear()
    for _ in range(5):
        driver.send(value)
        flat.step()
    (event,) = [event for event in client.events if event.code != 'ok']
    assert (event.code, event.name, event.hardware_id) == (
        'malformed',
        '/robot_0/cmd_vel',
        'robot/0',
    )
    assert robot.truth().twist.twist.linear.x == 0.0
    # Good commands between them change nothing; another refusal is told, and one after many.
    for speed in (*(0.0, value) * 5, 1e9, value, *(0.0,) * 60, value):
        driver.send(speed)
        flat.step()
    codes = [event.code for event in client.events if event.code != 'ok']
    assert codes == ['malformed', 'bad_property', 'malformed']


def test_a_flood_of_commands_costs_one_request_a_frame(flat: PhysSim) -> None:
    robot = flat.robot('turtlebot3_burger')
    driver = Driver(flat.context, looks=False)
    flat.add(driver)
    before = flat.node.simulation.requests.gesture
    for number in range(5000):
        driver.send(0.1 if number < 4999 else 0.2)
        if number % 8 == 0:
            flat.settle()
    flat.run(0.4)
    assert robot.truth().twist.twist.linear.x == pytest.approx(0.2, abs=1e-6)
    assert flat.node.simulation.requests.gesture == before


def test_publishers_of_both_types_are_told_and_one_is_heard_then_the_other(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # One participant has one type for a topic.
    others = Context(), Context()
    with (
        shared_context(monkeypatch) as context,
        PhysSim(context, gravity=[0.0, 0.0]) as sim,
        ExitStack() as closing,
    ):
        for other in others:
            rclpy.init(context=other, domain_id=context.get_domain_id(), args=[])
            closing.callback(other.try_shutdown)
        robot, client = sim.robot('turtlebot3_burger'), Client(sim)
        plain = Driver(others[0], looks=False)
        stamped = Driver(others[1], kind=TwistStamped, looks=False)

        def drives(driver: Driver, speed: float) -> bool:
            driver.send(speed)
            sim.step()
            return bool(robot.truth().twist.twist.linear.x == pytest.approx(speed, abs=1e-6))

        known = partial(sim.node.get_publishers_info_by_topic, '/robot_0/cmd_vel')
        client.spin_until(lambda: len(known()) == 2)
        client.spin_until(lambda: drives(plain, 0.2))
        told = [event for event in client.events if event.field == 'cmd_vel']
        assert [event.code for event in told] == ['bad_property']
        plain.destroy_publisher(plain.publisher)
        client.spin_until(lambda: drives(stamped, -0.1))


def test_a_publisher_of_another_type_than_commands_is_told_once(
    flat: PhysSim, client: Client
) -> None:
    flat.robot('turtlebot3_burger')
    client.node.create_publisher(Bool, '/robot_0/cmd_vel', 10)
    flat.run(0.5)
    (event,) = [event for event in client.events if event.code != 'ok']
    assert (event.code, event.field) == ('bad_property', 'cmd_vel')
    assert 'std_msgs/msg/Bool' in event.message


def test_topics_go_with_the_robot_and_come_back_with_undo(flat: PhysSim, client: Client) -> None:
    robot = flat.robot('turtlebot3_burger')
    node = client.node
    client.spin_until(lambda: node.count_publishers('/robot_0/scan'))
    flat.spawn(delete('robot/0'))
    client.spin_until(lambda: not node.count_publishers('/robot_0/scan'))
    assert not flat.node.fleet.robots
    flat.node.simulation.undo()
    flat.node.apply_requests()
    client.spin_until(lambda: node.count_publishers('/robot_0/scan'))
    robot.drive(0.1)
    flat.run(0.5)
    assert robot.truth().pose.pose.position.x > 0.03


def test_many_robots_leave_nothing(flat: PhysSim) -> None:
    entities = len(list(flat.node.publishers)), len(list(flat.node.subscriptions))
    for number in range(100):
        flat.robot('turtlebot3_burger', name='robot/0', at=(number, 0.0))
        flat.spawn(delete('robot/0'))
    assert (len(list(flat.node.publishers)), len(list(flat.node.subscriptions))) == entities


def test_two_robots_of_one_namespace_are_refused(flat: PhysSim) -> None:
    flat.robot('turtlebot3_burger', namespace='')
    with pytest.raises(Refused) as caught:
        flat.robot('omni', name='other/0', at=(2.0, 0.0), namespace='')
    assert caught.value.field == 'namespace'
    assert flat.names == ('robot/0',)


def test_a_robot_of_the_empty_namespace_has_plain_topics(flat: PhysSim, client: Client) -> None:
    flat.robot('turtlebot3_burger', namespace='')
    messages = heard(flat, client, LaserScan, '/scan')
    flat.run(0.5)
    assert messages[0].header.frame_id == 'scan'


def test_frozen_robots_say_nothing_of_the_past(flat: PhysSim, client: Client) -> None:
    set_parameter(flat, 'robots_in_past', 'freeze')
    flat.robot('turtlebot3_burger')
    messages = heard(flat, client, Odometry, '/robot_0/ground_truth')
    clocks = heard(flat, client, Clock, '/clock')
    flat.run(2.0)
    flat.rewind(1.0)
    messages.clear()
    flat.run(0.5)
    assert not messages
    flat.run(1.0)
    assert messages
    # Time does not go back for the nodes of robots.
    stamps = [1e9 * clock.clock.sec + clock.clock.nanosec for clock in clocks]
    assert stamps == sorted(stamps)
    assert stamps[-1] == 2.5e9


def test_a_topic_that_another_type_has_is_refused_and_the_others_are_there(
    flat: PhysSim, client: Client
) -> None:
    entities = len(list(flat.node.publishers))
    client.events.clear()
    flat.robot(
        {'from': 'turtlebot3_burger', 'sensors': [{'kind': 'laser', 'name': 'poses'}]},
        namespace='physsim',
    )
    messages = heard(flat, client, Odometry, '/physsim/ground_truth')
    flat.run(0.5)
    assert messages
    (event,) = [event for event in client.events if event.code != 'ok']
    assert (event.code, event.name, event.field) == ('bad_property', '/physsim/poses', 'name')
    flat.spawn(delete('robot/0'))
    assert len(list(flat.node.publishers)) == entities


def test_the_last_command_of_a_node_that_has_gone_counts(flat: PhysSim) -> None:
    robot = flat.robot('turtlebot3_burger')
    driver = Driver(flat.context, looks=False)
    flat.add(driver)
    driver.send(0.2)
    flat.settle()
    driver.destroy_publisher(driver.publisher)
    flat.run(0.3)
    assert robot.truth().twist.twist.linear.x == pytest.approx(0.2, abs=1e-6)


def test_a_scan_after_a_rewind_waits_for_an_answer_of_its_own(flat: PhysSim) -> None:
    flat.robot('turtlebot3_burger')
    driver = Driver(flat.context, kind=TwistStamped)
    flat.add(driver)
    flat.run(2.0)
    commands = flat.node.fleet.robots['robot/0'].commands
    assert len(driver.scans) > 5
    assert commands.awaited is None
    driver.hear = lambda _: None  # type: ignore[method-assign] # it hears, and does not answer
    driver.destroy_subscription(next(iter(driver.subscriptions)))
    driver.create_subscription(LaserScan, '/robot_0/scan', driver.hear, 10)
    flat.rewind(1.0)
    flat.run(0.5)
    assert commands.awaited is not None
    assert commands.awaited <= 1.5e9


def test_of_several_lasers_the_first_one_that_is_heard_is_answered(
    flat: PhysSim, client: Client
) -> None:
    lasers = [{'kind': 'laser', 'name': name, 'beams': 4} for name in ('front', 'rear')]
    flat.robot({'from': 'turtlebot3_burger', 'sensors': lasers})
    flat.add(Driver(flat.context, kind=TwistStamped, looks=False))
    commands = flat.node.fleet.robots['robot/0'].commands
    rear = heard(flat, client, LaserScan, '/robot_0/rear')
    flat.run(0.5)
    assert commands.awaited == stamp_of(rear[-1])
    front = heard(flat, client, LaserScan, '/robot_0/front')
    flat.run(until=lambda: front and stamp_of(rear[-1]) > stamp_of(front[-1]))
    assert commands.awaited == stamp_of(front[-1])


@pytest.fixture
def waiting(flat: PhysSim) -> PhysSim:
    """Give a world in which a robot has a scan that its stamped controller has not answered."""
    flat.robot('turtlebot3_burger')
    driver = Driver(flat.context, kind=TwistStamped)
    driver.send = lambda *_, **__: None  # type: ignore[method-assign] # it hears, and is silent
    flat.add(driver)
    flat.run(1.0)
    set_parameter(flat, 'lockstep', 1e3)
    assert flat.node.fleet.is_waiting
    return flat


def test_a_controller_is_not_waited_for_with_a_scan_from_before_it_came(
    flat: PhysSim, client: Client
) -> None:
    flat.robot('turtlebot3_burger')
    scans = heard(flat, client, LaserScan, '/robot_0/scan')
    set_parameter(flat, 'lockstep', 1e3)
    flat.run(1.0)
    assert scans
    driver = Driver(flat.context, kind=TwistStamped, looks=False)
    flat.add(driver)
    assert not flat.node.fleet.is_waiting
    count = len(scans)
    while len(scans) == count:
        flat.node.advance_frame()
        flat.settle()
    assert flat.node.fleet.is_waiting
    driver.send(0.2, stamp=scans[-1].header.stamp)
    flat.settle()
    assert not flat.node.fleet.is_waiting


def test_a_frozen_past_does_not_wait_for_an_answer(waiting: PhysSim) -> None:
    set_parameter(waiting, 'robots_in_past', 'freeze')
    waiting.rewind(0.5)
    assert not waiting.node.fleet.is_waiting
    waiting.run(0.4)
    assert not waiting.node.fleet.is_waiting


def test_each_scan_is_waited_for_once(waiting: PhysSim) -> None:
    # The wait of 1,000 s becomes a short one, which ends.
    set_parameter(waiting, 'lockstep', 1e-6)
    waiting.wait_until(lambda: not waiting.node.fleet.is_waiting)
    set_parameter(waiting, 'lockstep', 1e3)
    assert not waiting.node.fleet.is_waiting
    # A frame without a scan.
    waiting.step()
    assert not waiting.node.fleet.is_waiting
    set_parameter(waiting, 'lockstep', 0.0)
    waiting.run(0.2)
    set_parameter(waiting, 'lockstep', 1e3)
    assert waiting.node.fleet.is_waiting


def test_a_past_that_is_simulated_again_is_no_row_of_frames_for_controllers(
    flat: PhysSim, monkeypatch: pytest.MonkeyPatch
) -> None:
    simulation = flat.node.simulation
    spawn = Spawn(name='a/0', shape=Disc(radius=0.1))
    simulation.requests.submit(spawn, topic='~/spawn', author='Anna')
    flat.run(10.0)
    monkeypatch.setattr(Fleet, 'in_lockstep', True)
    simulation.requests.submit(TakeBack(), topic='~/undo', author='Anna')
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
    assert not waiting.node.fleet.is_waiting
    waiting.node.tick(2 * SECOND // 60)
    waiting.node.tick(3 * SECOND // 60)
    assert waiting.time == pytest.approx(1.0 * (service == 'clear'), abs=0.1)


def test_commands_without_a_stamp_are_not_waited_for(waiting: PhysSim) -> None:
    sender = Driver(waiting.context, kind=TwistStamped, looks=False)
    sender.send(0.1)
    waiting.settle()
    assert not waiting.node.fleet.is_waiting
    waiting.run(1.0)
    sender.send(0.1, stamp=Time(nanosec=1))
    waiting.settle()
    assert waiting.node.fleet.is_waiting


def test_a_robot_that_is_not_there_has_no_readings(flat: PhysSim) -> None:
    flat.run(1.0)
    robot = flat.robot('turtlebot3_burger')
    flat.run(1.0)
    odometry = robot.odom()
    flat.seek(0.5)
    for read in (robot.odom, robot.truth, robot.scan):
        with pytest.raises(UnknownName, match='there is no robot'):
            read()
    flat.run(1.5)
    assert robot.odom() == odometry


def test_a_world_that_is_loaded_is_not_driven_by_the_robots_before_it(flat: PhysSim) -> None:
    robot = flat.robot('turtlebot3_burger')
    robot.drive(0.2)
    flat.run(0.5)
    flat.load('boxes')
    assert robot.name in flat.names
    flat.run(0.5)
    assert robot.truth().twist.twist.linear.x == 0.0


@pytest.fixture
def submitted(flat: PhysSim, monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Give a test the times at which robots are driven on [s]."""
    times: list[float] = []
    apply = Past.apply_unasked

    def note(past: Past, request: Request) -> None:
        if isinstance(request, DriveRobot):
            times.append(flat.time)
        apply(past, request)

    monkeypatch.setattr(Past, 'apply_unasked', note)
    return times


@pytest.mark.parametrize('timeout', [0.0, 0.02, 0.5])
def test_a_drive_is_submitted_again_before_its_timeout(
    flat: PhysSim, submitted: list[float], timeout: float
) -> None:
    robot = flat.robot(
        {'from': 'turtlebot3_burger', 'drive': {'timeout': timeout}, 'odometry': {'slip': [0, 0]}},
    )
    robot.drive(0.2)
    speeds = []
    for _ in range(120):
        flat.step()
        speeds.append(robot.truth().twist.twist.linear.x)
    # It is there after 0.1 s, and no timeout is met.
    assert speeds[12:] == pytest.approx([0.2] * 108, rel=1e-6)
    assert len(submitted) == {0.0: 1, 0.02: 120, 0.5: 4}[timeout]
    robot.drive(0.0)
    flat.run(1.0)
    assert robot.truth().twist.twist.linear.x == pytest.approx(0.0, abs=1e-6)


def test_a_drive_counts_again_after_the_command_of_another_node(flat: PhysSim) -> None:
    robot = flat.robot('turtlebot3_burger', namespace='tb')
    node = rclpy.create_node('other', context=flat.context)
    publisher = node.create_publisher(Twist, '/tb/cmd_vel', 1)
    flat.add(node)
    robot.drive(0.2)
    flat.run(0.5)
    other = Twist()
    other.linear.x = -0.2
    publisher.publish(other)
    flat.step()
    robots = flat.node.simulation.world.snapshot().robots
    assert robots['aim'][0, 0] == -0.2
    flat.step()
    robots = flat.node.simulation.world.snapshot().robots
    assert robots['aim'][0, 0] == 0.2
    node.destroy_node()


def test_of_two_handles_of_a_robot_the_later_one_drives(
    flat: PhysSim, submitted: list[float]
) -> None:
    first = flat.robot('turtlebot3_burger')
    second = flat.find_robot(first.name)
    first.drive(0.2)
    second.drive(0.1)
    flat.run(0.4)
    assert len(submitted) == 1
    assert first.truth().twist.twist.linear.x == pytest.approx(0.1, rel=1e-6)


def test_a_robot_without_a_shipped_name_is_refused(flat: PhysSim) -> None:
    with pytest.raises(Refused, match='name a shipped robot') as caught:
        flat.robot({'drive': {'kind': 'omni'}})
    assert caught.value.field == 'from'


def test_the_covariance_of_the_twist_is_that_of_its_speed(flat: PhysSim) -> None:
    robot = flat.robot(
        {'from': 'turtlebot3_burger', 'odometry': {'slip': [0.01, 0.02], 'rate': 30}}
    )
    robot.drive(0.2)
    flat.run(1.0)
    covariance = robot.odom().twist.covariance
    assert (covariance[0], covariance[35]) == pytest.approx((0.01**2 * 6.0, 0.02**2 * 6.0))
    # Across there is no noise, and a localiser takes 0 for unknown.
    assert covariance[7] == 1e-9
    flat.run(5.0)
    assert robot.odom().twist.covariance[0] == pytest.approx(covariance[0])
    robot.drive(0.0)
    flat.run(1.0)
    odometry = robot.odom()
    assert max(odometry.twist.covariance[0], odometry.twist.covariance[35]) <= 1e-9
    assert odometry.pose.covariance[0] > 1e-5


def test_a_robot_of_a_world_file_is_found_and_driven(flat: PhysSim) -> None:
    flat.load('boxes')
    robot = flat.find_robot('robot/0')
    start = robot.truth().pose.pose.position.x
    robot.drive(0.1)
    flat.run(1.0)
    assert robot.truth().pose.pose.position.x > start + 0.05
    with pytest.raises(UnknownName, match="nearest is 'robot/0'"):
        flat.find_robot('robt/0')
