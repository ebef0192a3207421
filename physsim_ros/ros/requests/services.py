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
The services of the world, all std_srvs/Trigger.

Laws: a service that is refused changes nothing, and its message says why; what it did, or why not,
is told on `~/events`, too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import partial
from typing import Any

from physsim_ros.model.errors import Busy, Refusal
from physsim_ros.model.snapshot import Answer
from physsim_ros.ros.requests.message_queue import MessageQueue
from physsim_ros.ros.requests.reply_pacer import ReplyPacer, SERVICE_QOS
from physsim_ros.simulation.request_queue import RequestQueue
from rclpy.node import Node
from rclpy.service import Service
from rclpy.task import Future
from std_srvs.srv import Trigger

# Carries out a service, and returns a message about it; raises a Refusal where it cannot.
Action = Callable[[], str]
# Fills in a response, with a refusal where too many wait, and returns the answers.
Fill = Callable[[Busy | None], Iterable[Answer]]
# Services that read or replace the world: their calls wait for the end of a seek, as requests do.
# `configure` sets parameters that are settings of the world.
NEEDING_WORLD = frozenset({'clear', 'load_world', 'save_world', 'configure'})
# Services that end a seek, or do not concern it: their calls come at once, unless requests wait
# for its end; then they come after these.
BEHIND_REQUESTS = frozenset({'undo', 'redo', 'reset', 'seek', 'timeline', 'set_parameters'})


class Turns:
    """
    The turns of services: at once, or among the requests that wait for the end of a seek.

    :param requests: the queue of requests and answers
    :param is_there: applies what waits, and tells whether no seek is under way
    """

    def __init__(self, requests: RequestQueue, is_there: Callable[[], bool]) -> None:
        self._requests = requests
        self._is_there = is_there

    def call(self, service: str, call: Callable[[], Iterable[Answer]]) -> None:
        """
        Call something, and tell its answers.

        :param service: whose turn it takes
        :raises Busy: too many requests wait
        """
        waits = service in NEEDING_WORLD or (
            service in BEHIND_REQUESTS and self._requests.has_requests
        )
        if waits and not self._is_there():
            self._requests.submit_call(call, topic=f'~/{service}')
        else:
            self.tell(call())

    def tell(self, answers: Iterable[Answer]) -> None:
        """Tell answers at once."""
        for answer in answers:
            self._requests.tell(answer)


class ServiceCalls:
    """
    Calls of services: in the order of messages, in their turns, with replies at a pace.

    :param queue: of messages, behind which a service comes that was called after them
    :param turns: of the services
    :param pacer: of their replies
    """

    def __init__(self, queue: MessageQueue, turns: Turns, pacer: ReplyPacer) -> None:
        self._queue = queue
        self._turns = turns
        self._pacer = pacer
        self.delay_replies = pacer.add

    def add(self, service: str, response: Any, fill: Fill) -> Future:
        """
        Have a response filled in when it is its turn, and return its future.

        :param service: whose turn it takes
        """
        reply = Future()

        def finish(refusal: Busy | None = None) -> Iterable[Answer]:
            answers = fill(refusal)
            self._pacer.finish(reply, response)
            return answers

        def unless_busy(call: Callable[[], None]) -> None:
            try:
                call()
            except Busy as refusal:
                self._turns.tell(finish(refusal))

        take_turn = partial(unless_busy, partial(self._turns.call, service, finish))
        unless_busy(partial(self._queue.add_call, take_turn))
        return reply


def create_services(
    node: Node,
    actions: Mapping[str, Action],
    calls: ServiceCalls,
    *,
    on_success: Callable[[], None],
) -> None:
    """
    Create a service for each action, which replies and tells the same sentence as an event.

    :param node: that offers them
    :param actions: by the names of the services
    :param calls: of the services
    :param on_success: called after each service that was not refused
    """

    def fill(name: str, response: Trigger.Response, busy: Busy | None) -> list[Answer]:
        topic = f'~/{name}'
        try:
            if busy is not None:
                raise busy
            response.message = actions[name]()
        except Refusal as refusal:
            response.message = f'{refusal.code}: {refusal}'
            return [Answer.refused(refusal, topic=topic)]
        response.success = True
        on_success()
        return [Answer(topic=topic, message=response.message)]

    def create_service(name: str) -> Service:
        def callback(_: Trigger.Request, response: Trigger.Response) -> Future:
            return calls.add(name, response, partial(fill, name, response))

        return node.create_service(Trigger, f'~/{name}', callback, qos_profile=SERVICE_QOS)

    for name in actions:
        calls.delay_replies(create_service(name))
