# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The publishers of the world: topics, types and QoS, and the frames at which each publishes.

Law: a stream without subscribers is not encoded, and a late subscriber receives the last frame.

The exception is a latched stream: DDS keeps its last message for late subscribers (transient
local). It is published without subscribers too, when the scene has changed and every
`LATCH_PERIOD` frames.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseArray
from nav_msgs.msg import OccupancyGrid
from physsim_ros.model.error_boundary import ErrorBoundary
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.snapshot import Answer, Frame, NO_PREVIEW, Preview
from physsim_ros.ros.encoders.clock import ClockEncoder
from physsim_ros.ros.encoders.contacts import ContactsEncoder
from physsim_ros.ros.encoders.map import MapEncoder
from physsim_ros.ros.encoders.markers import MarkersEncoder
from physsim_ros.ros.encoders.poses import PosesEncoder
from physsim_ros.ros.encoders.preview import preview_message
from physsim_ros.ros.encoders.states import StatesEncoder
from physsim_ros.ros.encoders.transforms import TransformsEncoder
from physsim_ros.ros.publishers.event_publisher import EventPublisher, EVENTS_DEPTH
from physsim_ros.ros.publishers.interactive_markers import InteractiveMarkers
from physsim_ros.ros.publishers.timeline_publisher import TimelinePublisher
from physsim_ros.ros.robots.frames import TF_DEPTH, tf_message_type
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import MarkerArray

# Frames between messages on `~/markers` without subscribers: one second of them at 60 Hz.
LATCH_PERIOD = 60


class Publishers:
    """
    The publishers of the world.

    :param node: that owns them
    :param boundary: of each of them
    :param frame_id: name of the world frame
    :param map_resolution: returns the side of a cell of `~/map` [m]
    :param publish_tf: whether poses are published on `/tf`, too
    :raises BadProperty: they cannot be, since tf2_msgs is not installed

    :ivar clock: the stream of simulation time; closed, it publishes nothing
    :ivar contacts: the stream of contacts
    :ivar timeline: the publisher of `~/timeline`
    :ivar events: the publisher of `~/events`
    """

    def __init__(
        self,
        node: Node,
        boundary: ErrorBoundary,
        *,
        frame_id: str,
        map_resolution: Callable[[], float],
        publish_tf: bool = False,
    ) -> None:
        def stream(kind: Any, topic: str, depth: int, encoder: Encoder) -> Stream:
            return Stream(node.create_publisher(kind, topic, depth), encoder, boundary)

        def latched(kind: Any, topic: str) -> Publisher:
            qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            return node.create_publisher(kind, topic, qos)

        self.clock = stream(Clock, 'clock', 10, ClockEncoder())
        # Contacts are those of one frame, so a late subscriber does not receive the last ones.
        self.contacts = stream(MultiDOFJointState, '~/contacts', 5, ContactsEncoder(frame_id))
        self._state_streams: tuple[Stream, ...] = (
            self.clock,
            stream(PoseArray, '~/poses', 5, PosesEncoder(frame_id)),
            stream(MultiDOFJointState, '~/states', 5, StatesEncoder(frame_id)),
            LatchedStream(latched(MarkerArray, '~/markers'), MarkersEncoder(frame_id), boundary),
            # DDS keeps the last map for late subscribers; there is another one when it changes.
            Stream(
                latched(OccupancyGrid, '~/map'), MapEncoder(frame_id, map_resolution), boundary
            ),
        )
        if publish_tf:
            message = tf_message_type()
            if message is None:
                raise BadProperty(
                    'publish_tf needs the package tf2_msgs, which is not installed here (on '
                    'Ubuntu ros-jazzy-tf2-msgs; there is no wheel of it)',
                    field='publish_tf',
                )
            tf = stream(message, '/tf', TF_DEPTH, TransformsEncoder(frame_id))
            self._state_streams += (tf,)
        self._interactive_markers = InteractiveMarkers(node, frame_id)
        self.timeline = TimelinePublisher(latched(DiagnosticStatus, '~/timeline'))
        self._preview_publisher = latched(MarkerArray, '~/preview')
        self._frame_id = frame_id
        self._boundary = boundary
        self._preview: Preview = NO_PREVIEW
        self._frame: Frame | None = None
        self.events = EventPublisher(
            node.create_publisher(DiagnosticStatus, '~/events', EVENTS_DEPTH)
        )

    def publish_frame(self, frame: Frame) -> None:
        """Publish the answers of a frame, and those of its streams that have subscribers."""
        for answer in frame.answers:
            self.publish_answer(answer)
        self._flush_events()
        self._frame = frame
        for stream in (*self._state_streams, self.contacts):
            stream.publish(frame)
        with self._boundary.output('~/drag/update'):
            self._interactive_markers.publish(frame)

    def publish_answer(self, answer: Answer) -> None:
        """Publish an answer on `~/events`."""
        with self._boundary.output('~/events'):
            self.events.publish(answer)

    def _flush_events(self) -> None:
        """Publish the answers that have waited, as far as their readers take them."""
        with self._boundary.output('~/events'):
            self.events.flush()

    def publish_to_late_subscribers(self) -> None:
        """Publish the last frame to later subscribers; called at ticks without a frame."""
        self._flush_events()
        if self._frame is not None:
            for stream in self._state_streams:
                stream.publish_to_late_subscribers(self._frame)

    def publish_preview(self, preview: Preview) -> None:
        """Publish a preview if it has changed."""
        if preview != self._preview:
            self._preview = preview
            stamp = self._frame.snapshot.stamp if self._frame else 0
            with self._boundary.output('~/preview'):
                message = preview_message(preview, frame_id=self._frame_id, stamp=stamp)
                self._preview_publisher.publish(message)


