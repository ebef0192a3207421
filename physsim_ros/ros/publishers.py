# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
The publishers of the world: topics, types and QoS, and the frames at which each publishes.

Law: a stream without subscribers is not encoded, and a late subscriber receives the last frame.

The exception is `~/markers`: DDS keeps its last message for late subscribers (transient local).
It is published without subscribers too, when the scene has changed and every `LATCH_PERIOD`
frames.
"""

from __future__ import annotations

from collections import deque
import time
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseArray
from physsim_ros.model.errors import BadProperty
from physsim_ros.model.preview import NO_PREVIEW, Preview
from physsim_ros.model.snapshot import Answer, Frame
from physsim_ros.model.timeline import TimelineStatus
from physsim_ros.ros import encoders
from physsim_ros.ros.encoders import Encoder
from physsim_ros.ros.timeline_publisher import TimelinePublisher
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import MarkerArray

# Frames between messages on `~/markers` without subscribers: one second of them at 60 Hz.
LATCH_PERIOD = 60
# Depth of `~/events`: a message that is not yet acknowledged is lost when the history is full, so
# that in a longer burst answers wait until those before have been acknowledged.
EVENTS_DEPTH = 1000
# The longest wait for an acknowledgement [s]. Fast DDS repeats a heartbeat every 3 s by default.
ACK_TIMEOUT = 5.0
# While a subscriber has stopped, half a history each period [s]: to a subscriber that reads, ten
# times the answers that the node gives, and five periods of the heartbeat to repeat what was lost.
PACE, PACED = 0.05, EVENTS_DEPTH // 2
# Answers that wait for acknowledgements [1], of some 300 bytes each: five seconds of a flood.
MOST_WAITING = 50_000


class Publishers:
    """
    The publishers of the world.

    :param node: that owns them
    :param frame_id: name of the world frame
    :param publish_clock: whether simulation time is published on `clock`
    :param publish_tf: whether poses are published on `/tf`, too
    :raises BadProperty: they cannot be, since tf2_msgs is not installed
    :ivar events: the publisher of `~/events`
    """

    def __init__(
        self, node: Node, *, frame_id: str, publish_clock: bool, publish_tf: bool = False
    ) -> None:
        def stream(kind: Any, topic: str, depth: int, encoder: Encoder) -> _Stream:
            return _Stream(node.create_publisher(kind, topic, _reliable(depth)), encoder)

        def latched(kind: Any, topic: str) -> Publisher:
            qos = _reliable(1, DurabilityPolicy.TRANSIENT_LOCAL)
            return node.create_publisher(kind, topic, qos)

        self._clock = stream(Clock, 'clock', 10, encoders.ClockEncoder())
        self._clock.open = publish_clock
        # Contacts are those of one frame, so a late subscriber does not receive the last ones.
        self._contacts = stream(
            MultiDOFJointState, '~/contacts', 5, encoders.ContactsEncoder(frame_id)
        )
        self._state_streams: tuple[_Stream, ...] = (
            self._clock,
            stream(PoseArray, '~/poses', 5, encoders.PosesEncoder(frame_id)),
            stream(MultiDOFJointState, '~/states', 5, encoders.StatesEncoder(frame_id)),
            _LatchedStream(latched(MarkerArray, '~/markers'), encoders.MarkersEncoder(frame_id)),
        )
        if publish_tf:
            # The depth that tf2_ros has.
            tf = stream(_tf_message(), '/tf', 100, encoders.TransformsEncoder(frame_id))
            self._state_streams += (tf,)
        self._timeline = TimelinePublisher(latched(DiagnosticStatus, '~/timeline'))
        self._preview_publisher = latched(MarkerArray, '~/preview')
        self._frame_id = frame_id
        self._preview: Preview = NO_PREVIEW
        self._frame: Frame | None = None
        self.events = EventPublisher(
            node.create_publisher(DiagnosticStatus, '~/events', _reliable(EVENTS_DEPTH))
        )

    @property
    def publish_clock(self) -> bool:
        """Whether simulation time is published on `clock`; may be changed at any time."""
        return self._clock.open

    @publish_clock.setter
    def publish_clock(self, value: bool) -> None:
        self._clock.open = value

    @property
    def wants_contacts(self) -> bool:
        """Whether `~/contacts` has subscribers."""
        return self._contacts.subscriptions > 0

    def publish_frame(self, frame: Frame) -> None:
        """Publish the answers of a frame, and those of its streams that have subscribers."""
        for answer in frame.answers:
            self.publish_answer(answer)
        self.flush_answers()
        self._frame = frame
        for stream in (*self._state_streams, self._contacts):
            stream.publish(frame)

    def publish_to_late_subscribers(self) -> None:
        """Publish the last frame to later subscribers; called at ticks without a frame."""
        self.flush_answers()
        if self._frame is not None:
            for stream in self._state_streams:
                stream.publish_to_late_subscribers(self._frame)

    def publish_timeline(self, status: TimelineStatus, *, moving: bool) -> None:
        """
        Publish the status of the timeline if it has changed.

        :param moving: whether time goes on, or back; then a change of times alone may wait
        """
        self._timeline.publish(status, moving=moving)

    def publish_preview(self, preview: Preview) -> None:
        """Publish a preview if it has changed."""
        if preview != self._preview:
            self._preview = preview
            stamp = self._frame.snapshot.stamp if self._frame else 0
            message = encoders.preview_message(preview, frame_id=self._frame_id, stamp=stamp)
            self._preview_publisher.publish(message)

    def publish_answer(self, answer: Answer) -> None:
        """Publish the answer to a request, after those that wait for acknowledgements."""
        self.events.publish(answer)

    def flush_answers(self) -> None:
        """Publish the answers that wait for acknowledgements, as far as these have come."""
        self.events.flush()


class EventPublisher:
    """
    Publishes answers, at most `EVENTS_DEPTH` ahead of what subscribers have acknowledged.

    A subscriber that has not acknowledged for `ACK_TIMEOUT` while answers wait, or for which more
    than `MOST_WAITING` wait, has stopped: until it acknowledges, the others' answers do not wait
    for it, and it loses those that leave the history. DDS reports only whether all subscribers
    have acknowledged, not which of them.

    :param publisher: of `~/events`
    :ivar stopped: whether a subscriber has stopped
    """

    def __init__(self, publisher: Publisher) -> None:
        self.stopped = False
        self._publisher = publisher
        self._waiting: deque[bytes] = deque()
        # Answers since all before were acknowledged, and the steady time of the first of them [s].
        self._unacknowledged = 0
        self._since = 0.0
        # While a subscriber has stopped: answers of this period, and the steady time of its end.
        self._paced = 0
        self._period_end = 0.0

    @property
    def waiting(self) -> int:
        """Return the number of answers that wait for acknowledgements."""
        return len(self._waiting)

    def publish(self, answer: Answer) -> None:
        """Publish an answer, after those that wait."""
        if self._publisher.get_subscription_count():
            self._waiting.append(encoders.encode_event(answer))
            # While others wait, acknowledgements are looked up once a tick.
            if len(self._waiting) == 1:
                self._publish_waiting()

    def flush(self) -> None:
        """Publish the answers that need not wait any longer; called at each tick."""
        if self._unacknowledged:
            self._look_up_acknowledgements()
        self._publish_waiting()

    def _publish_waiting(self) -> None:
        while self._waiting and self._has_room():
            if not self._unacknowledged:
                self._since = time.monotonic()
            self._publisher.publish(self._waiting.popleft())
            self._unacknowledged += 1

    def _look_up_acknowledgements(self) -> None:
        if self._publisher.wait_for_all_acked(Duration()):
            self._unacknowledged, self.stopped = 0, False

    def _has_room(self) -> bool:
        """Return whether one more answer displaces none that a subscriber may still ask for."""
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
            self._paced, self._period_end = 0, now + PACE
        self._paced += 1
        return self._paced <= PACED


class _Stream:
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


class _LatchedStream(_Stream):
    """A stream whose last message DDS keeps for late subscribers."""

    def __init__(self, publisher: Publisher, encoder: Encoder) -> None:
        super().__init__(publisher, encoder)
        self._latched: Frame | None = None
        self._age = 0

    def publish(self, frame: Frame) -> None:
        super().publish(frame)
        self._age += 1
        changed = self._latched is None or self._latched.snapshot.scene is not frame.snapshot.scene
        if changed or self._age >= LATCH_PERIOD:
            self._send(frame)

    def publish_to_late_subscribers(self, frame: Frame) -> None:
        super().publish_to_late_subscribers(frame)
        # The world is paused: the latched message becomes that of the last frame.
        if self._latched is not frame:
            self._send(frame)

    def _send(self, frame: Frame) -> None:
        super()._send(frame)
        self._latched, self._age = frame, 0


def _tf_message() -> Any:
    """
    Return the message type of `/tf`, which is no part of common_interfaces.

    :raises BadProperty: its package is not installed
    """
    try:
        from tf2_msgs.msg import TFMessage  # noqa: PLC0415 - most worlds do without
    except ModuleNotFoundError as error:
        raise BadProperty(
            'publish_tf needs the package tf2_msgs, which is not installed here (on Ubuntu '
            'ros-jazzy-tf2-msgs; there is no wheel of it)',
            field='publish_tf',
        ) from error
    return TFMessage


def _reliable(depth: int, durability: DurabilityPolicy = DurabilityPolicy.VOLATILE) -> QoSProfile:
    return QoSProfile(depth=depth, reliability=ReliabilityPolicy.RELIABLE, durability=durability)
