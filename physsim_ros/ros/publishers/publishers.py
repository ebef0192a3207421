# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The publishers of the world: topics, types and QoS, and the frames at which each publishes.

Law: a stream without subscribers is not encoded, and a late subscriber receives the last frame.

The exception is a latched stream: DDS keeps its last message for late subscribers (transient
local). It is published without subscribers too, when the scene has changed and every
`LATCH_PERIOD` of time.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseArray
from nav_msgs.msg import OccupancyGrid
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.snapshot import Frame
from physsim_ros.model.timeline import TimelineStatus
from physsim_ros.ros.encoders.map import MapEncoder
from physsim_ros.ros.encoders.markers import MarkersEncoder
from physsim_ros.ros.encoders.preview import PreviewEncoder
from physsim_ros.ros.encoders.streams import (
    ClockEncoder,
    ContactsEncoder,
    PosesEncoder,
    StatesEncoder,
    TransformsEncoder,
)
from physsim_ros.ros.publishers.interactive_markers import InteractiveMarkers
from physsim_ros.ros.publishers.status_publishers import (
    EventPublisher,
    EVENTS_DEPTH,
    is_later,
    TimelinePublisher,
)
from physsim_ros.ros.robots.frames import TF_DEPTH, tf_message_type
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import MarkerArray

# Time from one message on `~/markers` without subscribers to the next at speed 1 [s].
LATCH_PERIOD = 1.0


class Output(Protocol):
    """
    An output of frames: a topic, the log, the viewer, the page, the robots.

    :ivar name: by which an error in it is told
    """

    name: str

    def show(self, frame: Frame) -> None:
        """Show a new frame."""


class LateOutput(Output, Protocol):
    """An output that may have to do with the last frame while there is no new one."""

    def show_late(self, frame: Frame) -> None:
        """Show the last frame to who came late, or go on to show it."""


class Encoder(Protocol):
    """An encoder of frames."""

    def encode(self, frame: Frame) -> Any:
        """Return the message of a frame, serialised or not; None where the frame has none."""


class Publishers:
    """
    The publishers of the world.

    :param node: that owns them
    :param values: of the parameters of the node, by name, always up to date
    :param status: returns the status of the timeline
    :raises BadProperty: poses cannot be published on `/tf`, since tf2_msgs is not installed

    :ivar contacts: the stream of contacts
    :ivar preview: the stream of unfinished gestures and readings
    :ivar events: the publisher of `~/events`
    :ivar timeline: the publisher of `~/timeline`
    :ivar streams: of states, of which late subscribers receive the last frame
    :ivar late: the outputs that may show the last frame again, or go on with it
    :ivar outputs: each with a method `show`, in the order in which they are shown a frame
    """

    def __init__(
        self, node: Node, values: Mapping[str, Any], status: Callable[[], TimelineStatus]
    ) -> None:
        def stream(kind: Any, topic: str, depth: int, encoder: Encoder) -> Stream:
            return Stream(node.create_publisher(kind, topic, depth), encoder)

        def latched(kind: Any, topic: str) -> Publisher:
            qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
            return node.create_publisher(kind, topic, qos)

        frame_id, publish_rate = values['frame_id'], values['publish_rate']
        markers = MarkersEncoder(frame_id, publish_rate)
        # Contacts are those of one frame, so a late subscriber does not receive the last ones.
        self.contacts = stream(MultiDOFJointState, '~/contacts', 5, ContactsEncoder(frame_id))
        # DDS keeps the last map, and the last preview, for late subscribers; there is another one
        # when it changes.
        grid = MapEncoder(frame_id, lambda: values['map_resolution'])
        self.preview = Stream(latched(MarkerArray, '~/preview'), PreviewEncoder(frame_id))
        self.streams = [
            ClockStream(node.create_publisher(Clock, 'clock', 10), values),
            stream(PoseArray, '~/poses', 5, PosesEncoder(frame_id)),
            stream(MultiDOFJointState, '~/states', 5, StatesEncoder(frame_id)),
            LatchedStream(latched(MarkerArray, '~/markers'), markers),
            Stream(latched(OccupancyGrid, '~/map'), grid),
            self.preview,
        ]
        if values['publish_tf']:
            message = tf_message_type()
            if message is None:
                raise BadProperty(
                    'publish_tf needs the package tf2_msgs, which is not installed here (on '
                    'Ubuntu ros-jazzy-tf2-msgs; there is no wheel of it)',
                    field='publish_tf',
                )
            self.streams.append(stream(message, '/tf', TF_DEPTH, TransformsEncoder(frame_id)))
        self.events = EventPublisher(
            node.create_publisher(DiagnosticStatus, '~/events', EVENTS_DEPTH)
        )
        self.timeline = TimelinePublisher(latched(DiagnosticStatus, '~/timeline'), status)
        self._markers = InteractiveMarkers(node, frame_id, publish_rate)
        self.late: tuple[LateOutput, ...] = (*self.streams, self._markers)
        self.outputs: tuple[Output, ...] = (
            self.events,
            *self.streams,
            self.contacts,
            self._markers,
            self.timeline,
        )

    @property
    def is_read(self) -> bool:
        """Whether a topic of frames has subscribers."""
        streams = (each.is_read for each in (*self.streams, self.contacts))
        return any((self._markers.is_read, self.timeline.is_read, *streams))