class Encoder(Protocol):
    """An encoder of frames."""

    def encode(self, frame: Frame) -> Any:
        """Return the message of a frame, serialised or not; None where the frame has none."""


class Stream:
    """
    Publishes frames on a topic while it has subscribers.

    :param publisher: of the topic
    :param encoder: of frames
    :param boundary: of both

    :ivar open: whether frames are published at all
    """

    def __init__(self, publisher: Publisher, encoder: Encoder, boundary: ErrorBoundary) -> None:
        self.open = True
        self._boundary = boundary
        self._publisher = publisher
        self._encoder = encoder
        # Number of subscriptions at the last frame.
        self._served = 0

    @property
    def subscriptions(self) -> int:
        """Return the number of subscriptions; 0 while closed."""
        return self._publisher.get_subscription_count() if self.open else 0

    def publish(self, frame: Frame) -> None:
        """Publish a new frame."""
        self._served = self.subscriptions
        if self._served:
            self._send(frame)

    def publish_to_late_subscribers(self, frame: Frame) -> None:
        """Publish the last frame again if there are more subscriptions since."""
        served, self._served = self._served, self.subscriptions
        if self._served > served:
            self._send(frame)

    def _send(self, frame: Frame) -> None:
        with self._boundary.output(self._publisher.topic_name):
            message = self._encoder.encode(frame)
            if message is not None:
                self._publisher.publish(message)


class LatchedStream(Stream):
    """A stream whose last message DDS keeps for late subscribers."""

    def __init__(self, publisher: Publisher, encoder: Encoder, boundary: ErrorBoundary) -> None:
        super().__init__(publisher, encoder, boundary)
        self._latched: Frame | None = None
        self._age = 0

    def publish(self, frame: Frame) -> None:
        """Publish a new frame; without subscribers only if the latched one is outdated."""
        super().publish(frame)
        self._age += 1
        changed = self._latched is None or self._latched.snapshot.scene is not frame.snapshot.scene
        if changed or self._age >= LATCH_PERIOD:
            self._send(frame)

    def publish_to_late_subscribers(self, frame: Frame) -> None:
        """Publish the last frame again if it is not the latched one, or for new subscriptions."""
        super().publish_to_late_subscribers(frame)
        # The world is paused: the latched message becomes that of the last frame.
        if self._latched is not frame:
            self._send(frame)

    def _send(self, frame: Frame) -> None:
        super()._send(frame)
        self._latched, self._age = frame, 0
