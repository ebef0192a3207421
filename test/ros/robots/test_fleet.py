# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Topics of robots: when they are there, what they tell at which rate, and of which past."""

from __future__ import annotations

import math
import time

from geometry_msgs.msg import PoseArray, Twist
from nav_msgs.msg import Odometry
from physsim_ros.model.requests import DeleteAll
from physsim_ros.ros import frame_loop
from physsim_ros.ros.node_without_qos_events import NodeWithoutQosEvents
from physsim_ros.ros.robots import scene_robots
from physsim_ros.testing import box, delete, PhysSim
import pytest
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import BatteryState, Image, Imu, JointState, LaserScan, NavSatFix, Range
from std_msgs.msg import Bool
from visualization_msgs.msg import Marker

from .driver import driver_of
from ..journey import Journey
from ...building import DISC, spawning
from ...client import Client, set_parameter, stamp_of


def test_a_controller_drives_up_to_a_wall_and_stops(flat: PhysSim) -> None:
    flat.spawn(box('wall/0', at=(3.0, 0.0), size=(0.2, 4.0), anchored=True))
    robot = flat.robot('turtlebot3_burger')
    driver = driver_of(flat, looks=True)
    assert not flat.run(until=lambda: robot.bumped, timeout=20.0)
    x = robot.truth().pose.pose.position.x
    assert x == pytest.approx(2.9 - 0.5 + 0.032, abs=0.06)
    assert abs(robot.truth().twist.twist.linear.x) < 1e-9
    # Five scans a second.
    assert len(driver.scans) == pytest.approx(100, abs=2)


def test_the_same_run_has_the_same_bits_and_a_rewind_repeats_it(flat: PhysSim) -> None:
    flat.spawn(box('wall/0', at=(2.0, 0.0), size=(0.2, 4.0), anchored=True))
    flat.robot('turtlebot3_burger')
    driver_of(flat, looks=True)
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
    messages = {topic: client.listen(kind, f'/robot_0/{topic}') for topic, kind in topics.items()}
    journey.tick(60)
    there = {topic: each.copy() for topic, each in messages.items()}
    set_parameter(physsim, 'speed', -1.0)
    journey.tick(50)
    for topic, each in messages.items():
        count = len(there[topic])
        back = each[count:]
        assert len(back) >= 4
        assert [message for message in back if message not in there[topic]] == []


def test_every_topic_has_its_type_and_rate(flat: PhysSim, client: Client) -> None:
    sensors = [
        {'kind': 'laser', 'name': 'scan', 'beams': 8, 'rate': 10},
        {'kind': 'range', 'name': 'sonar', 'radiation': 'sonar', 'rate': 20, 'noise': 0.01},
        {'kind': 'bumper', 'name': 'bumper', 'rate': 30},
        {'kind': 'imu', 'name': 'imu', 'rate': 60, 'gravity': 9.81},
        {'kind': 'gps', 'rate': 5, 'noise': 0.5, 'status': 'gbas'},
        {'kind': 'landmarks', 'name': 'beacons', 'bodies': ['post/0', 'gone/0'], 'rate': 12},
        {'kind': 'joint_states', 'name': 'joint_states', 'rate': 30},
        {'kind': 'floor', 'name': 'eye', 'pixels': 5, 'rate': 15},
    ]
    robot = flat.robot({'from': 'turtlebot3_burger', 'sensors': sensors}, name='tb3/0')
    flat.spawn(box('post/0', at=(0.0, 3.0), size=(0.2, 0.2), anchored=True))
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
        'beacons': (PoseArray, 12),
    }
    messages = {
        topic: client.listen(kind, f'/tb3_0/{topic}') for topic, (kind, _) in kinds.items()
    }
    robot.drive(0.2, 0.1)
    flat.run(1.0)
    for topic, (_, rate) in kinds.items():
        assert len(messages[topic]) == pytest.approx(rate, abs=1), topic
    assert messages['scan'][0].header.frame_id == 'tb3_0/scan'
    assert len(messages['eye'][0].data) == 15
    assert messages['sonar'][0].variance == pytest.approx(0.01**2)
    assert messages['imu'][-1].linear_acceleration.z == 9.81
    post, gone = (pose.position for pose in messages['beacons'][0].poses)
    assert messages['beacons'][0].header.frame_id == 'tb3_0/beacons'
    assert (post.x, post.y) == pytest.approx((0.0, 3.0), abs=0.1)
    assert math.isnan(gone.x)
    assert math.isnan(gone.y)
    # There is no datum.
    assert messages['fix'][-1].status.status == -1
    assert math.isnan(messages['fix'][-1].latitude)
    set_parameter(flat, 'datum', [48.0, 11.5])
    flat.run(1.0)
    fix = messages['fix'][-1]
    assert (fix.status.status, fix.position_covariance[0]) == (2, 0.25)
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
    kind = messages.SENSOR_MESSAGES[messages.Laser]._replace(message=fail)
    monkeypatch.setitem(messages.SENSOR_MESSAGES, messages.Laser, kind)
    flat.run(1.0)


def test_topics_go_with_the_robot_and_come_back_with_undo(flat: PhysSim, client: Client) -> None:
    robot = flat.robot('turtlebot3_burger')
    node = client.node
    client.spin_until(lambda: node.count_publishers('/robot_0/scan'))
    flat.spawn(delete('robot/0'))
    client.spin_until(lambda: not node.count_publishers('/robot_0/scan'))
    assert not flat.node.fleet.scene_robots.topics
    flat.node.simulation.undo()
    flat.node.loop.apply_requests()
    client.spin_until(lambda: node.count_publishers('/robot_0/scan'))
    robot.drive(0.1)
    flat.run(0.5)
    assert robot.truth().pose.pose.position.x > 0.03


