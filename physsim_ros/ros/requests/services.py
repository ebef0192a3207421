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

from collections.abc import Callable, Mapping
from functools import partial

from physsim_ros.model.errors import Busy, Refusal
from physsim_ros.model.snapshot import Answer
from physsim_ros.ros.requests.message_queue import MessageQueue
from physsim_ros.ros.requests.reply_pacer import ReplyPacer, SERVICE_QOS
from physsim_ros.simulation.request_queue import RequestQueue
from rclpy.node import Node
from rclpy.service import Service
from std_srvs.srv import Trigger

# Carries out a service, and returns a message about it; raises a Refusal where it cannot.
Action = Callable[[], str]
# Services that need the world itself: they wait for the end of a seek, as requests do.
IN_TURN = frozenset({'clear', 'load_world', 'save_world'})
# What takes the place of a seek, unless requests wait for the end of that.
REPLACING = frozenset({'undo', 'redo', 'reset', 'seek', 'timeline'})


class Turns:
    """
    The turns of services: at once, or among the requests that wait for the end of a seek.

    :param requests: the queue of requests and answers
    :param is_there: applies what waits, and tells whether no seek is under way
    """

    def __init__(self, requests: RequestQueue, is_there: Callable[[], bool]) -> None:
        self._requests = requests
        self._is_there = is_there

    def call(self, service: str, call: Callable[[], Answer]) -> None:
        """
        Call something, and tell its answer.

        :param service: whose turn it takes
        :raises Busy: too many requests wait
        """
        waits = service in IN_TURN or (service in REPLACING and self._requests.has_requests)
        if waits and not self._is_there():
            self._requests.submit_call(call, topic=f'~/{service}')
        else:
            self._requests.tell(call())

    def tell(self, answer: Answer) -> None:
        """Tell an answer at once."""
        self._requests.tell(answer)


def create_services(
    node: Node,
    actions: Mapping[str, Action],
    turns: Turns,
    pacer: ReplyPacer,
    *,
    queue: MessageQueue,
    on_success: Callable[[], None],
) -> None:
    """
    Create a service for each action, which replies and tells the same sentence as an event.

    :param node: that offers them
    :param actions: by the names of the services
    :param turns: of the services
    :param pacer: of their replies
    :param queue: of messages, behind which a service comes that was called after them
    :param on_success: called after each service that was not refused
    """

    def perform(name: str, response: Trigger.Response) -> Answer:
        try:
            response.message = actions[name]()
            response.success = True
            on_success()
            return Answer(topic=f'~/{name}', message=response.message)
        except Refusal as refusal:
            return refuse(name, response, refusal)
        finally:
            pacer.flush()

    def refuse(name: str, response: Trigger.Response, refusal: Refusal) -> Answer:
        response.message = f'{refusal.code}: {refusal}'
        response.success = False
        return Answer.refused(refusal, topic=f'~/{name}')

    def answer(name: str, response: Trigger.Response) -> None:
        try:
            turns.call(name, partial(perform, name, response))
        except Busy as refusal:
            turns.tell(refuse(name, response, refusal))
            pacer.flush()

    def create_service(name: str) -> Service:
        def callback(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            queue.add_call(partial(answer, name, response))
            return response

        return node.create_service(Trigger, f'~/{name}', callback, qos_profile=SERVICE_QOS)

    for name in actions:
        # Each says what it did, or why not.
        pacer.add(create_service(name), is_complete=lambda reply: bool(reply.message))
