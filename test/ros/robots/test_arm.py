# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""An arm is commanded and read by the topics that controllers and RViz use."""

from __future__ import annotations

import math
from typing import Any
from xml.etree import ElementTree as ET

from builtin_interfaces.msg import Duration
from physsim_ros.ros import topics
from physsim_ros.testing import PhysSim
import pytest
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, String
from trajectory_msgs.msg import JointTrajectory, JointTrajectoryPoint

from ...client import Client, KEPT

JOINTS = ['shoulder', 'elbow']
BELOW = '/robot_0'


class Arm:
    """A client of an arm."""

    def __init__(self, flat: PhysSim, client: Client) -> None:
        flat.robot('arm')
        self.flat, self.client = flat, client
        self.states: list[JointState] = []
        client.node.create_subscription(JointState, f'{BELOW}/joint_states', self.states.append, 9)

    def send(self, topic: str, message: Any) -> None:
        publisher = self.client.node.create_publisher(type(message), f'{BELOW}/{topic}', 10)
        self.client.spin_until(lambda: publisher.get_subscription_count() > 0)
        publisher.publish(message)
        self.flat.settle()

    @property
    def positions(self) -> list[float]:
        (state,) = self.states[-1:]
        assert state.name == JOINTS
        return [*state.position]


@pytest.fixture
def arm(flat: PhysSim, client: Client) -> Arm:
    """Give a test an arm."""
    return Arm(flat, client)


def after(seconds: int, *positions: float, **said: Any) -> JointTrajectoryPoint:
    time = Duration(sec=seconds)
    return JointTrajectoryPoint(positions=positions, time_from_start=time, **said)


@pytest.mark.parametrize(
    ('topic', 'message'),
    [
        ('position_controller/commands', Float64MultiArray(data=[0.5, -1.0])),
        ('joint_command', JointState(name=JOINTS[::-1], position=[-1.0, 0.5])),
        (
            'joint_trajectory_controller/joint_trajectory',
            JointTrajectory(joint_names=JOINTS, points=[after(1, 0.5, -1.0)]),
        ),
    ],
)
def test_an_arm_goes_where_any_of_its_topics_tells_it(arm: Arm, topic: str, message: Any) -> None:
    arm.send(topic, message)
    arm.flat.run(2.0)
    assert arm.positions == pytest.approx([0.5, -1.0], abs=1e-6)


def test_a_joint_without_a_number_of_one_kind_takes_that_of_the_next(arm: Arm) -> None:
    state = JointState(name=JOINTS, position=[0.3, math.nan], velocity=[math.nan, 0.5])
    arm.send('joint_command', state)
    arm.flat.run(1.0)
    shoulder, elbow = arm.positions
    assert shoulder == pytest.approx(0.3, abs=1e-3)
    assert elbow == pytest.approx(0.5, abs=0.02)
    arm.send('effort_controller/commands', Float64MultiArray(data=[0.0, -1.0]))
    arm.flat.run(0.5)
    assert arm.positions[1] < elbow


@pytest.mark.parametrize(
    ('topic', 'message', 'code'),
    [
        ('position_controller/commands', Float64MultiArray(data=[0.5]), 'malformed'),
        ('position_controller/commands', Float64MultiArray(data=[0.5, math.inf]), 'malformed'),
        ('effort_controller/commands', Float64MultiArray(data=[0.0] * 200_000), 'malformed'),
        ('joint_command', JointState(name=['wrist'], position=[0.0]), 'unknown_joint'),
        ('joint_command', JointState(name=JOINTS, position=[0.0]), 'malformed'),
        ('joint_command', JointState(name=JOINTS), 'malformed'),
        ('joint_command', JointState(), 'malformed'),
        (
            'joint_trajectory_controller/joint_trajectory',
            JointTrajectory(joint_names=JOINTS),
            'bad_property',
        ),
        (
            'joint_trajectory_controller/joint_trajectory',
            JointTrajectory(joint_names=JOINTS, points=[after(1, 0.0, 0.0), after(1, 0.0, 0.0)]),
            'bad_property',
        ),
    ],
)
def test_a_command_that_is_refused_has_a_code_and_moves_nothing(
    arm: Arm, topic: str, message: Any, code: str
) -> None:
    arm.send(topic, message)
    arm.flat.run(0.5)
    (event,) = (each for each in arm.client.events if each.name.startswith(BELOW))
    assert (event.code, event.name) == (code, f'{BELOW}/{topic}')
    assert arm.positions == [0.0, 0.0]


def test_its_description_has_its_links_joints_and_limits(arm: Arm) -> None:
    heard: list[String] = []
    topic = f'{BELOW}/robot_description'
    arm.client.node.create_subscription(String, topic, heard.append, KEPT)
    arm.client.spin_until(lambda: heard)
    urdf = ET.fromstring(heard[0].data)  # noqa: S314 - our own
    joints = {joint.get('name'): joint for joint in urdf.iter('joint')}
    assert joints['shoulder'].get('type') == 'continuous'
    turning = joints['shoulder'].find('limit')
    assert turning is not None
    assert turning.attrib == {'effort': '30', 'velocity': '3'}
    elbow = joints['elbow']
    assert elbow.get('type') == 'revolute'
    found = [elbow.find(tag) for tag in ('parent', 'child', 'origin', 'axis', 'limit')]
    parent, child, origin, axis, limit = (each.attrib for each in found if each is not None)
    assert (parent['link'], child['link']) == ('robot_0/upper', 'robot_0/lower')
    assert (origin['xyz'], axis['xyz']) == ('0.4 0 0', '0 0 1')
    assert limit == {'lower': '-2.6', 'upper': '2.6', 'effort': '12', 'velocity': '4'}
    visual = urdf.find("link[@name='robot_0/lower']/visual/origin")
    assert visual is not None
    # The frame of a link is at its joint.
    assert visual.get('xyz') == '0.15 0 0.05'


def test_an_arm_without_a_drive_has_neither_commands_of_velocity_nor_odometry(arm: Arm) -> None:
    topics = {name for name, _ in arm.client.node.get_topic_names_and_types()}
    assert f'{BELOW}/joint_states' in topics
    assert not {f'{BELOW}/cmd_vel', f'{BELOW}/odom'} & topics


def test_the_base_of_an_arm_stands_fast_however_it_is_spawned(arm: Arm) -> None:
    scene = arm.flat.node.fleet.sensed.snapshot.scene
    assert scene.bodies[0].anchored
    assert scene.names[1:] == ('robot/0/upper/0', 'robot/0/lower/0')


def test_a_trajectory_of_megabytes_is_refused_before_it_is_decoded(
    arm: Arm, monkeypatch: pytest.MonkeyPatch
) -> None:
    decoded: list[int] = []

    def decode(data: bytes, kind: type) -> Any:
        decoded.append(len(data))
        return deserialize_message(data, kind)

    monkeypatch.setattr(topics, 'deserialize_message', decode)
    points = [JointTrajectoryPoint(positions=[0.0] * 1000) for _ in range(200)]
    topic = 'joint_trajectory_controller/joint_trajectory'
    arm.send(topic, JointTrajectory(joint_names=JOINTS, points=points))
    arm.flat.run(0.1)
    assert decoded == []
    arm.send(topic, JointTrajectory(joint_names=JOINTS))
    arm.flat.run(0.1)
    assert len(decoded) == 1
