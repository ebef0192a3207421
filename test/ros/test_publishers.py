# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Streams go where somebody listens, with the QoS of the contract, and late listeners see all."""

from __future__ import annotations

from dataclasses import replace
import time

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseArray
import numpy as np
from physsim_ros.model.scene import Scene
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.snapshot import Answer, Contacts, Frame, Snapshot
from physsim_ros.model.timeline import TimelineStatus
from physsim_ros.ros.encoders.markers import MarkersEncoder
from physsim_ros.ros.encoders.streams import (
    ClockEncoder,
    ContactsEncoder,
    PosesEncoder,
    StatesEncoder,
)
from physsim_ros.ros.publishers import status_publishers
from physsim_ros.ros.publishers.publishers import LATCH_PERIOD, Publishers
from physsim_ros.testing import own_context
import pytest
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import MarkerArray

from ..building import DISC, PLAIN_BODY
from ..outside import PATIENCE

ALL = {
    '/physsim/poses': PoseArray,
    '/physsim/states': MultiDOFJointState,
    '/physsim/contacts': MultiDOFJointState,
    '/physsim/markers': MarkerArray,
    '/physsim/events': DiagnosticStatus,
    '/clock': Clock,
}

STATUS = TimelineStatus(state='playing', speed=1.0, oldest=0.0, now=0.0, newest=0.0, course=1)


class Bench:
    """A world's streams and a listener, two nodes in a context of their own."""

    def __init__(self, context):
        self.executor = SingleThreadedExecutor(context=context)
        self.world = Node('physsim', context=context)
        self.listener = Node('listener', context=context)
        self.executor.add_node(self.world)
        self.executor.add_node(self.listener)
        self.values = {
            'frame_id': 'map',
            'map_resolution': 0.05,
            'publish_tf': False,
            'publish_clock': True,
            'robots_in_past': 'follow',
        }
        self.streams = Publishers(self.world, self.values, lambda: STATUS)
        self.publishers = {publisher.topic_name: publisher for publisher in self.world.publishers}

    def show(self, frame):
        """Show a frame to all, as the outputs of a node do."""
        self.frame = frame
        for output in self.streams.outputs:
            output.show(frame)

    def show_late(self):
        """Show the last frame to late subscribers."""
        for stream in self.streams.streams:
            stream.show_late(self.frame)

    def listen(self, topic, durability=DurabilityPolicy.VOLATILE):
        """Return the list that the messages of a topic come into, once both ends have met."""
        received = []
        qos = QoSProfile(depth=1000, reliability=ReliabilityPolicy.RELIABLE, durability=durability)
        before = self.publishers[topic].get_subscription_count()
        subscription = self.listener.create_subscription(ALL[topic], topic, received.append, qos)
        self.spin_until(lambda: self.publishers[topic].get_subscription_count() > before)
        self.spin_until(lambda: subscription.get_publisher_count() > 0)
        return received

    def spin_until(self, predicate):
        deadline = time.monotonic() + PATIENCE
        while not predicate():
            assert time.monotonic() < deadline, 'it did not come about in time'
            self.executor.spin_once(timeout_sec=0.05)

    def settle(self):
        """Spin until all that was published before has arrived."""
        # In each round an executor takes one message of each subscription, and no test has more
        # than ten on the way.
        arrived = []
        probe = self.world.create_publisher(Clock, 'probe', 10)
        subscription = self.listener.create_subscription(Clock, 'probe', arrived.append, 10)
        self.spin_until(
            lambda: probe.get_subscription_count() and subscription.get_publisher_count()
        )
        for _ in range(10):
            probe.publish(Clock())
        self.spin_until(lambda: len(arrived) == 10)
        self.world.destroy_publisher(probe)
        self.listener.destroy_subscription(subscription)


@pytest.fixture
def bench(monkeypatch):
    with own_context(monkeypatch) as context:
        bench = Bench(context)
        yield bench
        bench.executor.shutdown()
        bench.listener.destroy_node()
        bench.world.destroy_node()


def scene_of(*names):
    bodies = tuple(replace(PLAIN_BODY, name=name, shape=DISC) for name in names)
    return Scene(bodies=bodies, settings=WorldSettings())


def frame_of(scene, step=1, contacts=None):
    """Return a frame in which every body is at x = step."""
    poses = np.zeros((len(scene.bodies), 3))
    poses[:, 0] = step
    snapshot = Snapshot(
        step=step, stamp=step * 1_000_000, scene=scene, poses=poses, twists=np.zeros_like(poses)
    )
    return Frame(snapshot=snapshot, contacts=contacts)


def touching():
    return Contacts(
        pairs=np.array([[0, 1]]),
        points=np.zeros((1, 2)),
        normals=np.array([[1.0, 0.0]]),
        impulses=np.ones((1, 2)),
    )


@pytest.fixture
def encoded(monkeypatch):
    """Names of what is encoded, as it is encoded."""
    calls = []

    def spy(owner, name, label):
        original = getattr(owner, name)

        def wrapper(*args):
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
    spy(status_publishers, 'encode_event', 'event')
    return calls


