# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The publisher of `~/timeline`: diagnostic_msgs/DiagnosticStatus.

Law: the last message is that of the last frame; while time runs, its times may be a quarter of a
second old.
"""

from __future__ import annotations

from collections.abc import Callable
from operator import attrgetter

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from physsim_ros.model.snapshot import Frame
from physsim_ros.model.timeline import TimelineStatus
from physsim_ros.ros.topics import LATCHED
from rclpy.node import Node

# Time from one message to the next at speed 1 while nothing but time changes [s].
_PERIOD = 0.25
# Of a frame, all by which its status may differ from the last one but for times and answers.
_BUT_TIMES = attrgetter('speed', 'course', 'past')


class TimelinePublisher:
    """
    Publishes the status of the timeline when it changes.

    :param node: that owns the publisher
    :param status: returns the status of the timeline

    :ivar name: of the topic
    """

    name = '~/timeline'

    def __init__(self, node: Node, status: Callable[[], TimelineStatus]) -> None:
        self._publisher = node.create_publisher(DiagnosticStatus, self.name, LATCHED)
        self._status = status
        self._last: TimelineStatus | None = None
        # The last frame whose status was looked up.
        self._frame: Frame | None = None

    @property
    def is_read(self) -> bool:
        """Whether the topic has subscribers."""
        return self._publisher.get_subscription_count() > 0

    def show(self, frame: Frame) -> None:
        """Publish the status of the timeline at a frame, if it has changed."""
        last = self._frame
        if last is None or not self._waits(frame, last):
            self._frame = frame
            self.publish()

    def _waits(self, frame: Frame, last: Frame) -> bool:
        """Return whether times alone have changed since a frame, and not by much."""
        same = frame.passing and not frame.answers and _BUT_TIMES(frame) == _BUT_TIMES(last)
        return same and not frame.has_passed(_PERIOD, since=last)

    def publish(self) -> None:
        """Publish the status if it has changed."""
        status = self._status()
        if status != self._last:
            self._last = status
            self._publisher.publish(_message(status))


def _message(status: TimelineStatus) -> DiagnosticStatus:
    values = {
        'oldest': _seconds(status.oldest),
        'now': _seconds(status.now),
        'newest': _seconds(status.newest),
        'speed': f'{status.speed:g}',
        'course': str(status.course),
        'undo': status.undo,
        'redo': status.redo,
        # Each as number:begins:ends.
        'courses': ' '.join(
            f'{each.number}:{_seconds(each.begins)}:{_seconds(each.ends)}'
            for each in status.courses
        ),
    }
    return DiagnosticStatus(
        level=DiagnosticStatus.OK,
        name='timeline',
        message=status.state,
        values=[KeyValue(key=key, value=value) for key, value in values.items()],
    )


def _seconds(time: float) -> str:
    return f'{time:.6f}'
