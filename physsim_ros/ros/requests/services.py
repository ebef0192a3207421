# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The services of the world, all std_srvs/Trigger.

Laws: a service that is refused changes nothing, and its message says why; `~/events` has the same
message.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

from physsim_ros.model.answer import Answer
from physsim_ros.model.errors import Busy, Failed, Refusal
from physsim_ros.ros.topics import CALLS
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.runtime.slices import finish, in_slices, Sliced, Slices
from physsim_ros.simulation.entries import Wait
from physsim_ros.simulation.request_queue import RequestQueue
from rclpy.node import Node
import rclpy.service
from rclpy.task import Future
from std_srvs.srv import Trigger

# Fills in a response, with a refusal where the call is not carried out, and returns the answers.
Fill = Callable[[Refusal | None], Sequence[Answer] | Slices[Sequence[Answer]]]
# Makes a call at its time among the requests, and calls the last function when it is told.
MakeCall = Callable[[Sliced[Sequence[Answer]], Wait, Callable[[], object]], None]


class Service(NamedTuple):
    """
    A service.

    :ivar perform: performs it, and returns a message about it; raises a Refusal where it cannot
    :ivar wait: what its calls wait for
    """

    perform: Sliced[str]
    wait: Wait = Wait.NONE


class ServiceCalls:
    """
    Calls of services, each in its turn among the requests.

    :param requests: the queue of requests, which has the answers
    :param make_call: makes a call at its time among the requests
    :param boundary: of the node
    """

    def __init__(
        self,
        requests: RequestQueue,
        make_call: MakeCall,
        boundary: ErrorBoundary,
    ) -> None:
        self._requests = requests
        self._make_call = make_call
        self._boundary = boundary

    async def _fill(
        self, topic: str, fill: Fill, refusal: Refusal | None = None
    ) -> Sequence[Answer]:
        """Fill in a response, and return the answers."""
        try:
            slices = in_slices(partial(fill, refusal))
            return await self._boundary.slices_of_message(topic, slices)
        except Failed as failed:
            return await in_slices(partial(fill, failed))

    def add(self, topic: str, response: Any, fill: Fill, wait: Wait) -> Future:
        """
        Fill in a response when the turn of its call comes, and return its future.

        :param topic: name of the service
        :param wait: what the call waits for
        """
        reply = Future()

        def send() -> None:
            reply.set_result(response)

        try:
            with self._boundary.reading(topic):
                self._make_call(partial(self._fill, topic, fill), wait, send)
        except (Busy, Failed) as refusal:
            for answer in finish(self._fill(topic, fill, refusal)):
                self._requests.tell(answer)
            send()
        return reply

    def reply_when_done(self, service: rclpy.service.Service) -> None:
        """Have a service whose callback returns a future reply when that is done."""
        send = service.send_response

        def send_when_done(reply: Any, header: Any) -> None:
            if not isinstance(reply, Future):  # An empty response, after an error.
                send(reply, header)
                return

            def send_now(_: Future) -> None:
                with self._boundary.output(service.srv_name):
                    send(reply.result(), header)

            reply.add_done_callback(send_now)

        # The executor of rclpy 7.1 takes no coroutine for a callback, and looks this name up for
        # each reply.
        service.send_response = send_when_done  # type: ignore[method-assign, assignment]

    def create(
        self, node: Node, kind: Any, topic: str, respond: Callable[[Any, Any], Future]
    ) -> None:
        """
        Create a service.

        :param respond: returns the future of a response, of a request and the empty response
        """
        self.reply_when_done(node.create_service(kind, topic, respond, qos_profile=CALLS))


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

    async def fill(
        name: str, response: Trigger.Response, refused: Refusal | None
    ) -> Sequence[Answer]:
        topic = f'~/{name}'
        try:
            if refused is not None:
                raise refused
            response.message = await in_slices(services[name].perform)
            on_success()
        except Refusal as refusal:
            response.message = f'{refusal.code}: {refusal}'
            return [Answer.refused(refusal, topic=topic)]
        response.success = True
        return [Answer(topic=topic, message=response.message)]

    def respond(name: str, _: Trigger.Request, response: Trigger.Response) -> Future:
        call = partial(fill, name, response)
        return calls.add(f'~/{name}', response, call, services[name].wait)

    for name in services:
        calls.create(node, Trigger, f'~/{name}', partial(respond, name))
