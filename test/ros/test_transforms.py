# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Poses on /tf, read by another implementation of CDR: there is no wheel of tf2_msgs."""

# Without deferred annotations, which cyclonedds does not resolve.
from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
import math
import sys
from types import SimpleNamespace

from geometry_msgs.msg import PoseArray
from physsim_ros.model.errors import BadProperty
from physsim_ros.testing import box, delete, disc, PhysSim
import pytest
from rclpy.node import Node

idl = pytest.importorskip('cyclonedds.idl', reason='cyclonedds reads the messages')
cyclone = pytest.importorskip('test.elsewhere.cyclone')


@dataclass
class TransformStamped(idl.IdlStruct, typename='geometry_msgs::msg::dds_::TransformStamped_'):
    header: cyclone.Header
    child_frame_id: str
    transform: cyclone.Transform


@dataclass
class TFMessage(idl.IdlStruct, typename='tf2_msgs::msg::dds_::TFMessage_'):
    transforms: idl.types.sequence[TransformStamped]


def test_the_pose_of_every_body_goes_to_tf(
    start: Callable[..., PhysSim], monkeypatch: pytest.MonkeyPatch
) -> None:
    # The type counts for discovery only: what is published, and received raw, are bytes.
    stub = SimpleNamespace(TFMessage=PoseArray)
    monkeypatch.setitem(sys.modules, 'tf2_msgs', SimpleNamespace(msg=stub))
    monkeypatch.setitem(sys.modules, 'tf2_msgs.msg', stub)
    received: list[bytes] = []
    world = start(publish_tf=True)
    listener = Node('listener', context=world.context)
    listener.create_subscription(PoseArray, '/tf', received.append, 100, raw=True)
    world.add(listener)
    # Names of lengths that need every padding.
    names = [f'{"n" * length}/0' for length in range(1, 9)]
    for number, name in enumerate(names):
        world.spawn(disc(name, at=(2.0 * number, 5.0)))
    world.spawn(box('turned/0', at=(-3.0, 1.0, math.pi / 2), text='{anchored: true}'))
    world.run(0.5)
    read = TFMessage.deserialize(received[-1]).transforms
    assert [each.child_frame_id for each in read] == list(world.names)
    for each in read:
        pose, place, turn = (
            world.pose(each.child_frame_id),
            each.transform.translation,
            each.transform.rotation,
        )
        assert (place.x, place.y, place.z) == (pose.x, pose.y, 0.0)
        assert (turn.x, turn.y) == (0.0, 0.0)
        assert 2 * math.atan2(turn.z, turn.w) == pytest.approx(pose.yaw)
        assert each.header.frame_id == 'world'
        assert each.header.stamp == cyclone.Time(0, 500_000_000)
    for name in world.names:
        world.spawn(delete(name))
    world.step()
    assert TFMessage.deserialize(received[-1]).transforms == []


@pytest.mark.skipif(find_spec('tf2_msgs') is not None, reason='tf2_msgs is installed')
def test_without_tf2_msgs_the_node_says_what_is_missing(start: Callable[..., PhysSim]) -> None:
    with pytest.raises(BadProperty, match='ros-jazzy-tf2-msgs') as refused:
        start(publish_tf=True)
    assert refused.value.field == 'publish_tf'
