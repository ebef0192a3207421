# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The topics of requests.

Laws: a callback converts a message and submits the request, or reports the refusal; all decisions
are taken by the simulation. No message of a burst is lost; one that is too large or cannot be
decoded is answered.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

from geometry_msgs.msg import PointStamped
from nav_msgs.msg import OccupancyGrid, Path
from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import Anchor, AtPoint, Axle, Pin, Release, Request
from physsim_ros.model.translation import Text
from physsim_ros.ros.requests import conversions
from physsim_ros.ros.topics import decoded, LOSSLESS, Undecodable
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.simulation.entries import Origin, Unread
from physsim_ros.simulation.request_queue import RequestQueue
from rclpy.node import Node
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import InteractiveMarkerFeedback, Marker, MarkerArray

# Bound of a message about one thing [bytes]: a marker of 10,000 points, which is told that it has
# too many. Larger ones take longer to decode than to send.
MOST_BYTES_OF_ONE = 2**18
# Bounds of messages about many things [bytes]: 20,000 markers without points have 4.3 MiB, of
# which rclpy makes ten times as much, in 1 s; a stroke of 10,000 samples has 0.8 MB, in 0.24 s.
MOST_BYTES = {
    MarkerArray: 5 * 2**20,
    MultiDOFJointState: 5 * 2**20,
    OccupancyGrid: 5 * 2**20,
    Path: 2**20,
}


class _RequestTopic(NamedTuple):
    """
    A topic of which each message is a request.

    :ivar kind: type of its messages
    :ivar convert: returns the request of a message, by the name of the world frame
    :ivar subject: returns the body or joint that a refused message names, or ''
    :ivar field: the only field of its messages; '' if they have several
    """

    kind: type
    convert: Callable[[Any, str], Request]
    subject: Callable[[Any], str] = lambda _: ''
    field: str = ''


def _of_points(request: type[AtPoint]) -> _RequestTopic:
    return _RequestTopic(PointStamped, partial(conversions.point_request, request), field='point')


TOPICS = {
    '~/spawn': _RequestTopic(Marker, conversions.body_request, conversions.name_of),
    '~/join': _RequestTopic(Marker, conversions.joint_request, conversions.joint_name_of),
    '~/pin': _of_points(Pin),
    '~/axle': _of_points(Axle),
    '~/anchor': _of_points(Anchor),
    '~/release': _of_points(Release),
    '~/command': _RequestTopic(
        MultiDOFJointState, conversions.command_request, conversions.only_name_in
    ),
    '~/drag/feedback': _RequestTopic(InteractiveMarkerFeedback, conversions.hand_request),
}


class RequestTopics:
    """
    The topics of which each message is a request; of `~/spawn_array` and `~/walls`, several.

    :param node: that subscribes
    :param requests: the queue to which they are submitted
    :param boundary: of the node
    :param frame_id: name of the world frame

    :ivar undecodable: number of messages that could not be decoded
    """

    def __init__(
        self, node: Node, requests: RequestQueue, boundary: ErrorBoundary, frame_id: str
    ) -> None:
        self.undecodable = 0
        self._node = node
        self._requests = requests
        self._boundary = boundary
        self._frame_id = frame_id
        for name, topic in TOPICS.items():
            self.subscribe(topic.kind, name, partial(self._submit, name, topic))
        self.subscribe(MarkerArray, '~/spawn_array', self._spawn_array)
        self.subscribe(OccupancyGrid, '~/walls', self._make_walls)

    def subscribe(self, kind: type, topic: str, callback: Callable[[Any], None]) -> None:
        """
        Subscribe to messages of a type.

        :param callback: handles a message; a `Refusal` that it raises is answered
        """

        def receive(data: bytes) -> None:
            try:
                with self._boundary.message(topic):
                    callback(self._decoded(data, kind))
            except Refusal as refusal:
                self._requests.refuse(refusal, Origin(topic))

        self._node.create_subscription(kind, topic, receive, LOSSLESS, raw=True)

    def _decoded(self, data: bytes, kind: type) -> Any:
        """
        Return a message, and count one that cannot be decoded.

        :raises Malformed: it is too large, or cannot be decoded
        """
        try:
            return decoded(data, kind, MOST_BYTES.get(kind, MOST_BYTES_OF_ONE))
        except Undecodable:
            self.undecodable += 1
            raise

    def _submit(self, name: str, topic: _RequestTopic, message: Any) -> None:
        """Submit the request of a message, or the refusal of the message."""
        origin = Origin(name, topic.field)
        try:
            request = topic.convert(message, self._frame_id)
        except Refusal as refusal:
            self._requests.refuse(refusal, origin, subject=topic.subject(message))
        else:
            self._requests.submit(request, origin)

    def _spawn_array(self, message: MarkerArray) -> None:
        """Submit the markers of an array as one gesture; each is converted in its turn."""
        topic = '~/spawn_array'
        if not message.markers:
            self._requests.tell(Answer(topic=topic, message=Text('the array is empty')))

        def convert(marker: Marker) -> Request:
            with self._boundary.message(topic):
                return conversions.body_request(marker, self._frame_id)

        for number, marker in enumerate(message.markers):
            name, size = conversions.name_of(marker), conversions.memory_of(marker)
            unread = Unread(name, partial(convert, marker), size)
            self._requests.submit(unread, topic=topic, joined=number > 0)

    def _make_walls(self, message: OccupancyGrid) -> None:
        requests = conversions.walls_requests(message, self._frame_id)
        self._requests.submit_gesture(requests, Origin('~/walls'))