def test_many_robots_leave_nothing(flat: PhysSim) -> None:
    entities = len(list(flat.node.publishers)), len(list(flat.node.subscriptions))
    for number in range(20):
        flat.robot('turtlebot3_burger', name='robot/0', at=(number, 0.0))
        flat.spawn(delete('robot/0'))
    assert (len(list(flat.node.publishers)), len(list(flat.node.subscriptions))) == entities


def test_a_robot_of_the_empty_namespace_has_plain_topics(flat: PhysSim, client: Client) -> None:
    flat.robot('turtlebot3_burger', namespace='')
    messages = client.listen(LaserScan, '/scan')
    flat.run(0.5)
    assert messages[0].header.frame_id == 'scan'


def test_frozen_robots_say_nothing_of_the_past(flat: PhysSim, client: Client) -> None:
    set_parameter(flat, 'robots_in_past', 'freeze')
    flat.robot('turtlebot3_burger')
    messages = client.listen(Odometry, '/robot_0/ground_truth')
    clocks = client.listen(Clock, '/clock')
    flat.run(2.0)
    flat.rewind(1.0)
    messages.clear()
    flat.run(0.5)
    assert not messages
    flat.run(1.0)
    assert messages
    # Time does not go back for the nodes of robots.
    stamps = [stamp_of(clock) for clock in clocks]
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
    messages = client.listen(Odometry, '/physsim/ground_truth')
    flat.run(0.5)
    assert messages
    (event,) = client.refusals
    assert (event.code, event.name, event.field) == ('bad_property', '/physsim/poses', 'name')
    flat.spawn(delete('robot/0'))
    assert len(list(flat.node.publishers)) == entities


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


def test_a_robot_obeys_the_topic_of_its_key_and_no_other(flat: PhysSim) -> None:
    robot = flat.robot(
        {'from': 'turtlebot3_burger', 'namespace': '', 'command_topic': 'base/command'}
    )
    topics = [f'/{topic}' for topic in ('cmd_vel', 'base/command')]
    node = NodeWithoutQosEvents('commander', context=flat.context)
    for topic, speed in zip(topics, (0.0, 0.2), strict=True):
        publisher = node.create_publisher(Twist, topic, 10)
        flat.add(node)
        command = Twist()
        command.linear.x = 0.2
        publisher.publish(command)
        flat.run(0.4)
        assert robot.truth().twist.twist.linear.x == pytest.approx(speed, abs=1e-6)


def test_a_battery_is_told_and_charged_on_a_dock(flat: PhysSim, client: Client) -> None:
    battery = {'capacity': 0.01, 'level': 0.5, 'docks': ['dock/0'], 'charging': 9.0, 'rate': 10}
    flat.robot({'from': 'turtlebot3_burger', 'battery': battery})
    states = client.listen(BatteryState, '/robot_0/battery_state')
    flat.run(1.0)
    state = states[-1]
    assert state.percentage == pytest.approx(0.5 - 0.2 / 36.0, abs=0.01)
    assert (state.voltage, state.present) == (12.0, True)
    assert state.current == pytest.approx(-0.2)
    assert state.power_supply_status == BatteryState.POWER_SUPPLY_STATUS_DISCHARGING
    assert state.header.frame_id == 'robot_0/base_link'
    flat.spawn(box('dock/0', at=(0.0, 0.0), size=(1.0, 1.0), anchored=True, sensor=True))
    flat.run(1.0)
    assert states[-1].power_supply_status == BatteryState.POWER_SUPPLY_STATUS_CHARGING
    flat.run(3.0)
    assert states[-1].power_supply_status == BatteryState.POWER_SUPPLY_STATUS_FULL
    assert states[-1].charge == pytest.approx(0.01)


def test_topics_of_many_robots_are_made_and_taken_back_tick_by_tick(
    flat: PhysSim, monkeypatch: pytest.MonkeyPatch
) -> None:
    # Those of 200 robots stopped the world for a second, and those of none for half a second.
    node = flat.node
    monkeypatch.setattr(scene_robots, '_MOST_UPDATE_NS', 0)
    monkeypatch.setattr(frame_loop, 'MOST_TICK_NS', 0)
    node.start()
    drive = {'drive': {'kind': 'omni'}}
    for number in range(5):
        robot = spawning(f'robot/{number}', DISC, (number, 0.0, 0.0), robot=drive)
        node.simulation.requests.submit(robot, topic='~/spawn')
    node.simulation.applier.apply_all()

    def counts_until(count: int) -> list[int]:
        counts: list[int] = []
        while not counts or counts[-1] != count:
            step = node.simulation.step
            node.tick(time.monotonic_ns())
            counts.append(len(node.fleet.scene_robots.topics))
            # Time waits.
            assert counts[-1] in (0, 5) or node.simulation.step == step
        return counts

    assert counts_until(5)[-5:] == [1, 2, 3, 4, 5]
    node.simulation.requests.submit(DeleteAll(), topic='~/clear')
    assert counts_until(0)[-5:] == [4, 3, 2, 1, 0]
    # Who asks for a frame gets it with all topics.
    node.simulation.undo()
    flat.step()
    assert [*node.fleet.scene_robots.topics] == [f'robot/{number}' for number in range(5)]


def test_topics_that_cannot_be_taken_back_leave_the_other_robots_theirs(flat: PhysSim) -> None:
    def fail() -> None:
        raise RuntimeError('topics of old')

    for name in ('a/0', 'b/0'):
        flat.robot('turtlebot3_burger', name=name)
    flat.node.fleet.scene_robots.topics['a/0'].close = fail
    with pytest.raises(RuntimeError, match='topics of old'):
        flat.spawn(Marker(action=Marker.DELETEALL))
    flat.step()
    assert not flat.node.fleet.scene_robots.topics
