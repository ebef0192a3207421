# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Publishers of `~/events` and `~/timeline`, both diagnostic_msgs/DiagnosticStatus.

Laws: no answer is lost to a subscriber that keeps up, and none waits for one that has stopped. The
last message of `~/timeline` is that of the last frame; while time runs, its times may be a quarter
of a second old.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from operator import attrgetter
import time

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from physsim_ros.model.answer import Answer
from physsim_ros.model.snapshot import Frame
from physsim_ros.model.timeline import TimelineStatus
from physsim_ros.ros.topics import LATCHED
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.serialization import serialize_message

# Depth of `~/events`. A full history loses messages that are not yet acknowledged; so the answers
# of a longer burst wait until earlier ones have been acknowledged.
EVENTS_DEPTH = 1000
# The longest wait for an acknowledgement [s], as for that of a page or a viewer: a busy machine
# may stop a subscriber for seconds. `fastdds_profiles.xml` has one asked for 20 times a second.
ACK_TIMEOUT = 10.0
# Answers in each period [s] while a subscriber has stopped: ten times as many as the node
# answers. A subscriber that reads has five heartbeats to ask for answers that it has missed.
STOPPED_PERIOD, STOPPED_ANSWERS = 0.05, EVENTS_DEPTH // 2
# Answers that wait for acknowledgements [1], of some 300 bytes each: 15 MB.
MOST_WAITING = 50_000

# Time from one `~/timeline` to the next at speed 1 while nothing but time changes [s].
TIMELINE_PERIOD = 0.25
# Of a frame, all by which its status may differ from the last one but for times and answers.
_BUT_TIMES = attrgetter('speed', 'course', 'past')


class EventPublisher:
    """
    Publishes answers, at most `EVENTS_DEPTH` ahead of what subscribers have acknowledged.

    A subscriber that has not acknowledged for `ACK_TIMEOUT` while answers wait, or for which more
    than `MOST_WAITING` wait, has stopped: until it acknowledges, the others' answers do not wait
    for it, and it loses those that leave the history. DDS reports only whether all subscribers
    have acknowledged, not which of them.

    :param node: that owns the publisher

    :ivar stopped: whether a subscriber has stopped
    :ivar name: of the topic
    """

    name = '~/events'

    def __init__(self, node: Node) -> None:
        self.stopped = False
        self._publisher = node.create_publisher(DiagnosticStatus, self.name, EVENTS_DEPTH)
        self._waiting: deque[bytes] = deque()
        # Answers since all before were acknowledged, and the steady time of the first of them [s].
        self._unacknowledged = 0
        self._since = 0.0
        # While a subscriber has stopped: answers of this period, and the steady time of its end.
        self._period_count = 0
        self._period_end = 0.0

    @property
    def waiting(self) -> int:
        """Return the number of answers that wait for acknowledgements."""
        return len(self._waiting)

    def show(self, frame: Frame) -> None:
        """Publish the answers of a frame."""
        for answer in frame.answers:
            self.publish(answer)
        self.flush()

    def publish(self, answer: Answer) -> None:
        """Publish an answer, after those that wait."""
        if self._publisher.get_subscription_count():
            self._waiting.append(encode_event(answer))
            # While others wait, acknowledgements are looked up once a tick.
            if len(self._waiting) == 1:
                self._publish_waiting()

    def flush(self) -> None:
        """Publish the answers that need not wait any longer; called at each tick."""
        if self._unacknowledged:
            self._look_up_acknowledgements()
        self._publish_waiting()

    def _publish_waiting(self) -> None:
        while self._waiting and self._take_room():
            if not self._unacknowledged:
                self._since = time.monotonic()
            self._publisher.publish(self._waiting.popleft())
            self._unacknowledged += 1

    def _look_up_acknowledgements(self) -> None:
        if self._publisher.wait_for_all_acked(Duration()):
            self._unacknowledged, self.stopped = 0, False

    def _take_room(self) -> bool:
        """Return whether an answer may go out now; count it where a reader has stopped."""
        if self._unacknowledged < EVENTS_DEPTH:
            return True
        self._look_up_acknowledgements()
        if not self._unacknowledged:
            return True
        now = time.monotonic()
        self.stopped |= now > self._since + ACK_TIMEOUT or len(self._waiting) > MOST_WAITING
        if not self.stopped:
            return False
        if now > self._period_end:
            self._period_count, self._period_end = 0, now + STOPPED_PERIOD
        self._period_count += 1
        return self._period_count <= STOPPED_ANSWERS


def encode_event(answer: Answer) -> bytes:
    """Return an answer as a serialised message, which takes a tenth of the memory of an object."""
    field = [('field', answer.field)] if answer.field else []
    values = [('code', answer.code or 'ok'), *field, *answer.values]
    message: bytes = serialize_message(
        DiagnosticStatus(
            level=DiagnosticStatus.ERROR if answer.code else DiagnosticStatus.OK,
            name=answer.topic,
            message=_encodable(answer.message),
            hardware_id=_encodable(answer.subject),
            values=[KeyValue(key=key, value=_encodable(value)) for key, value in values],
        )
    )
    return message


def _encodable(text: str) -> str:
    """Return a text with '?' for characters without UTF-8, as half surrogates of file names."""
    return text.encode(errors='replace').decode()


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
        return same and not is_later(frame, last, TIMELINE_PERIOD)

    def publish(self) -> None:
        """Publish the status if it has changed."""
        status = self._status()
        if status != self._last:
            self._last = status
            self._publisher.publish(_message(status))


def is_later(frame: Frame, other: Frame, seconds: float) -> bool:
    """
    Return whether a frame comes some time after another one, or before it in a rewind.

    :param seconds: the time [s] at speed 1 and below; of faster time it is as many times as long
    """
    apart = abs(frame.snapshot.stamp - other.snapshot.stamp) * 1e-9
    # Stamps are rounded.
    return apart > seconds * max(1.0, abs(frame.speed)) - 1e-6


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
