# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Commands of robots over topics: which counts, which is refused, which types are heard."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager, ExitStack
from functools import partial
from itertools import pairwise
import math
import os
import signal
import sys
from typing import Any, NamedTuple

from geometry_msgs.msg import Twist, TwistStamped
from physsim_ros.ros import topics
from physsim_ros.ros.node import PhysSimNode
from physsim_ros.ros.robots import command_topic, type_choice
from physsim_ros.ros.topics import LOSSLESS
from physsim_ros.testing import PhysSim, shared_context
import pytest
from rclpy.topic_endpoint_info import TopicEndpointInfo
from std_msgs.msg import Bool

from .driver import driver_of
from ...client import Client, Event, set_parameter
from ...outside import Program, ROOT


def test_a_robot_that_stops_as_no_command_comes_is_told_once_and_one_that_was_stopped_not(
    flat: PhysSim, client: Client
) -> None:
    flat.robot('turtlebot3_burger')
    driver = driver_of(flat)

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


def test_a_refusal_is_told_again_after_fifty_commands_in_a_row() -> None:
    class Topic(command_topic.CommandTopic):
        take = close = None

    topic, told = Topic('cmd_vel'), []
    for carried_out in (0, 49, 49, 50, 49):
        for _ in range(carried_out):
            topic.note_carried_out()
        told.append(topic.note_refused('malformed'))
    assert told == [True, False, False, True, False]


@pytest.mark.parametrize(('timeout', 'speed'), [(-1.0, 0.0), (0.0, 0.2), (2.0, 0.2)])
def test_a_parameter_sets_the_timeout_of_all_drives(
    flat: PhysSim, timeout: float, speed: float
) -> None:
    robot = flat.robot('turtlebot3_burger')
    set_parameter(flat, 'drive_timeout', timeout)
    driver = driver_of(flat)
    driver.send(0.2)
    flat.run(1.5)
    assert robot.truth().twist.twist.linear.x == pytest.approx(speed, abs=1e-6)
    after = flat.digest()
    flat.rewind(1.0)
    flat.run(1.0)
    assert flat.digest() == after


@pytest.mark.parametrize('kind', ['Twist', 'TwistStamped'])
def test_commands_are_listed_before_anybody_publishes_where_the_process_is_the_nodes_own(
    monkeypatch: pytest.MonkeyPatch, kind: str
) -> None:
    own = partial(PhysSimNode, expected_commands=Twist)
    monkeypatch.setattr('physsim_ros.testing.world.PhysSimNode', own)
    with crossing(monkeypatch) as drive:
        listed = dict(drive.client.node.get_topic_names_and_types())
        assert listed['/robot_0/cmd_vel'] == ['geometry_msgs/msg/Twist']
        drive.command(kind, 0.2)
        drive.wait_for_speed(0.2)


def test_commands_in_the_past_are_refused_once_and_nothing_branches(
    flat: PhysSim, client: Client
) -> None:
    flat.robot('turtlebot3_burger')
    driver = driver_of(flat)
    driver.send(0.2)
    flat.run(3.0)
    after = flat.digest()
    flat.rewind(2.0)
    client.events.clear()
    for _ in range(30):
        driver.send(0.0, 1.0)
        flat.step()
    flat.run(1.5)
    assert [event.code for event in client.refusals] == ['in_past']
    assert flat.node.simulation.status.course == 1
    assert flat.digest() == after


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf])
def test_commands_that_are_not_finite_are_refused_once(
    flat: PhysSim, client: Client, value: float
) -> None:
    robot = flat.robot('turtlebot3_burger')
    driver = driver_of(flat)
    client.events.clear()
    for _ in range(5):
        driver.send(value)
        flat.step()
    (event,) = client.refusals
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
    codes = [event.code for event in client.refusals]
    assert codes == ['malformed', 'bad_property', 'malformed']


