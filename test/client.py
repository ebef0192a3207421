# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A node beside a test's world: it sends what it is told, and hears every answer."""

from __future__ import annotations

from collections.abc import Callable
import time
from typing import Any, NamedTuple

from diagnostic_msgs.msg import DiagnosticStatus
from physsim_ros.ros.node_without_qos_events import NodeWithoutQosEvents
from physsim_ros.testing import PhysSim
from rcl_interfaces.msg import Parameter as ParameterMessage
from rcl_interfaces.msg import SetParametersResult
from rcl_interfaces.srv import SetParameters, SetParametersAtomically
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Trigger

from .outside import PATIENCE

# Of topics that keep their last message for whoever comes late.
KEPT = QoSProfile(
    depth=1,
    reliability=ReliabilityPolicy.RELIABLE,
    durability=DurabilityPolicy.TRANSIENT_LOCAL,
)


def stamp_of(message: Any) -> int:
    """Return the time of a message [ns]."""
    stamp = message.clock if isinstance(message, Clock) else message.header.stamp
    return int(stamp.sec * 10**9 + stamp.nanosec)


class Event(NamedTuple):
    """An answer on `~/events`."""

    level: int
    name: str
    hardware_id: str
    message: str
    code: str
    field: str
    values: dict[str, str] = {}  # noqa: RUF012 - nothing writes to it


class Client:
    """A node that asks the world of a test, and hears everything that the world answers."""

    def __init__(self, physsim: PhysSim) -> None:
        self.physsim = physsim
        self.node = NodeWithoutQosEvents('client', context=physsim.context)
        self.qos = QoSProfile(
            history=HistoryPolicy.KEEP_ALL, reliability=ReliabilityPolicy.RELIABLE
        )
        self.events: list[Event] = []
        self.node.create_subscription(DiagnosticStatus, '/physsim/events', self._hear, self.qos)
        self._publishers: dict[str, Any] = {}
        physsim.add(self.node)
        self.spin_until(lambda: self.node.count_publishers('/physsim/events'))

    def _hear(self, status: DiagnosticStatus) -> None:
        values = {pair.key: pair.value for pair in status.values}
        code, field = values.pop('code'), values.pop('field', '')
        level = status.level[0]
        self.events.append(
            Event(level, status.name, status.hardware_id, status.message, code, field, values)
        )

    def spin_until(self, predicate: Callable[[], object]) -> None:
        deadline = time.monotonic() + PATIENCE
        while not predicate():
            assert time.monotonic() < deadline, 'it did not come about in time'
            self.physsim.settle()

    def publish(self, topic: str, message: Any) -> None:
        """Publish on one of the world's topics, named as in `~/spawn`."""
        if topic not in self._publishers:
            name = topic.replace('~', '/physsim')
            self._publishers[topic] = self.node.create_publisher(type(message), name, self.qos)
            self.spin_until(self._publishers[topic].get_subscription_count)
        self._publishers[topic].publish(message)

    def ask(self, topic: str, message: Any) -> list[Event]:
        """Publish a request, let the world carry it out, and return all that it answers."""
        before = len(self.events)
        self.publish(topic, message)
        # Requests that have arrived are carried out twice, so that a second answer would be heard.
        self.physsim.settle()
        for _ in range(2):
            self.catch_up()
        return self.events[before:]

    def listen(self, kind: type, topic: str, qos: Any = None) -> list[Any]:
        """Return the list that the messages of a topic come into from now on."""
        received: list[Any] = []
        subscription = self.node.create_subscription(
            kind, topic.replace('~', '/physsim'), received.append, qos or self.qos
        )
        self.spin_until(subscription.get_publisher_count)
        return received

    @property
    def refusals(self) -> list[Event]:
        """Return the events that tell of no success."""
        return [event for event in self.events if event.code != 'ok']

    def catch_up(self) -> None:
        """Have the world carry out what it was asked, and hear what it tells of that."""
        self.physsim.node.loop.apply_requests()
        self.physsim.settle()

    def call(self, service: str) -> Any:
        """Call one of the world's services of type Trigger, and return its response."""
        return self.request(Trigger, service, Trigger.Request())

    def set_parameters(self, *parameters: ParameterMessage) -> list[SetParametersResult]:
        """Set parameters of the world by its service, and return the results."""
        request = SetParameters.Request(parameters=parameters)
        return list(self.request(SetParameters, '~/set_parameters', request).results)

    def set_together(self, *parameters: ParameterMessage) -> SetParametersResult:
        """Set parameters of the world together or not at all, and return the result."""
        request = SetParametersAtomically.Request(parameters=parameters)
        service = '~/set_parameters_atomically'
        return self.request(SetParametersAtomically, service, request).result

    def service(self, kind: Any, name: str) -> Any:
        """Return the client of a service of the world's node, which is ready."""
        client = self.node.create_client(kind, name.replace('~', '/physsim'))
        self.spin_until(client.service_is_ready)
        return client

    def request(self, kind: Any, service: str, request: Any) -> Any:
        """Call a service of the world's node, and return its response."""
        client = self.service(kind, service)
        future = client.call_async(request)
        self.spin_until(future.done)
        self.node.destroy_client(client)
        return future.result()


def message_of(name: str, content: object) -> ParameterMessage:
    """Return a parameter as a message has it."""
    return Parameter(name, value=content).to_parameter_msg()


def set_parameter(physsim: PhysSim, name: str, value: object) -> None:
    """Set a parameter of the node of a world."""
    kind = Parameter.Type.DOUBLE_ARRAY if value == [] else None
    (result,) = physsim.node.set_parameters([Parameter(name, kind, value)])
    assert result.successful, result.reason


def parameter(physsim: PhysSim, name: str) -> Any:
    """Return the value of a parameter of the node of a world."""
    value = physsim.node.get_parameter(name).value
    return value if isinstance(value, int | float | str) else list(value)


def succeeded(response: Trigger.Response) -> str:
    """Return the message of a service that has succeeded."""
    assert response.success, response.message
    assert response.message
    return str(response.message)


def failed(response: Trigger.Response) -> str:
    """Return the message of a service that was refused."""
    assert not response.success, response.message
    assert response.message
    return str(response.message)
