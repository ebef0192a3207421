# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A stream: frames on one topic.

Law: a stream without subscribers is not encoded, and a late subscriber receives the last frame.

The exception is a latched stream: DDS keeps its last message for late subscribers (transient
local). It is published without subscribers too, when the scene has changed and every
`LATCH_PERIOD` frames.
"""

from __future__ import annotations

from physsim_ros.model.snapshot import Frame
from physsim_ros.ros.encoders import Encoder
from rclpy.publisher import Publisher

# Frames between messages on `~/markers` without subscribers: one second of them at 60 Hz.
LATCH_PERIOD = 60


class Stream:
    """
    Publishes frames on a topic while it has subscribers.

    :param publisher: of the topic
    :param encoder: of frames

    :ivar open: whether frames are published at all
    """

    def __init__(self, publisher: Publisher, encoder: Encoder) -> None:
        self.open = True
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
        message = self._encoder.encode(frame)
        if message is not None:
            self._publisher.publish(message)


class LatchedStream(Stream):
    """A stream whose last message DDS keeps for late subscribers."""

    def __init__(self, publisher: Publisher, encoder: Encoder) -> None:
        super().__init__(publisher, encoder)
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
