# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The executor of a test, which spins until all messages have arrived; the client of its requests.

The client publishes the requests of a test and receives the answers.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
import time
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
from physsim_ros.ros.node import PhysSimNode
from physsim_ros.ros.topics import LOSSLESS
from physsim_ros.testing.values import Refused
from rclpy.context import Context
from rclpy.exceptions import InvalidHandle
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.publisher import Publisher

# Timeout for events that take milliseconds in this process, in wall time [s]: a busy machine may
# stop it for seconds.
TIMEOUT = 60.0
# The greatest number of rounds of messages in reaction to messages: two nodes that answer each
# other never end.
_MOST_ROUNDS = 100
# Additional timeout for each marker of an array, which takes half a millisecond [s].
_TIMEOUT_EACH = 0.01


class SettlingExecutor:
    """
    An events executor that spins until messages have arrived.

    :param context: of the nodes

    :ivar errors: to be raised where nodes spin, from whatever thread they are
    """

    def __init__(self, context: Context) -> None:
        self.errors: list[BaseException] = []
        self._executor = EventsExecutor(context=context)
        self._nodes: list[Node] = []

    def add_node(self, node: Node) -> None:
        """Spin a node from now on."""
        self._nodes.append(node)
        self._executor.add_node(node)

    def shutdown(self) -> None:
        """
        Remove and destroy all nodes, and shut the executor down.

        The participant of a context, with its threads and sockets, ends with its last node.
        """
        for node in self._nodes:
            self._executor.remove_node(node)
        self._executor.shutdown()
        for node in reversed(self._nodes):
            # One that the test has destroyed may not be able to end twice.
            with suppress(InvalidHandle):
                node.destroy_node()

    def settle(self) -> None:
        """
        Spin until all messages have arrived, those in reaction to them too.

        :raises TimeoutError: nodes keep answering each other
        """
        for _ in range(_MOST_ROUNDS):
            spins = self._spin_to_barrier()
            self.raise_error()
            if spins <= 1:
                return
        raise TimeoutError('nodes keep answering each other while time is paused')

    def spin_until(
        self, predicate: Callable[[], object], otherwise: str, timeout: float = TIMEOUT
    ) -> None:
        """
        Spin until a predicate is true.

        :param otherwise: message of the error
        :param timeout: wall time [s]
        :raises TimeoutError: it is not true in time
        """
        __tracebackhide__ = True
        deadline = time.monotonic() + timeout
        while not predicate():
            if time.monotonic() > deadline:
                raise TimeoutError(otherwise)
            self._executor.spin_once(timeout_sec=0.01)
            self.raise_error()

    def raise_error(self) -> None:
        """Raise the first of the errors that no call has raised."""
        if self.errors:
            raise self.errors.pop(0)

    def _spin_to_barrier(self) -> int:
        """Spin until all events queued now are handled, and return the number of spins."""
        reached: list[bool] = []
        self._executor.create_task(lambda: reached.append(True))
        spins = 0
        while not reached:
            self._executor.spin_once(timeout_sec=0)
            spins += 1
        return spins


class RequestClient:
    """
    Publishes requests to a world, and waits for the answers.

    :param node: that publishes them
    :param world: the node of the world
    :param executor: spins both nodes
    """

    def __init__(self, node: Node, world: PhysSimNode, executor: SettlingExecutor) -> None:
        self._node = node
        self._world = world
        self._executor = executor
        self._publishers: dict[str, Publisher] = {}
        events = node.create_subscription(
            DiagnosticStatus, '/physsim/events', self._receive, LOSSLESS
        )
        self._topic = ''
        self._received: list[DiagnosticStatus] = []
        executor.add_node(node)
        executor.spin_until(events.get_publisher_count, 'the world was not discovered')

    def _publisher_of(self, topic: str, message: Any) -> Publisher:
        """Return the publisher of a topic, which its first message creates."""
        if topic not in self._publishers:
            publisher = self._node.create_publisher(type(message), f'/physsim/{topic}', 10)
            self._executor.spin_until(
                publisher.get_subscription_count, f'the world does not listen to {topic}'
            )
            self._publishers[topic] = publisher
        return self._publishers[topic]

    def request(self, topic: str, message: Any, answers: int = 1) -> str:
        """
        Publish a request, apply it without advancing time, and return the answer's subject.

        :param topic: below `/physsim`
        :param answers: number of answers that the request has
        :raises Refused: with the code of the first refusal
        """
        publisher = self._publisher_of(topic, message)
        # Answers to earlier requests of other nodes come first, and are skipped.
        self._executor.settle()
        earlier = sum(answer.topic == f'~/{topic}' for answer in self._world.loop.apply_requests())
        count = earlier + answers
        self._topic, self._received = f'~/{topic}', []
        publisher.publish(message)

        def answered() -> bool:
            self._world.loop.apply_requests()
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
