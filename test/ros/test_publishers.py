# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Streams go where somebody listens, and late listeners see all."""

from __future__ import annotations

from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseArray
from physsim_ros.model.requests import DeleteAll
from physsim_ros.ros.encoders import markers
from physsim_ros.ros.encoders.markers import MarkersEncoder
from physsim_ros.ros.encoders.streams import (
    ClockEncoder,
    ContactsEncoder,
    PosesEncoder,
    StatesEncoder,
)
from physsim_ros.ros.publishers import event_publisher
from physsim_ros.ros.publishers.streams import LATCH_PERIOD
from physsim_ros.testing import box, disc, PhysSim
import pytest
from rclpy.parameter import Parameter
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import MarkerArray

from ..client import Client, KEPT

ALL = {
    '~/poses': PoseArray,
    '~/states': MultiDOFJointState,
    '~/contacts': MultiDOFJointState,
    '~/markers': MarkerArray,
    '~/events': DiagnosticStatus,
    '/clock': Clock,
}


@pytest.fixture
def encoded(physsim: PhysSim, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Give the names of what is encoded, as it is encoded, in a world of two bodies that touch."""
    physsim.spawn(box('a/0', anchored=True))
    physsim.spawn(disc('b/1', at=(0.0, 1.0)))
    physsim.step(2)
    calls: list[str] = []

    def spy(owner: Any, name: str, label: str) -> None:
        original = getattr(owner, name)

        def wrapper(*args: Any) -> Any:
            message = original(*args)
            if message is not None:
                calls.append(label)
            return message

        monkeypatch.setattr(owner, name, wrapper)

    spy(PosesEncoder, 'encode', 'poses')
    spy(StatesEncoder, 'encode', 'states')
    spy(ContactsEncoder, 'encode', 'contacts')
    spy(MarkersEncoder, 'encode', 'markers')
    spy(ClockEncoder, 'encode', 'clock')
    spy(event_publisher, 'encode_event', 'event')
    return calls


def stand_still(physsim: PhysSim, ticks: int) -> None:
    """Let a paused world tick."""
    for _ in range(ticks):
        physsim.node.outputs.show_late()
    physsim.settle()


def test_who_listens_gets_every_stream_of_a_frame(physsim: PhysSim, client: Client) -> None:
    received = {topic: client.listen(kind, topic) for topic, kind in ALL.items()}
    physsim.spawn(box('a/0', anchored=True))
    physsim.spawn(disc('b/1', at=(3.0, 1.0)))
    physsim.spawn(disc('c/2', at=(0.0, 0.99)))
    physsim.step(3)
    client.spin_until(lambda: all(received.values()))
    last = {topic: messages[-1] for topic, messages in received.items()}
    assert [pose.position.x for pose in last['~/poses'].poses] == [0.0, 3.0, 0.0]
    assert last['~/states'].joint_names == ['a/0', 'b/1', 'c/2']
    assert last['~/contacts'].joint_names == ['a/0|c/2']
    namespaces = [marker.ns for marker in last['~/markers'].markers]
    assert namespaces == ['a', 'anchor:a', 'b', 'c']
    assert last['~/events'].hardware_id == 'c/2'
    assert last['/clock'].clock.nanosec == 50_000_000
    for topic in ('~/poses', '~/states', '~/contacts'):
        assert last[topic].header.frame_id == 'world'
        assert last[topic].header.stamp.nanosec == 50_000_000


def test_where_nobody_listens_nothing_is_built_but_a_rare_picture(
    physsim: PhysSim, encoded: list[str]
) -> None:
    # The fixture itself hears the clock.
    physsim.run(2 * LATCH_PERIOD)
    assert [each for each in encoded if each != 'clock'] == ['markers'] * 2


def test_only_what_somebody_listens_to_is_built(
    physsim: PhysSim, client: Client, encoded: list[str]
) -> None:
    client.listen(MultiDOFJointState, '~/states')
    physsim.step(10)
    assert encoded.count('states') == 10
    assert {*encoded} <= {'states', 'markers', 'clock'}


def test_an_unseen_picture_that_takes_several_frames_is_finished_at_once(
    physsim: PhysSim, encoded: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    simulation = physsim.node.simulation
    two = simulation.save()
    simulation.perform(DeleteAll())
    physsim.step(1)
    encoded.clear()
    monkeypatch.setattr(markers, 'MOST_NEW', 1)
    simulation.load(two)
    physsim.step(1)
    assert encoded.count('markers') == 0
    assert physsim.node.outputs.is_read
    physsim.step(1)
    assert encoded.count('markers') == 1
    assert not physsim.node.outputs.publishers.is_read


@pytest.mark.parametrize(
    ('topic', 'kind'),
    [('~/poses', PoseArray), ('~/contacts', MultiDOFJointState), ('~/timeline', DiagnosticStatus)],
)
def test_frames_are_read_while_a_topic_of_them_has_a_listener(
    physsim: PhysSim, client: Client, topic: str, kind: type
) -> None:
    # The fixture itself hears the clock.
    physsim.node.set_parameters([Parameter('publish_clock', value=False)])
    physsim.step(2)
    assert not physsim.node.outputs.publishers.is_read
    client.listen(kind, topic)
    assert physsim.node.outputs.publishers.is_read


def test_an_unseen_picture_is_kept_up_with_a_changing_scene(
    physsim: PhysSim, encoded: list[str]
) -> None:
    for number in range(5):
        physsim.spawn(disc(f'c/{number}', at=(5.0 + number, 0.0)))
    assert encoded.count('markers') == 5


def test_who_comes_late_to_a_world_that_stands_still_gets_the_picture_of_its_last_frame(
    physsim: PhysSim, client: Client, encoded: list[str]
) -> None:
    physsim.step(3)
    encoded.clear()
    stand_still(physsim, 100)
    assert encoded == ['markers']
    pictures = client.listen(MarkerArray, '~/markers', KEPT)
    client.spin_until(lambda: pictures)
    drawn = {marker.ns: marker.pose.position.y for marker in pictures[0].markers}
    assert drawn['b'] == physsim.pose('b/1').y
    # In a running world the next picture follows.
    before = len(pictures)
    physsim.step()
    client.spin_until(lambda: len(pictures) > before)


@pytest.mark.parametrize('topic', ['~/poses', '~/states', '~/markers', '/clock'])
def test_a_listener_that_comes_late_to_a_paused_world_is_welcomed_once(
    physsim: PhysSim, client: Client, topic: str
) -> None:
    physsim.spawn(disc('a/0'))
    physsim.step(2)
    stand_still(physsim, 1)
    received = client.listen(ALL[topic], topic)
    stand_still(physsim, 5)
    client.spin_until(lambda: received)
    assert len(received) == 1


def test_contacts_are_not_told_twice_and_wanted_while_somebody_listens(
    physsim: PhysSim, client: Client, encoded: list[str]
) -> None:
    contacts = physsim.node.outputs.publishers.contacts
    assert not contacts.subscriptions
    early = client.listen(MultiDOFJointState, '~/contacts')
    assert contacts.subscriptions
    physsim.step()
    assert len(early) == 1
    late = client.listen(MultiDOFJointState, '~/contacts')
    stand_still(physsim, 3)
    assert (len(early), len(late)) == (1, 0)
    assert encoded.count('contacts') == 1