def test_who_listens_gets_every_stream_of_a_frame(bench):
    received = {topic: bench.listen(topic) for topic in ALL}
    frame = frame_of(scene_of('a/0', 'b/1'), step=3, contacts=touching())
    bench.show(frame)
    bench.streams.events.publish(Answer(topic='~/spawn', subject='a/0', message='a/0 is there'))
    bench.spin_until(lambda: all(received.values()))
    assert [pose.position.x for pose in received['/physsim/poses'][0].poses] == [3.0, 3.0]
    assert received['/physsim/states'][0].joint_names == ['a/0', 'b/1']
    assert received['/physsim/contacts'][0].joint_names == ['a/0|b/1']
    assert [marker.ns for marker in received['/physsim/markers'][0].markers] == ['a', 'b']
    assert received['/physsim/events'][0].message == 'a/0 is there'
    assert received['/clock'][0].clock.nanosec == 3_000_000
    for topic in ('/physsim/poses', '/physsim/states', '/physsim/contacts'):
        assert received[topic][0].header.frame_id == 'map'
        assert received[topic][0].header.stamp.nanosec == 3_000_000


def test_where_nobody_listens_nothing_is_built_but_a_rare_picture(bench, encoded):
    scene = scene_of('a/0', 'b/1')
    for step in range(1, 2 * LATCH_PERIOD + 1):
        bench.show(frame_of(scene, step, touching()))
        bench.streams.events.publish(Answer(topic='~/spawn'))
    assert encoded == ['markers'] * 2


def test_only_what_somebody_listens_to_is_built(bench, encoded):
    bench.listen('/physsim/states')
    scene = scene_of('a/0', 'b/1')
    for step in range(1, 11):
        bench.show(frame_of(scene, step, touching()))
    assert encoded.count('states') == 10
    assert set(encoded) == {'states', 'markers'}


def test_an_unseen_picture_is_kept_up_with_a_changing_scene(bench, encoded):
    for step in range(1, 6):
        bench.show(frame_of(scene_of(f'a/{step}'), step))
    assert encoded == ['markers'] * 5


def test_a_late_listener_gets_the_whole_picture_of_the_last_scene(bench):
    scene = scene_of('a/0')
    bench.show(frame_of(scene_of()))
    bench.show(frame_of(scene))
    pictures = bench.listen('/physsim/markers', DurabilityPolicy.TRANSIENT_LOCAL)
    bench.spin_until(lambda: pictures)
    assert [marker.ns for marker in pictures[0].markers] == ['a']


def test_a_listener_that_comes_late_to_a_running_world_gets_the_next_picture(bench):
    scene = scene_of('a/0')
    bench.show(frame_of(scene, 1))
    pictures = bench.listen('/physsim/markers', DurabilityPolicy.TRANSIENT_LOCAL)
    # The picture that was kept comes first, unless the next one has overtaken it.
    bench.show(frame_of(scene, 2))
    bench.spin_until(lambda: pictures and pictures[-1].markers[0].pose.position.x == 2.0)


def test_a_world_that_stands_still_keeps_the_right_picture_for_late_listeners(bench, encoded):
    scene = scene_of('a/0')
    for step in (1, 2, 3):
        bench.show(frame_of(scene, step))
    for _ in range(100):
        bench.show_late()
    assert encoded == ['markers'] * 2
    pictures = bench.listen('/physsim/markers', DurabilityPolicy.TRANSIENT_LOCAL)
    bench.spin_until(lambda: pictures)
    assert pictures[0].markers[0].pose.position.x == 3.0


@pytest.mark.parametrize(
    'topic', ['/physsim/poses', '/physsim/states', '/physsim/markers', '/clock']
)
def test_a_listener_that_comes_late_to_a_paused_world_is_welcomed_once(bench, topic):
    bench.show(frame_of(scene_of('a/0'), 2))
    bench.show_late()
    received = bench.listen(topic)
    for _ in range(5):
        bench.show_late()
    bench.settle()
    assert len(received) == 1


def test_contacts_are_not_told_twice(bench):
    frame = frame_of(scene_of('a/0', 'b/1'), contacts=touching())
    early = bench.listen('/physsim/contacts')
    bench.show(frame)
    late = bench.listen('/physsim/contacts')
    bench.show_late()
    bench.settle()
    assert (len(early), len(late)) == (1, 0)


def test_contacts_are_wanted_while_somebody_listens(bench):
    assert not bench.streams.contacts.subscriptions
    bench.listen('/physsim/contacts')
    assert bench.streams.contacts.subscriptions


def test_a_frame_without_contacts_gives_no_message_of_them(bench, encoded):
    bench.listen('/physsim/contacts')
    bench.show(frame_of(scene_of('a/0')))
    assert 'contacts' not in encoded


def test_the_clock_can_be_switched_off_and_on(bench):
    clocks = bench.listen('/clock')
    scene = scene_of()
    bench.values['publish_clock'] = False
    bench.show(frame_of(scene, 1))
    bench.show(frame_of(scene, 2))
    bench.show_late()
    bench.values['publish_clock'] = True
    bench.show_late()
    bench.show(frame_of(scene, 3))
    bench.settle()
    assert [message.clock.nanosec // 1_000_000 for message in clocks] == [2, 3]
