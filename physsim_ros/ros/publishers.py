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
Frames and answers to topics: the publishers of the world and their QoS.

Law: a stream that nobody subscribes to costs nothing, and who comes late sees what is so.

The picture is the one exception: its last message is kept for who comes late, so that it goes out
unseen too, when the scene has changed and every `QUIET` frames.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
import time
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PoseArray
from physsim_ros.model.preview import NO_PREVIEW, Preview
from physsim_ros.model.snapshot import Answer, Frame
from physsim_ros.ros import encoders, preview_markers
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import MarkerArray

# Frames from one unseen picture to the next: a second of them.
QUIET = 60
# The depth of `~/events`. A burst is longer, and what has not arrived when it is pushed out is
# lost, so that more wait for it.
KEPT_ANSWERS = 1000
# Whoever has not taken them after that long has stopped [s]. Fast DDS asks after 3.
PATIENCE = 5.0

Encode = Callable[[Frame], bytes | None]


class Streams:
    """
    The world's output topics.

    :param node: whose topics they are
    :param frame_id: name of the world frame
    :param publish_clock: whether simulation time goes to `clock`
    """

    def __init__(self, node: Node, *, frame_id: str, publish_clock: bool) -> None:
        # Whether the world has been beyond time 0.
        self._began = False
        poses, states = encoders.PosesEncoder(frame_id), encoders.StatesEncoder(frame_id)
        markers, pairs = encoders.MarkersEncoder(frame_id), encoders.ContactsEncoder(frame_id)

        def contacts(frame: Frame) -> bytes | None:
            # None where nobody had asked yet when the frame was made.
            return (
                pairs.encode(frame.snapshot, frame.contacts)
                if frame.contacts is not None
                else None
            )

        def clock(frame: Frame) -> bytes | None:
            # To a node that uses simulation time, 0 means that no clock has come yet: that is so
            # before the first step, and no more when the world comes back to its beginning.
            self._began = self._began or frame.snapshot.stamp > 0
            return encoders.encode_clock(max(1, frame.snapshot.stamp)) if self._began else None

        def publisher(kind: Any, topic: str, depth: int) -> Publisher:
            return node.create_publisher(kind, topic, _reliable(depth))

        picture = _reliable(1, DurabilityPolicy.TRANSIENT_LOCAL)
        self._contacts = _Stream(publisher(MultiDOFJointState, '~/contacts', 5), contacts)
        self._clock = _Stream(publisher(Clock, 'clock', 10), clock)
        self._clock.open = publish_clock
        # Contacts are what happened, not what is so: who comes late has missed them.
        self._lasting = (
            self._clock,
            _Stream(publisher(PoseArray, '~/poses', 5), lambda it: poses.encode(it.snapshot)),
            _Stream(
                publisher(MultiDOFJointState, '~/states', 5),
                lambda it: states.encode(it.snapshot),
            ),
            _Picture(
                node.create_publisher(MarkerArray, '~/markers', picture),
                lambda it: markers.encode(it.snapshot),
            ),
        )
        self._frame_id = frame_id
        self._preview = node.create_publisher(MarkerArray, '~/preview', picture)
        self._shown: Preview = NO_PREVIEW
        self._events = publisher(DiagnosticStatus, '~/events', KEPT_ANSWERS)
        self._answers: deque[bytes] = deque()
        # Answers since all were known to have arrived, and until when more of them wait for that.
        self._unheard = 0
        self._held_until: float | None = None
        self._last: Frame | None = None

    @property
    def publish_clock(self) -> bool:
        """Whether simulation time goes to `clock`; may be changed at any time."""
        return self._clock.open

    @publish_clock.setter
    def publish_clock(self, value: bool) -> None:
        self._clock.open = value

    @property
    def wants_contacts(self) -> bool:
        """Whether anybody subscribes to contacts."""
        return self._contacts.audience > 0

    def publish(self, frame: Frame) -> None:
        """Publish the answers of a frame, and the streams of it that somebody subscribes to."""
        for answer in frame.answers:
            self.report(answer)
        self.flush()
        self._last = frame
        for stream in (*self._lasting, self._contacts):
            stream.publish(frame)

    def welcome(self) -> None:
        """Publish the last frame again where a subscriber has come since; for idle ticks."""
        self.flush()
        if self._last is not None:
            for stream in self._lasting:
                stream.welcome(self._last)

    def show(self, preview: Preview) -> None:
        """Publish what is half drawn where it has changed; who comes late gets the last."""
        if preview != self._shown:
            self._shown = preview
            stamp = self._last.snapshot.stamp if self._last else 0
            message = preview_markers.markers(preview, frame_id=self._frame_id, stamp=stamp)
            self._preview.publish(message)

    def report(self, answer: Answer) -> None:
        """Publish what became of a request, once listeners have kept up with those before."""
        if self._events.get_subscription_count():
            self._answers.append(encoders.encode_event(answer))
            if len(self._answers) == 1:
                self.flush()

    def flush(self) -> None:
        """Publish the answers that wait for listeners to keep up; for every tick."""
        while self._answers and self._keeps_up():
            self._events.publish(self._answers.popleft())
            self._unheard += 1

    def _keeps_up(self) -> bool:
        """Tell whether one more answer pushes none out that has not arrived."""
        if self._unheard < KEPT_ANSWERS:
            return True
        now = time.monotonic()
        if self._held_until is None:
            self._held_until = now + PATIENCE
        if now < self._held_until and not self._events.wait_for_all_acked(Duration()):
            return False
        self._unheard, self._held_until = 0, None
        return True


class _Stream:
    """
    A topic that frames go to while somebody subscribes.

    :param publisher: of the topic
    :param encode: makes the serialised message of a frame, or None where there is none

    :ivar open: whether anything is published at all
    """

    def __init__(self, publisher: Publisher, encode: Encode) -> None:
        self.open = True
        self._publisher = publisher
        self._encode = encode
        # Subscribers to the last frame.
        self._heard = 0

    @property
    def audience(self) -> int:
        """How many subscribe."""
        return self._publisher.get_subscription_count() if self.open else 0

    def publish(self, frame: Frame) -> None:
        """Publish a new frame."""
        self._heard = self.audience
        if self._heard:
            self._send(frame)

    def welcome(self, frame: Frame) -> None:
        """Publish the last frame again where somebody has missed it."""
        heard, self._heard = self._heard, self.audience
        if self._heard > heard:
            self._send(frame)

    def _send(self, frame: Frame) -> None:
        message = self._encode(frame)
        if message is not None:
            self._publisher.publish(message)


class _Picture(_Stream):
    """A stream whose last message is kept for who comes late."""

    def __init__(self, publisher: Publisher, encode: Encode) -> None:
        super().__init__(publisher, encode)
        self._kept: Frame | None = None
        self._quiet = 0

    def publish(self, frame: Frame) -> None:
        super().publish(frame)
        self._quiet += 1
        changed = self._kept is None or self._kept.snapshot.scene is not frame.snapshot.scene
        if changed or self._quiet >= QUIET:
            self._send(frame)

    def welcome(self, frame: Frame) -> None:
        super().welcome(frame)
        # The world stands still: from now on the picture that is kept can be the right one.
        if self._kept is not frame:
            self._send(frame)

    def _send(self, frame: Frame) -> None:
        super()._send(frame)
        self._kept, self._quiet = frame, 0


def _reliable(depth: int, durability: DurabilityPolicy = DurabilityPolicy.VOLATILE) -> QoSProfile:
    return QoSProfile(depth=depth, reliability=ReliabilityPolicy.RELIABLE, durability=durability)
