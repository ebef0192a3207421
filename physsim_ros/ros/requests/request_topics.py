# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The topics of requests.

Law: a callback converts a message and submits the request, or reports the refusal; all decisions
are taken by the simulation.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from geometry_msgs.msg import PointStamped
from nav_msgs.msg import OccupancyGrid
from physsim_ros.model.errors import Refusal
from physsim_ros.model.requests import Anchor, Axle, Pin, Release, Request
from physsim_ros.model.snapshot import Answer
from physsim_ros.ros.requests import conversions
from physsim_ros.ros.requests.subscriptions import RequestSubscriptions
from physsim_ros.simulation.request_queue import RequestQueue
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import InteractiveMarkerFeedback, Marker, MarkerArray

# Converts a message, with keyword `frame_id`.
_Conversion = Callable[..., Request]
_TOPICS: dict[str, tuple[type, _Conversion]] = {
    '~/spawn': (Marker, conversions.body_request),
    '~/join': (Marker, conversions.joint_request),
    '~/pin': (PointStamped, partial(conversions.point_request, Pin)),
    '~/axle': (PointStamped, partial(conversions.point_request, Axle)),
    '~/anchor': (PointStamped, partial(conversions.point_request, Anchor)),
    '~/release': (PointStamped, partial(conversions.point_request, Release)),
    '~/command': (MultiDOFJointState, conversions.command_request),
    '~/drag/feedback': (InteractiveMarkerFeedback, conversions.hand_request),
}


class RequestTopics:
    """
    The topics of which each message is a request; of `~/spawn_array` and `~/walls`, several.

    :param subscriptions: of the node
    :param requests: the queue that they are submitted to
    :param frame_id: name of the world frame
    """

    def __init__(
        self, subscriptions: RequestSubscriptions, requests: RequestQueue, frame_id: str
    ) -> None:
        self._requests = requests
        self._frame_id = frame_id
        for topic, (kind, convert) in _TOPICS.items():
            field = 'point' if kind is PointStamped else ''
            callback = partial(self._submit, topic=topic, convert=convert, field=field)
            subscriptions.add(kind, topic, callback)
        subscriptions.add(MarkerArray, '~/spawn_array', self._spawn_array)
        subscriptions.add(OccupancyGrid, '~/walls', self._make_walls)

    def _spawn_array(self, message: MarkerArray) -> Iterator[None]:
        """Convert the markers in pieces, then submit them together."""
        topic = '~/spawn_array'
        if not message.markers:
            self._requests.tell(Answer(topic=topic, message='the array is empty'))
        converted: list[Request | Refusal] = []
        for marker in message.markers:
            converted.append(self._converted(marker, conversions.body_request))
            yield
        for number, (marker, request) in enumerate(zip(message.markers, converted, strict=True)):
            self._submit_converted(request, marker, topic=topic, joined=number > 0)

    def _make_walls(self, message: OccupancyGrid) -> None:
        requests = conversions.walls_requests(message, frame_id=self._frame_id)
        for number, request in enumerate(requests):
            self._requests.submit(request, topic='~/walls', joined=number > 0)

    def _submit(
        self,
        message: Any,
        *,
        topic: str,
        convert: _Conversion,
        field: str = '',
    ) -> None:
        """
        Submit the request of a message.

        :param field: the one field of the message, to be named by a refusal; '' is several
        """
        converted = self._converted(message, convert)
        self._submit_converted(converted, message, topic=topic, field=field)

    def _converted(self, message: Any, convert: _Conversion) -> Request | Refusal:
        """Return the request of a message, or the refusal of the message."""
        try:
            return convert(message, frame_id=self._frame_id)
        except Refusal as refusal:
            return refusal

    def _submit_converted(
        self,
        request: Request | Refusal,
        message: Any,
        *,
        topic: str,
        joined: bool = False,
        field: str = '',
    ) -> None:
        """
        Submit a request, or a refusal, of a message; other parameters are those of `_submit`.

        :param joined: whether it is undone together with the one before
        """
        if isinstance(request, Refusal):
            subject = conversions.subject_of(message, joint=topic == '~/join')
            self._requests.refuse(request, topic=topic, subject=subject, joined=joined)
        else:
            self._requests.submit(request, topic=topic, joined=joined, field=field)