class Stream:
    """
    Publishes frames on a topic while it has subscribers.

    :param publisher: of the topic
    :param encoder: of frames

    :ivar name: of the topic
    """

    def __init__(self, publisher: Publisher, encoder: Encoder) -> None:
        self.name = publisher.topic_name
        self._publisher = publisher
        self._encoder = encoder
        # Number of subscriptions at the last frame.
        self._served = 0

    @property
    def subscriptions(self) -> int:
        """Return the number of subscriptions."""
        return self._publisher.get_subscription_count()

    @property
    def is_read(self) -> bool:
        """Whether each frame is to be shown."""
        return self.subscriptions > 0

    def show(self, frame: Frame) -> None:
        """Publish a new frame."""
        self._served = self.subscriptions
        if self._served:
            self._send(frame)

    def show_late(self, frame: Frame) -> None:
        """Publish the last frame again if there are more subscriptions since."""
        served, self._served = self._served, self.subscriptions
        if self._served > served:
            self._send(frame)

    def _send(self, frame: Frame) -> bool:
        """Publish the message of a frame, and return whether it has one."""
        message = self._encoder.encode(frame)
        if message is None:
            return False
        self._publisher.publish(message)
        return True


class ClockStream(Stream):
    """
    The stream of simulation time, closed as `publish_clock` and `robots_in_past` say.

    :param publisher: of `clock`
    :param values: of the parameters of the node, by name, always up to date
    """

    def __init__(self, publisher: Publisher, values: Mapping[str, Any]) -> None:
        super().__init__(publisher, ClockEncoder())
        self._values = values
        self._in_past = False

    @property
    def subscriptions(self) -> int:
        """Return the number of subscriptions; 0 while closed."""
        frozen = self._in_past and self._values['robots_in_past'] == 'freeze'
        return super().subscriptions if self._values['publish_clock'] and not frozen else 0

    def show(self, frame: Frame) -> None:
        """Publish the time of a new frame."""
        self._in_past = frame.past
        super().show(frame)


class LatchedStream(Stream):
    """A stream whose last message DDS keeps for late subscribers."""

    def __init__(self, publisher: Publisher, encoder: Encoder) -> None:
        super().__init__(publisher, encoder)
        self._latched: Frame | None = None
        # Whether the message of the last frame is still being encoded.
        self._is_late = False

    @property
    def is_read(self) -> bool:
        """Whether each frame is to be shown, for a subscription or to finish a message."""
        return self._is_late or super().is_read

    def show(self, frame: Frame) -> None:
        """Publish a new frame; without subscribers only if the latched one is outdated."""
        super().show(frame)
        if not self._served and self._is_outdated(frame):
            self._send(frame)

    def _is_outdated(self, frame: Frame) -> bool:
        """Return whether the latched frame has other bodies than a new one, or is old."""
        last = self._latched
        if last is None or last.snapshot.scene is not frame.snapshot.scene:
            return True
        return is_later(frame, last, LATCH_PERIOD)

    def show_late(self, frame: Frame) -> None:
        """Publish the last frame again if it is not the latched one, or for new subscriptions."""
        super().show_late(frame)
        # The world is paused: the latched message becomes that of the last frame.
        if self._latched is not frame:
            self._send(frame)

    def _send(self, frame: Frame) -> bool:
        self._is_late = not super()._send(frame)
        if not self._is_late:
            self._latched = frame
        return not self._is_late