def test_a_command_of_a_megabyte_is_refused_before_it_is_decoded(
    flat: PhysSim, client: Client, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot = flat.robot('turtlebot3_burger')
    driver = driver_of(flat, kind=TwistStamped)
    driver.send(0.1)
    flat.step(2)
    client.events.clear()
    with monkeypatch.context() as patched:
        patched.setattr(topics, 'deserialize_message', lambda *_: pytest.fail('decoded'))
        long = TwistStamped()
        long.header.frame_id = 'x' * command_topic.MOST_BYTES
        driver.publisher.publish(long)
        flat.step(2)
    assert [event.code for event in client.refusals] == ['malformed']
    # The command before it holds.
    assert robot.truth().twist.twist.linear.x == pytest.approx(0.1)
    driver.send(0.0)
    flat.step(10)
    assert robot.truth().twist.twist.linear.x == 0.0


def test_a_flood_of_commands_costs_one_request_a_frame(flat: PhysSim) -> None:
    robot = flat.robot('turtlebot3_burger')
    driver = driver_of(flat)
    before = flat.node.simulation.requests.gesture
    for number in range(1000):
        driver.send(0.1 if number < 999 else 0.2)
        if number % 8 == 0:
            flat.settle()
    flat.run(0.4)
    assert robot.truth().twist.twist.linear.x == pytest.approx(0.2, abs=1e-6)
    assert flat.node.simulation.requests.gesture == before


@contextmanager
def crossing(monkeypatch: pytest.MonkeyPatch) -> Iterator[Crossing]:
    """Yield a robot in a world that other processes may command."""
    with (
        shared_context(monkeypatch) as context,
        PhysSim(context, gravity=[0.0, 0.0]) as sim,
        ExitStack() as closing,
    ):
        yield Crossing(sim.robot('turtlebot3_burger'), Client(sim), closing)


class Crossing(NamedTuple):
    robot: Any
    client: Client
    closing: ExitStack

    def command(self, kind: str, speed: float) -> Program:
        """Start a process that commands a speed from now on, by messages of a type."""
        path = ROOT / 'test' / 'elsewhere' / 'commander.py'
        program = Program(sys.executable, path, kind, speed, env=dict(os.environ), cwd=ROOT)
        self.closing.callback(program.close)
        return program

    def wait_for_speed(self, speed: float) -> None:
        """Advance until the robot has a speed [m/s]."""

        def drives() -> bool:
            self.client.physsim.step()
            return bool(self.robot.truth().twist.twist.linear.x == pytest.approx(speed, abs=1e-6))

        self.client.spin_until(drives)


@pytest.mark.parametrize(
    ('old', 'new', 'silenced'),
    [
        ('Twist', 'TwistStamped', signal.SIGSTOP),
        ('TwistStamped', 'Twist', signal.SIGKILL),
        ('Twist', 'TwistStamped', signal.SIGTERM),
    ],
)
def test_of_publishers_of_both_types_the_newest_is_heard_as_long_as_it_speaks(
    monkeypatch: pytest.MonkeyPatch, old: str, new: str, silenced: int
) -> None:
    with crossing(monkeypatch) as drive:
        drive.command(old, 0.2)
        drive.wait_for_speed(0.2)
        newest = drive.command(new, -0.1)
        drive.wait_for_speed(-0.1)
        newest.process.send_signal(silenced)
        drive.wait_for_speed(0.2)
        told = [event for event in drive.client.events if event.field == 'cmd_vel']
    assert [event.code for event in told] == ['bad_property'], told
    assert 'the newest is heard' in told[0].message


def test_publishers_of_both_types_have_longer_and_longer_to_find_a_subscription(
    flat: PhysSim, monkeypatch: pytest.MonkeyPatch
) -> None:
    robot = flat.robot('turtlebot3_burger')
    flat.step()
    topic = flat.node.fleet.scene_robots.topics[robot.name].drive_topic
    publishers = [
        TopicEndpointInfo(
            topic_type=f'geometry_msgs/msg/{name}', endpoint_gid=[number], qos_profile=LOSSLESS
        )
        for number, name in enumerate(('Twist', 'TwistStamped'))
    ]
    monkeypatch.setattr(flat.node, 'get_publishers_info_by_topic', lambda _: publishers)
    changes, kind = [], None
    for look in range(80):
        monkeypatch.setattr(type_choice, 'monotonic', lambda look=look: 0.5 * look)
        topic.match_publishers()
        flat.settle()
        heard = [each for each in flat.node.subscriptions if each.topic_name == '/robot_0/cmd_vel']
        if heard and heard[0].msg_type is not kind:
            kind = heard[0].msg_type
            changes.append(look)
    waits = [after - before for before, after in pairwise(changes)]
    assert waits == sorted(waits)
    assert 0.5 * waits[-1] > 4.0


def test_a_publisher_of_another_type_than_commands_is_told_once(
    flat: PhysSim, client: Client
) -> None:
    # Fast DDS keeps one pool of buffers for a topic's name in a process: a robot of another name
    # leaves room for the larger commands of the tests that follow.
    flat.robot('turtlebot3_burger', name='odd/0')
    client.node.create_publisher(Bool, '/odd_0/cmd_vel', 10)
    flat.run(0.5)
    (event,) = client.refusals
    assert (event.code, event.field) == ('bad_property', 'cmd_vel')
    assert 'std_msgs/msg/Bool' in event.message


def test_the_last_command_of_a_node_that_has_gone_counts(flat: PhysSim) -> None:
    robot = flat.robot('turtlebot3_burger')
    driver = driver_of(flat)
    driver.send(0.2)
    flat.settle()
    driver.destroy_publisher(driver.publisher)
    flat.run(0.3)
    assert robot.truth().twist.twist.linear.x == pytest.approx(0.2, abs=1e-6)
