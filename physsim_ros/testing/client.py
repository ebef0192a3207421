# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The node that publishes the requests of a test and receives the answers."""

from __future__ import annotations

from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import PointStamped
from physsim_ros.ros.node import PhysSimNode
from physsim_ros.ros.qos_safe_node import LOSSLESS, NodeWithoutQosEvents
from physsim_ros.testing.executor import SettlingExecutor, TIMEOUT
from physsim_ros.testing.values import Refused
from rclpy.context import Context
from sensor_msgs.msg import MultiDOFJointState
from visualization_msgs.msg import Marker, MarkerArray

# Additional timeout for each marker of an array, which takes half a millisecond [s].
_TIMEOUT_EACH = 0.01

_MESSAGES = {
    'spawn': Marker,
    'spawn_array': MarkerArray,
    'join': Marker,
    'pin': PointStamped,
    'axle': PointStamped,
    'anchor': PointStamped,
    'release': PointStamped,
    'command': MultiDOFJointState,
}


class RequestClient:
    """
    A node that publishes requests to a world, and waits for the answers.

    :param context: of the world
    :param world: the node of the world
    :param executor: spins both nodes
    """

    def __init__(self, context: Context, world: PhysSimNode, executor: SettlingExecutor) -> None:
        self.node = NodeWithoutQosEvents('physsim_test', context=context)
        self._world = world
        self._executor = executor
        self._publishers = {
            topic: self.node.create_publisher(kind, f'/physsim/{topic}', 10)
            for topic, kind in _MESSAGES.items()
        }
        self.node.create_subscription(DiagnosticStatus, '/physsim/events', self._receive, LOSSLESS)
        self._topic = ''
        self._received: list[DiagnosticStatus] = []
        executor.add_node(self.node)
        executor.spin_until(self._is_matched, 'the world was not discovered')

    def _is_matched(self) -> bool:
        """Return whether publishers and subscriptions are matched with those of the world."""
        outward = all(each.get_subscription_count() for each in self._publishers.values())
        return outward and self.node.count_publishers('/physsim/events') > 0

    def request(self, topic: str, message: Any, answers: int = 1) -> str:
        """
        Publish a request, apply it without advancing time, and return the answer's subject.

        :param topic: below `/physsim`
        :param answers: number of answers that the request has
        :raises Refused: with the code of the first refusal
        """
        # Answers to earlier requests of other nodes come first, and are skipped.
        self._executor.settle()
        earlier = sum(answer.topic == f'~/{topic}' for answer in self._world.apply_requests())
        count = earlier + answers
        self._topic, self._received = f'~/{topic}', []
        self._publishers[topic].publish(message)

        def answered() -> bool:
            self._world.apply_requests()
            own = self._received[earlier:count]
            # An array that is refused whole has one answer, which names no body.
            refused = any(each.level != b'\x00' and not each.hardware_id for each in own)
            return len(own) == answers or refused

        timeout = TIMEOUT + _TIMEOUT_EACH * count
        self._executor.spin_until(answered, f'no answer to {topic}', timeout)
        self._executor.settle()
        own = self._received[earlier:count]
        for status in own:
            if status.level != b'\x00':
                values = {pair.key: pair.value for pair in status.values}
                raise Refused(values['code'], status.message, values.get('field', ''))
        return own[-1].hardware_id if own else ''

    def _receive(self, status: DiagnosticStatus) -> None:
        if status.name == self._topic:
            self._received.append(status)
