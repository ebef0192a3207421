# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The base of the programs here, which know the world by its topics alone, as anybody's would."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count
import json
import sys
import time
from typing import Any

from diagnostic_msgs.msg import DiagnosticStatus
import rclpy
from rclpy.experimental import EventsExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from std_srvs.srv import Trigger
from visualization_msgs.msg import Marker

# Many times what each wait is expected to take, on a machine that is busy with other tests [s].
PATIENCE = 90.0
ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL, reliability=ReliabilityPolicy.RELIABLE)
LAST = QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE)
KEPT = QoSProfile(
    depth=1,
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)


class Visitor:
    """
    A node in a process of its own.

    The world drops the answer to a client that it has not discovered yet, so that clients come
    first: they are announced in order with the subscriptions, and who hears an event is known.

    :param services: of type Trigger, that it will call
    """

    def __init__(self, *services: str) -> None:
        rclpy.init()
        self.node = Node('visitor')
        self._clients: dict[str, Any] = {}
        for service in services:
            self.client(Trigger, service)
        self._executor = EventsExecutor()
        self._executor.add_node(self.node)

    def spin_until(self, predicate: Callable[[], object], what: str) -> None:
        deadline = time.monotonic() + PATIENCE
        while not predicate():
            if time.monotonic() > deadline:
                sys.exit(f'not within {PATIENCE:g} s: {what}')
            self._executor.spin_once(timeout_sec=0.05)

    def publisher(self, kind: type, topic: str) -> Any:
        """Return a publisher that the world hears."""
        publisher = self.node.create_publisher(kind, topic, ALL)
        self.spin_until(publisher.get_subscription_count, f'{topic} heard')
        return publisher

    def listen(self, kind: type, topic: str, qos: QoSProfile = ALL) -> list[Any]:
        """Return the list that messages come into, once both ends have met."""
        return self.listen_if(kind, topic, lambda _: True, qos)

    def listen_if(
        self, kind: type, topic: str, wanted: Callable[[Any], bool], qos: QoSProfile = ALL
    ) -> list[Any]:
        """Return the list that chosen messages come into, once both ends have met."""
        received: list[Any] = []

        def receive(message: Any) -> None:
            if wanted(message):
                received.append(message)

        subscription = self.node.create_subscription(kind, topic, receive, qos)
        self.spin_until(subscription.get_publisher_count, f'{topic} published')
        return received

    def read(self, kind: type, topic: str) -> Any:
        """Return one message of a topic."""
        received: list[Any] = []
        subscription = self.node.create_subscription(kind, topic, received.append, LAST)
        self.spin_until(lambda: received, f'a message on {topic}')
        self.node.destroy_subscription(subscription)
        return received[0]

    def greet(self, events: list[DiagnosticStatus], publisher: Any) -> None:
        """Send refused requests until one is answered: then both directions have met."""
        numbers = count()
        while not events:
            last = f'nobody/{(number := next(numbers))}'
            publisher.publish(Marker(ns='nobody', id=number, action=Marker.DELETE))
            until = time.monotonic() + 0.5
            self.spin_until(lambda: events or time.monotonic() > until, 'an answer')  # noqa: B023
        # Those before it are answered before it, or never.
        self.spin_until(lambda: last in [each.hardware_id for each in events], 'the last answer')
        events.clear()

    def client(self, kind: Any, service: str) -> None:
        """Create the client of a service, so that discovery begins."""
        self._clients[service] = self.node.create_client(kind, service)

    def request(self, service: str, request: Any) -> Any:
        """Return the response of a service."""
        client = self._clients[service]
        self.spin_until(client.service_is_ready, service)
        future = client.call_async(request)
        self.spin_until(future.done, f'an answer of {service}')
        return future.result()

    def call(self, service: str) -> tuple[bool, str]:
        """Call a service of type Trigger, and return what it answers."""
        response = self.request(service, Trigger.Request())
        return response.success, response.message

    def finish(self, **results: object) -> None:
        """Print the observations as the last line, and end."""
        foreign = [name for name in sys.modules if name.partition('.')[0] == 'physsim_ros']
        assert foreign == [], 'this program was to know the topics alone'
        print('RESULT ' + json.dumps(results), flush=True)  # noqa: T201 - that is the answer
        # Before its node: it listens to what that destroys.
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.shutdown()


def stamp_of(message: Any) -> int:
    """Return the time of a message's header [ns]."""
    stamp = message.header.stamp
    return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec)


def disc(
    namespace: str, number: int, x: float, y: float, diameter: float, text: str = ''
) -> Marker:
    """Return a marker that becomes a disc."""
    marker = Marker(ns=namespace, id=number, type=Marker.SPHERE, text=text)
    marker.pose.position.x, marker.pose.position.y = x, y
    marker.scale.x = marker.scale.y = diameter
    return marker
