# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The services of the world, all std_srvs/Trigger.

Laws: a service that is refused changes nothing, and its message says why; `~/events` has the same
message.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any, NamedTuple

from physsim_ros.model.error_boundary import ErrorBoundary
from physsim_ros.model.errors import Busy, Failed, Refusal
from physsim_ros.model.snapshot import Answer
from physsim_ros.ros.requests.message_queue import MessageQueue
from physsim_ros.ros.requests.reply_pacer import ReplyPacer, SERVICE_QOS
from physsim_ros.simulation.request_queue import RequestQueue, Wait
from rclpy.node import Node
import rclpy.service
from rclpy.task import Future
from std_srvs.srv import Trigger

# Carries out a service, and returns a message about it; raises a Refusal where it cannot.
Action = Callable[[], str]
# Fills in a response, with a refusal where the call is not carried out, and returns the answers.
Fill = Callable[[Refusal | None], Iterable[Answer]]


class Service(NamedTuple):
    """
    A service.

    :ivar perform: performs it, and returns a message about it
    :ivar wait: what its calls wait for
    """

    perform: Action
    wait: Wait = Wait.NONE


class ServiceCalls:
    """
    Calls of services, in order with messages and requests, with paced replies.

    :param queue: of messages; a call waits behind the messages that came before it
    :param requests: the queue of requests, which has the answers
    :param submit: makes a call at its time among the requests
    :param pacer: of their replies
    :param boundary: of the node
    """

    def __init__(
        self,
        queue: MessageQueue,
        requests: RequestQueue,
        submit: Callable[[Callable[[], Iterable[Answer]], Wait], None],
        pacer: ReplyPacer,
        boundary: ErrorBoundary,
    ) -> None:
        self._queue = queue
        self._requests = requests
        self._submit = submit
        self._pacer = pacer
        self._boundary = boundary
        self.delay_replies = pacer.add

    def fill(self, topic: str, fill: Fill, refusal: Refusal | None = None) -> Iterable[Answer]:
        """Fill in a response now, and return the answers."""
        try:
            with self._boundary.message(topic):
                return fill(refusal)
        except Failed as failed:
            return fill(failed)

    def add(self, topic: str, response: Any, fill: Fill, wait: Wait) -> Future:
        """
        Fill in a response when the turn of its call comes, and return its future.

        :param topic: name of the service
        :param wait: what the call waits for
        """
        reply = Future()

        def finish(refusal: Refusal | None = None) -> Iterable[Answer]:
            answers = self.fill(topic, fill, refusal)
            self._pacer.finish(reply, response)
            return answers

        def unless_refused(call: Callable[[], None]) -> None:
            try:
                with self._boundary.reading(topic):
                    call()
            except (Busy, Failed) as refusal:
                for answer in finish(refusal):
                    self._requests.tell(answer)

        submit = partial(unless_refused, partial(self._submit, finish, wait))
        unless_refused(partial(self._queue.add_call, submit))
        return reply


def create_services(
    node: Node,
    services: Mapping[str, Service],
    calls: ServiceCalls,
    *,
    on_success: Callable[[], None],
) -> None:
    """
    Create services, whose response and event have the same message.

    :param node: that offers them
    :param services: by their names
    :param calls: of the services
    :param on_success: called after each service that was not refused
    """

    def fill(name: str, response: Trigger.Response, refused: Refusal | None) -> list[Answer]:
        topic = f'~/{name}'
        try:
            if refused is not None:
                raise refused
            response.message = services[name].perform()
            on_success()
        except Refusal as refusal:
            response.message = f'{refusal.code}: {refusal}'
            return [Answer.refused(refusal, topic=topic)]
        response.success = True
        return [Answer(topic=topic, message=response.message)]

    def create_service(name: str) -> rclpy.service.Service:
        def callback(_: Trigger.Request, response: Trigger.Response) -> Future:
            call = partial(fill, name, response)
            return calls.add(f'~/{name}', response, call, services[name].wait)

        return node.create_service(Trigger, f'~/{name}', callback, qos_profile=SERVICE_QOS)

    for name in services:
        calls.delay_replies(create_service(name))
