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
Subscriptions of requests.

Law: no message is lost in a burst, and one that cannot be decoded is answered, too. rclpy drops
such a message without a word, so that messages arrive as bytes here and are decoded in the
callback, or, large ones, one by one behind what has arrived.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from physsim_ros.model.errors import Busy, Malformed, Refusal
from physsim_ros.ros.qos_safe_node import LOSSLESS
from physsim_ros.ros.requests.cdr_reader import Truncated
from physsim_ros.ros.requests.command_reader import command_from
from physsim_ros.ros.requests.message_queue import MessageQueue
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.node import Node
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import MarkerArray

# Size of a message [bytes]: 20,000 markers of 800 bytes. rclpy makes ten times as much of it and
# takes 60 µs for each marker, during which the node does nothing else.
MOST_BYTES = 16 * 2**20
# Size of a message about one thing [bytes]: a marker of 10,000 points, which is told that it has
# too many. Larger ones take longer to decode than to send, and the middleware keeps up to 5,000
# that wait (KEEP_ALL of Fast DDS): 900 markers of 100,000 points took 2.7 GB.
MOST_BYTES_OF_ONE = 2**18
# Messages about many things.
_OF_MANY = (MarkerArray, MultiDOFJointState)
# Decoders that are quicker than that of rclpy.
_DECODERS = {MultiDOFJointState: command_from}


class RequestSubscriptions:
    """
    The subscriptions of a node whose messages are requests.

    :param node: that owns them
    :param refuse: answers a refused message, by refusal and topic
    :ivar undecodable: number of messages that could not be decoded
    :ivar queue: of messages that wait to be decoded
    """

    def __init__(self, node: Node, refuse: Callable[[Refusal, str], None]) -> None:
        self.undecodable = 0
        self.queue = MessageQueue(node)
        self._node = node
        self._refuse = refuse

    def add(self, kind: type, topic: str, callback: Callable[[Any], None]) -> None:
        """Subscribe to messages of a type."""
        most = MOST_BYTES if kind in _OF_MANY else MOST_BYTES_OF_ONE
        decoder = _DECODERS.get(kind)

        def decode(data: bytes) -> None:
            if len(data) > most:
                refusal = Malformed(f'such a message has at most {most / 2**10:g} KiB')
                self._refuse(refusal, topic)
                return
            try:
                message = deserialize_message(data, kind) if decoder is None else decoder(data)
            except (Truncated, rclpy_implementation.RMWError):
                self.refuse_undecodable(kind, topic)
            else:
                callback(message)

        self.add_raw(kind, topic, decode)

    def add_raw(self, kind: type, topic: str, callback: Callable[[bytes], None]) -> None:
        """Subscribe to messages of a type, which the callback decodes itself."""

        def receive(data: bytes) -> None:
            try:
                self.queue.add_message(callback, data)
            except Busy as refusal:
                self._refuse(refusal, topic)

        self._node.create_subscription(kind, topic, receive, LOSSLESS, raw=True)

    def refuse_undecodable(self, kind: type, topic: str) -> None:
        """Count and refuse a message that cannot be decoded."""
        self.undecodable += 1
        self._refuse(Malformed(f'the message cannot be decoded as a {kind.__name__}'), topic)
