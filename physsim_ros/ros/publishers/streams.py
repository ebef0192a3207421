# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Streams: topics of which each frame has a message.

Law: a stream without subscribers is not encoded, and a late subscriber receives the last frame.

The exception is the latched stream: DDS keeps its last message for late subscribers (transient
local). It is published without subscribers too, when the scene has changed and every
`LATCH_PERIOD` of time.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from physsim_ros.model.snapshot import Frame
from physsim_ros.ros.encoders.streams import ClockEncoder
from physsim_ros.ros.topics import LATCHED
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rosgraph_msgs.msg import Clock

# Time from one message of a latched stream without subscribers to the next at speed 1 [s].
LATCH_PERIOD = 1.0


class Encoder(Protocol):
    """An encoder of frames."""

    def encode(self, frame: Frame) -> Any:
        """Return the message of a frame, serialised or not; None where the frame has none."""


class Stream:
    """
    Publishes frames on a topic while it has subscribers.

    :param node: that owns the publisher
    :param kind: type of the messages
    :param topic: name of the topic
    :param encoder: of frames
    :param qos: of the publisher, or its depth

    :ivar name: of the topic on the graph
    """

    def __init__(
        self, node: Node, kind: Any, topic: str, encoder: Encoder, qos: QoSProfile | int = 5
    ) -> None:
        self._publisher = node.create_publisher(kind, topic, qos)
        self.name = self._publisher.topic_name
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

    :param node: that owns the publisher
    :param values: of the parameters of the node, by name, always up to date
    """

    def __init__(self, node: Node, values: Mapping[str, Any]) -> None:
        super().__init__(node, Clock, 'clock', ClockEncoder(), 10)
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

    def __init__(self, node: Node, kind: Any, topic: str, encoder: Encoder) -> None:
        super().__init__(node, kind, topic, encoder, LATCHED)
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
        return frame.has_passed(LATCH_PERIOD, since=last)

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
