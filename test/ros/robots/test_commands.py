# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Commands of robots over topics: which counts, which is refused, which types are heard."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack
from functools import partial
import math
from typing import Any, NamedTuple

from geometry_msgs.msg import Twist, TwistStamped
from physsim_ros.ros.node import PhysSimNode
from physsim_ros.ros.robots import command_topic
from physsim_ros.testing import PhysSim, shared_context
import pytest
import rclpy
from rclpy.context import Context
from std_msgs.msg import Bool

from .driver import Driver, driver_of
from ...client import Client, Event, set_parameter


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
        patched.setattr(command_topic, 'deserialize_message', lambda *_: pytest.fail('decoded'))
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


@pytest.fixture
def crossing(monkeypatch: pytest.MonkeyPatch) -> Iterator[Crossing]:
    """Return a robot in a world, and contexts of two other processes in its domain."""
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
        yield Crossing(sim, sim.robot('turtlebot3_burger'), Client(sim), others)


class Crossing(NamedTuple):
    sim: PhysSim
    robot: Any
    client: Client
    others: tuple[Context, Context]

    def knows(self, count: int) -> bool:
        """Return whether as many publishers of commands are on the graph."""
        return len(self.sim.node.get_publishers_info_by_topic('/robot_0/cmd_vel')) == count

    def drives(self, driver: Driver, speed: float, *beside: Driver) -> bool:
        """Return whether the robot obeys a driver beside others that stop it, after a frame."""
        for other in beside:
            other.send(0.0)
        driver.send(speed)
        self.sim.step()
        return bool(self.robot.truth().twist.twist.linear.x == pytest.approx(speed, abs=1e-6))


@pytest.mark.parametrize('dies', [False, True])
def test_publishers_of_both_types_are_told_and_one_is_heard_as_long_as_it_speaks(
    crossing: Crossing, dies: bool
) -> None:
    client = crossing.client
    plain = Driver(crossing.others[0], looks=False)
    stamped = Driver(crossing.others[1], kind=TwistStamped, looks=False)
    client.spin_until(lambda: crossing.knows(2))
    client.spin_until(lambda: crossing.drives(plain, 0.2))
    told = [event for event in client.events if event.field == 'cmd_vel']
    assert [event.code for event in told] == ['bad_property']
    if not dies:
        plain.destroy_publisher(plain.publisher)
    client.spin_until(lambda: crossing.drives(stamped, -0.1))
    told = [event for event in client.events if event.field == 'cmd_vel']
    assert len(told) == 1


@pytest.mark.parametrize('kinds', [(Twist, TwistStamped), (TwistStamped, Twist)])
def test_the_newest_publisher_is_heard_while_one_of_another_type_still_speaks(
    crossing: Crossing, kinds: tuple[type, type]
) -> None:
    client = crossing.client
    old = Driver(crossing.others[0], kind=kinds[0], looks=False)
    client.spin_until(lambda: crossing.drives(old, 0.2))
    new = Driver(crossing.others[1], kind=kinds[1], looks=False)
    client.spin_until(lambda: crossing.drives(new, -0.1, old))
    # It is heard until it is silent.
    client.spin_until(lambda: crossing.drives(old, 0.2))


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
