# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The publisher of `~/events`: diagnostic_msgs/DiagnosticStatus, the answers to requests.

Laws: no answer is lost to a subscriber that keeps up, and none waits for one that has stopped.
"""

from __future__ import annotations

from collections import deque
import time

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from physsim_ros.model.answer import Answer
from physsim_ros.model.snapshot import Frame
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
