# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Subscriptions of requests.

Law: no message of a burst is lost, and one that cannot be decoded, or is refused by what handles
it, is answered. rclpy drops messages that it cannot decode silently; so they arrive as bytes here.
Small ones are decoded in the callback, large ones one at a time, behind all messages that have
arrived (`message_queue`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from physsim_ros.model.error_boundary import ErrorBoundary
from physsim_ros.model.errors import Busy, Malformed, Refusal
from physsim_ros.ros.qos_safe_node import LOSSLESS
from physsim_ros.ros.requests.cdr_reader import Truncated
from physsim_ros.ros.requests.decoders import DECODERS
from physsim_ros.ros.requests.message_queue import MessageQueue
from physsim_ros.simulation.request_queue import RequestQueue
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.serialization import deserialize_message

# Size of a message [bytes]: 20,000 markers without points have 4.3 MiB. rclpy makes ten times as
# much of it, and takes 0.7 s for as many colours, 0.4 s for points, of however many markers.
MOST_BYTES = 5 * 2**20
# Size of a message about one thing [bytes]: a marker of 10,000 points, which is told that it has
# too many. Larger ones take longer to decode than to send, and the middleware keeps up to 5,000
# that wait (KEEP_ALL of Fast DDS): 900 markers of 100,000 points took 2.7 GB.
MOST_BYTES_OF_ONE = 2**18


class RequestSubscriptions:
    """
    The subscriptions of a node whose messages are requests.

    :param node: that owns them
    :param requests: the queue that answers refused messages
    :param boundary: of the node

    :ivar undecodable: number of messages that could not be decoded
    :ivar queue: of messages that wait to be decoded
    """

    def __init__(self, node: Node, requests: RequestQueue, boundary: ErrorBoundary) -> None:
        self.undecodable = 0
        self.queue = MessageQueue(node)
        self._node = node
        self._requests = requests
        self._boundary = boundary

    def add(
        self, kind: type, topic: str, callback: Callable[[Any], Iterator[None] | None]
    ) -> None:
        """
        Subscribe to messages of a type.

        :param callback: handles a message, or returns the pieces of that; a `Refusal` that it
            raises is answered
        """

        def handle(data: bytes) -> Iterator[None] | None:
            try:
                with self._boundary.message(topic):
                    pieces = callback(self._decoded(data, kind))
            except Refusal as refusal:
                self._requests.refuse(refusal, topic=topic, subject='')
                return None
            return None if pieces is None else in_pieces(pieces)

        def in_pieces(pieces: Iterator[None]) -> Iterator[None]:
            is_left = True
            try:
                while is_left:
                    with self._boundary.message(topic):
                        is_left = next(pieces, self) is not self
                    yield
            except Refusal as refusal:
                self._requests.refuse(refusal, topic=topic, subject='')

        def receive(data: bytes) -> None:
            try:
                self.queue.add_message(handle, data)
            except Busy as refusal:
                self._requests.refuse(refusal, topic=topic, subject='')

        self._node.create_subscription(kind, topic, receive, LOSSLESS, raw=True)

    def _decoded(self, data: bytes, kind: type) -> Any:
        """
        Return a message, and count one that cannot be decoded.

        :raises Malformed: it is too large, too long, or cannot be decoded
        """
        decoder = DECODERS.get(kind)
        most = MOST_BYTES_OF_ONE if decoder is None else MOST_BYTES
        if len(data) > most:
            raise Malformed(f'such a message has at most {most / 2**10:g} KiB')
        try:
            return deserialize_message(data, kind) if decoder is None else decoder(data)
        except (Truncated, rclpy_implementation.RMWError) as error:
            self.undecodable += 1
            message = f'the message cannot be decoded as a {kind.__name__}'
            raise Malformed(message) from error
