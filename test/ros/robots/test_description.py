# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The description of a robot: URDF of its pieces and sensors, on a latched topic."""

from __future__ import annotations

from xml.etree import ElementTree as ET

from physsim_ros.model.robots import Robot
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, Shape
from physsim_ros.ros.robots.description import urdf_of
from physsim_ros.ros.robots.frames import RobotFrames, RobotTf
from physsim_ros.testing import PhysSim
import pytest
from sensor_msgs.msg import JointState
from std_msgs.msg import String

from ...building import ELL, spawn
from ...client import Client, KEPT
from ...sensing.worlds import plane

ROBOT = {
    'drive': {'kind': 'differential'},
    'sensors': [{'kind': 'laser', 'name': 'scan', 'at': [0.1, -0.2, 1.5]}],
}


def described(shape: Shape, namespace: str = 'tb') -> ET.Element:
    world = plane()
    spawn(world, 'tb/0', shape, mass=3.0, robot=Robot.from_mapping(ROBOT))
    body = world.snapshot().scene.bodies[0]
    urdf = urdf_of(body, RobotFrames(namespace, RobotTf.PREFIXED))
    return ET.fromstring(urdf)  # noqa: S314 - it is ours


@pytest.mark.parametrize(
    ('shape', 'geometries'),
    [
        (Disc(radius=0.105), ['cylinder']),
        (Box(width=0.4, height=0.2), ['box']),
        (Compound(element=Disc(radius=0.1), centers=((0.0, 0.0), (0.3, 0.0))), ['cylinder'] * 2),
        (Chain(points=((-1.0, 0.0), (1.0, 0.0)), thickness=0.1), ['cylinder', 'cylinder', 'box']),
        (ELL, ['box'] * 2),
    ],
    ids=repr,
)
def test_each_piece_is_a_box_or_cylinder(shape: Shape, geometries: list[str]) -> None:
    urdf = described(shape)
    for kind in ('visual', 'collision'):
        found = [each[0].tag for each in urdf.iterfind(f'link/{kind}/geometry')]
        assert found == geometries


def test_measures_and_places_are_those_of_the_body() -> None:
    urdf = described(Box(width=0.4, height=0.2))
    (geometry,) = urdf.iterfind("link[@name='tb/base_link']/visual/geometry/box")
    assert geometry.get('size') == '0.4 0.2 0.1'
    (mass,) = urdf.iterfind('link/inertial/mass')
    assert float(mass.get('value', '')) == 3.0
    inertia = urdf.find('link/inertial/inertia')
    assert inertia is not None
    assert float(inertia.get('izz', '')) == pytest.approx(3.0 * (0.4**2 + 0.2**2) / 12)
    (origin,) = urdf.iterfind("joint[@name='tb/scan_joint']/origin")
    assert (origin.get('xyz'), origin.get('rpy')) == ('0.1 -0.2 0', '0 0 1.5')


def test_links_are_one_tree_with_the_frames_of_the_robot() -> None:
    urdf = described(Disc(radius=0.1), namespace='')
    links = [link.get('name') for link in urdf.iterfind('link')]
    assert links == ['base_footprint', 'base_link', 'scan']
    joints = [(j.find('parent'), j.find('child')) for j in urdf.iterfind('joint')]
    edges = [tuple(end.get('link') for end in pair if end is not None) for pair in joints]
    assert edges == [('base_footprint', 'base_link'), ('base_link', 'scan')]


def test_a_late_listener_has_the_description_and_a_change_of_shape_is_told(
    flat: PhysSim, client: Client
) -> None:
    flat.robot('turtlebot3_burger')
    texts = client.listen(String, '/robot_0/robot_description', KEPT)
    client.spin_until(lambda: texts)
    assert 'radius="0.105"' in texts[-1].data
    flat.run(0.5)
    assert len(texts) == 1
    flat.robot(
        {'from': 'turtlebot3_burger', 'drive': {'max_speed': 0.1}}, name='other/0', at=(1, 0)
    )
    flat.run(0.5)
    assert len(texts) == 1


@pytest.mark.parametrize('robot', ['tractor', 'arm', 'gripper'])
def test_every_joint_that_moves_has_a_state_within_its_limits(
    flat: PhysSim, client: Client, robot: str
) -> None:
    # A robot_state_publisher places a link only where its joint has a state.
    flat.robot(robot)
    texts = client.listen(String, '/robot_0/robot_description', KEPT)
    states = client.listen(JointState, '/robot_0/joint_states')
    client.spin_until(lambda: texts)
    flat.until(lambda: states)
    urdf = ET.fromstring(texts[-1].data)  # noqa: S314 - it is ours
    moving = [each for each in urdf.iterfind('joint') if each.get('type') != 'fixed']
    positions = dict(zip(states[-1].name, states[-1].position, strict=True))
    assert moving
    for joint in moving:
        assert joint.get('type') in ('revolute', 'continuous', 'prismatic')
        limit = joint.find('limit')
        position = positions[str(joint.get('name'))]
        if joint.get('type') != 'continuous':
            assert limit is not None
            assert float(limit.get('lower', '')) <= position <= float(limit.get('upper', ''))
