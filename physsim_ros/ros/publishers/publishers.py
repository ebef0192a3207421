# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The publishers of the world: topics with their types, encoders and QoS, in one list."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any, Protocol

from geometry_msgs.msg import PoseArray
from nav_msgs.msg import OccupancyGrid
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.snapshot import Frame
from physsim_ros.model.timeline import TimelineStatus
from physsim_ros.ros.encoders.map import MapEncoder
from physsim_ros.ros.encoders.markers import MarkersEncoder
from physsim_ros.ros.encoders.preview import PreviewEncoder
from physsim_ros.ros.encoders.streams import (
    ContactsEncoder,
    PosesEncoder,
    StatesEncoder,
    TransformsEncoder,
)
from physsim_ros.ros.publishers.event_publisher import EventPublisher
from physsim_ros.ros.publishers.interactive_markers import InteractiveMarkers
from physsim_ros.ros.publishers.streams import ClockStream, LatchedStream, Stream
from physsim_ros.ros.publishers.timeline_publisher import TimelinePublisher
from physsim_ros.ros.robots.frames import TF_DEPTH, tf_message_type
from physsim_ros.ros.topics import LATCHED
from rclpy.node import Node
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import MarkerArray


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
        frame_id, publish_rate = values['frame_id'], values['publish_rate']
        # Contacts are those of one frame, so a late subscriber does not receive the last ones.
        self.contacts = Stream(node, MultiDOFJointState, '~/contacts', ContactsEncoder(frame_id))
        # DDS keeps the last map, and the last preview, for late subscribers; there is another one
        # when it changes.
        grid = MapEncoder(frame_id, lambda: values['map_resolution'])
        self.preview = Stream(node, MarkerArray, '~/preview', PreviewEncoder(frame_id), LATCHED)
        markers = MarkersEncoder(frame_id, publish_rate)
        self.streams = [
            ClockStream(node, values),
            Stream(node, PoseArray, '~/poses', PosesEncoder(frame_id)),
            Stream(node, MultiDOFJointState, '~/states', StatesEncoder(frame_id)),
            LatchedStream(node, MarkerArray, '~/markers', markers),
            Stream(node, OccupancyGrid, '~/map', grid, LATCHED),
            self.preview,
        ]
        if values['publish_tf']:
            self.streams.append(_transforms(node, frame_id))
        self.events = EventPublisher(node)
        self.timeline = TimelinePublisher(node, status)
        self._interactive_markers = InteractiveMarkers(node, frame_id, publish_rate)
        self.late: tuple[LateOutput, ...] = (*self.streams, self._interactive_markers)
        self.outputs: tuple[Output, ...] = (
            self.events,
            *self.streams,
            self.contacts,
            self._interactive_markers,
            self.timeline,
        )

    @property
    def is_read(self) -> bool:
        """Whether a topic of frames has subscribers."""
        streams = (each.is_read for each in (*self.streams, self.contacts))
        return any((self._interactive_markers.is_read, self.timeline.is_read, *streams))


def _transforms(node: Node, frame_id: str) -> Stream:
    """
    Return the stream of transforms.

    :raises BadProperty: tf2_msgs is not installed
    """
    message = tf_message_type()
    if message is None:
        raise BadProperty(
            'publish_tf needs the package tf2_msgs, which is not installed here (on '
            'Ubuntu ros-jazzy-tf2-msgs; there is no wheel of it)',
            field='publish_tf',
        )
    return Stream(node, message, '/tf', TransformsEncoder(frame_id), TF_DEPTH)
