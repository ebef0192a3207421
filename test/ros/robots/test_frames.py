# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Transforms of robots, heard as messages of tf2_msgs that are built for the test."""

from __future__ import annotations

from collections.abc import Callable
import math
from typing import Any

from physsim_ros.testing import delete, PhysSim
import pytest
from sensor_msgs.msg import LaserScan

from .driver import yaw_of
from ..built_interfaces import import_built
from ...client import Client, KEPT, stamp_of

Start = Callable[[str], tuple[PhysSim, Client]]


@pytest.fixture
def seen_from_above(request: pytest.FixtureRequest, start: Callable[..., PhysSim]) -> Start:
    """Give a test a world of robots whose transforms go where it says."""
    import_built('tf2_msgs', request)

    def world(robot_tf: str) -> tuple[PhysSim, Client]:
        physsim = start(gravity=[0.0, 0.0], robot_tf=robot_tf)
        return physsim, Client(physsim)

    return world


def heard(client: Client, topic: str, *qos: Any) -> list[Any]:
    from tf2_msgs.msg import TFMessage  # noqa: PLC0415 - built for the test

    transforms: list[Any] = []
    client.node.create_subscription(
        TFMessage, topic, lambda message: transforms.extend(message.transforms), *qos or (100,)
    )
    client.spin_until(lambda: client.node.count_publishers(topic))
    client.physsim.settle()
    return transforms


@pytest.mark.parametrize(
    ('robot_tf', 'below', 'prefix'),
    [('prefixed', '', 'robot_0/'), ('namespaced', '/robot_0', '')],
)
def test_the_way_of_a_robot_is_on_tf_as_on_odom(
    seen_from_above: Start, robot_tf: str, below: str, prefix: str
) -> None:
    physsim, client = seen_from_above(robot_tf)
    robot = physsim.robot('turtlebot3_burger')
    transforms = heard(client, f'{below}/tf')
    robot.drive(0.2, 0.5)
    physsim.run(2.0)
    names = {(each.header.frame_id, each.child_frame_id) for each in transforms}
    assert names == {(f'{prefix}odom', f'{prefix}base_footprint')}
    # One each frame, with the stamps of the frames.
    stamps = [stamp_of(each) for each in transforms]
    assert stamps == sorted(set(stamps))
    assert len(stamps) == 120
    assert stamps[-1] == 2_000_000_000
    odom, last = robot.odom().pose.pose, transforms[-1].transform
    assert (last.translation.x, last.translation.y) == (odom.position.x, odom.position.y)
    assert last.rotation == odom.orientation
    # It has driven an arc, so that the test sees more than a robot at rest.
    assert yaw_of(last.rotation) == pytest.approx(1.0, abs=0.1)
    assert math.hypot(last.translation.x, last.translation.y) > 0.3


def test_a_late_listener_has_the_places_of_the_sensors(
    seen_from_above: Start,
) -> None:
    physsim, client = seen_from_above('prefixed')
    robot = physsim.robot({'from': 'turtlebot3_burger'})
    physsim.run(0.5)
    fixed = heard(client, '/tf_static', KEPT)
    client.spin_until(lambda: fixed)
    places = {each.child_frame_id: each for each in fixed}
    assert places['robot_0/base_link'].header.frame_id == 'robot_0/base_footprint'
    scan = places[robot.scan().header.frame_id]
    assert scan.header.frame_id == 'robot_0/base_link'
    assert scan.transform.translation.x == pytest.approx(-0.032)


def test_every_scan_finds_a_transform_of_its_stamp(
    seen_from_above: Start,
) -> None:
    physsim, client = seen_from_above('prefixed')
    robot = physsim.robot('turtlebot3_burger')
    transforms = heard(client, '/tf')
    late: list[int] = []
    scans: list[int] = []

    def look_up(scan: LaserScan) -> None:
        scans.append(stamp_of(scan))
        if stamp_of(transforms[-1]) < stamp_of(scan):
            late.append(stamp_of(scan))

    client.node.create_subscription(LaserScan, '/robot_0/scan', look_up, 10)
    client.spin_until(lambda: client.node.count_publishers('/robot_0/scan'))
    physsim.settle()
    robot.drive(0.2)
    physsim.run(2.0)
    assert len(scans) == 10
    assert late == []


def test_robots_do_not_share_frames_and_take_theirs_along(
    seen_from_above: Start,
) -> None:
    physsim, client = seen_from_above('prefixed')
    physsim.robot('turtlebot3_burger')
    physsim.robot('turtlebot3_burger', at=(2.0, 0.0))
    transforms = heard(client, '/tf')
    client.spin_until(lambda: client.node.count_publishers('/tf') == 2)
    physsim.settle()
    physsim.step()
    frames = {each.child_frame_id for each in transforms}
    assert frames == {'robot_0/base_footprint', 'robot_1/base_footprint'}
    for name in list(physsim.names):
        physsim.spawn(delete(name))
    physsim.step()
    client.spin_until(lambda: client.node.count_publishers('/tf') == 0)


def test_without_transforms_nobody_publishes_them(seen_from_above: Start) -> None:
    physsim, client = seen_from_above('none')
    physsim.robot('turtlebot3_burger')
    physsim.step()
    topics = {name for name, _ in client.node.get_topic_names_and_types()}
    assert '/robot_0/odom' in topics
    assert not {each for each in topics if each.endswith(('/tf', '/tf_static'))}
