# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A topic with a rate and a latency, both in simulation time.

Laws: a message that nobody subscribes to is not made; its latency depends on seed and moment
alone, so that a rewind repeats it. While time goes back, messages have no latency.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from typing import Any

from physsim_ros.model.latency import delay
from physsim_ros.model.robots import Sensor
from physsim_ros.model.transform import Point
from physsim_ros.ros.robots.messages import StampedFrame
from physsim_ros.sensing import is_due
from rclpy.publisher import Publisher


class TimedTopic:
    """
    A topic of a robot that is published at frames, while it is read.

    :param publisher: of the topic
    :param message: makes its message, of a frame and the row of the robot's body in the scene
    :param name: that sets the moments of its rate, and the latencies of its messages
    :param rate: [Hz]; None is each frame
    :param latency: least and greatest time from the frame of a message to its arrival [s]
    :param sensor: whose reading it is; None for other topics

    :ivar latency: as given
    :ivar sensor: as given
    """

    def __init__(
        self,
        publisher: Publisher,
        message: Callable[[StampedFrame, int], Any],
        name: str,
        *,
        rate: float | None,
        latency: Point,
        sensor: Sensor | None,
    ) -> None:
        self.latency, self.sensor = latency, sensor
        self._publisher = publisher
        self._message = message
        self._name = name
        self._rate = rate
        # Messages on their way in their order, with the stamps at which they arrive, and of their
        # frames [ns].
        self._coming: deque[tuple[int, int, Any]] = deque()

    @property
    def is_read(self) -> bool:
        """Whether it has subscribers."""
        return self._publisher.get_subscription_count() > 0

    def publish(self, sensed: StampedFrame, row: int) -> int | None:
        """
        Publish what arrives at a frame, if it is read.

        :return: stamp of the frame of the last message that has arrived [ns]; None without one
        """
        now, before, is_read = sensed.snapshot.stamp, sensed.before, self.is_read
        goes_back = before is not None and now < before.stamp
        if goes_back or not is_read:
            self._coming.clear()
        if is_read and self._is_due(sensed):
            message = self._message(sensed, row)
            if goes_back:
                self._publisher.publish(message)
            else:
                self._send(message, sensed)
        arrived = self._take_arrived(now)
        for _, message in arrived:
            self._publisher.publish(message)
        return arrived[-1][0] if arrived else None

    def send_again(self, seen: Sequence[tuple[StampedFrame, int]], now: int) -> None:
        """
        Send the messages that were on their way at a stamp, after a jump to it.

        :param seen: the frames up to that, each with the row of the robot's body
        :param now: the stamp [ns]
        """
        if self.latency[1] > 0.0 and self.is_read:
            self._coming.clear()
            for sensed, row in seen:
                if self._is_due(sensed):
                    self._send(self._message(sensed, row), sensed)
            self._take_arrived(now)

    def _send(self, message: Any, sensed: StampedFrame) -> None:
        """Send the message of a frame, which arrives after those that were sent before."""
        snapshot = sensed.snapshot
        arrival = snapshot.stamp
        if any(self.latency):
            seed = snapshot.scene.settings.seed
            arrival += round(1e9 * delay(self.latency, seed, self._name, snapshot.step))
        if self._coming:
            arrival = max(arrival, self._coming[-1][0])
        self._coming.append((arrival, snapshot.stamp, message))

    def _take_arrived(self, now: int) -> list[tuple[int, Any]]:
        """Return the messages that have arrived at a stamp, after the stamps of their frames."""
        arrived = []
        while self._coming and self._coming[0][0] <= now:
            arrived.append(self._coming.popleft()[1:])
        return arrived

    def _is_due(self, sensed: StampedFrame) -> bool:
        """Return whether it is published at a frame, at a past one as before."""
        now, before = sensed.snapshot.stamp, sensed.before
        if self._rate is None or before is None:
            return True
        # In a rewind, the frame before is a later one: the period that counts ends with this one.
        period = abs(now - before.stamp)
        return is_due(self._name, self._rate, now - period, now)
