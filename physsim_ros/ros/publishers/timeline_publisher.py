# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`~/timeline`: diagnostic_msgs/DiagnosticStatus, the time that is shown, and the history.

Law: the last message is that of the last frame; while time runs, its times may be 15 frames old.
"""

from __future__ import annotations

from collections.abc import Callable
from operator import attrgetter

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from physsim_ros.model.snapshot import Frame
from physsim_ros.model.timeline import TimelineStatus
from rclpy.publisher import Publisher

# Frames from one message to the next while nothing but time changes: 4 Hz at 60 frames a second.
PERIOD = 15

_BUT_TIMES = attrgetter('state', 'speed', 'course', 'undo', 'redo', 'courses')


class TimelinePublisher:
    """
    Publishes the status of the timeline when it changes.

    :param publisher: of `~/timeline`
    :param status: returns the status of the timeline

    :ivar name: of the topic
    """

    name = '~/timeline'

    def __init__(self, publisher: Publisher, status: Callable[[], TimelineStatus]) -> None:
        self._publisher = publisher
        self._status = status
        self._last: TimelineStatus | None = None
        # Frames since the last message.
        self._age = 0

    def show(self, frame: Frame) -> None:
        """Publish the status of the timeline at a frame, if it has changed."""
        self.publish(may_wait=frame.moved)

    def publish(self, *, may_wait: bool) -> None:
        """
        Publish the status if it has changed.

        :param may_wait: whether a change of times alone may wait, as time goes on, or back
        """
        self._age += 1
        status, last = self._status(), self._last
        # A change of times alone waits.
        waits = last is not None and may_wait and self._age < PERIOD
        if _BUT_TIMES(status) == _BUT_TIMES(last) if waits else status == last:
            return
        self._last, self._age = status, 0
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
