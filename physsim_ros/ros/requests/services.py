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
from physsim_ros.model.translation import Text
from physsim_ros.ros.topics import CALLS
from physsim_ros.runtime.error_boundary import ErrorBoundary
from physsim_ros.runtime.slices import in_slices, Sliced
from physsim_ros.simulation.entries import Wait
from physsim_ros.simulation.request_queue import RequestQueue
from rclpy.node import Node
import rclpy.service
from rclpy.task import Future
from std_srvs.srv import Trigger

# Makes a call at its time among the requests, and calls the last function when it is told.
MakeCall = Callable[[Sliced[Sequence[Answer]], Wait, Callable[[], object]], None]


class Service(NamedTuple):
    """
    A service.

    :ivar perform: performs it, and returns a message about it; raises a Refusal where it cannot
    :ivar wait: what its calls wait for
    """

    perform: Sliced[Text]
    wait: Wait = Wait.NONE


class Call(NamedTuple):
    """
    A call of a service.

    :ivar topic: name of the service
    :ivar response: that is sent in the end
    :ivar perform: carries it out, fills in the response and returns the answers; raises a Refusal
        where it cannot
    :ivar refuse: fills in the response with a refusal, and returns the answers
    :ivar wait: what it waits for
    """

    topic: str
    response: Any
    perform: Sliced[Sequence[Answer]]
    refuse: Callable[[Refusal], Sequence[Answer]]
    wait: Wait


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

    async def _carry_out(self, call: Call) -> Sequence[Answer]:
        """Fill in the response of a call, and return the answers."""
        try:
            return await self._boundary.slices_of_message(call.topic, in_slices(call.perform))
        except Refusal as refusal:
            return call.refuse(refusal)

    def add(self, call: Call) -> Future:
        """Carry out a call when its turn comes; return the future of its response."""
        reply = Future()

        def send() -> None:
            reply.set_result(call.response)

        try:
            with self._boundary.refusing(call.topic):
                self._make_call(partial(self._carry_out, call), call.wait, send)
        except (Busy, Failed) as refusal:
            for answer in call.refuse(refusal):
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
                with self._boundary.containing(service.srv_name):
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

    def respond(name: str, _: Trigger.Request, response: Trigger.Response) -> Future:
        topic, service = f'~/{name}', services[name]

        async def perform() -> Sequence[Answer]:
            response.message = await in_slices(service.perform)
            on_success()
            response.success = True
            return [Answer(topic=topic, message=response.message)]

        def refuse(refusal: Refusal) -> Sequence[Answer]:
            response.message = f'{refusal.code}: {refusal}'
            return [Answer.refused(refusal, topic=topic)]

        return calls.add(Call(topic, response, perform, refuse, service.wait))

    for name in services:
        calls.create(node, Trigger, f'~/{name}', partial(respond, name))
