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

from physsim_ros.model.errors import Refusal
from physsim_ros.model.snapshot import Answer
from physsim_ros.ros.requests.message_queue import MessageQueue
from physsim_ros.ros.requests.reply_pacer import ReplyPacer, SERVICE_QOS
from physsim_ros.simulation.request_queue import RequestQueue
from rclpy.node import Node
from rclpy.service import Service
from std_srvs.srv import Trigger

# Carries out a service, and returns a message about it; raises a Refusal where it cannot.
Action = Callable[[], str]


def create_services(
    node: Node,
    actions: Mapping[str, Action],
    requests: RequestQueue,
    pacer: ReplyPacer,
    *,
    queue: MessageQueue,
    on_success: Callable[[], None],
) -> None:
    """
    Create a service for each action, which replies and tells the same sentence as an event.

    :param node: that offers them
    :param actions: by the names of the services
    :param requests: the queue that their answers are added to
    :param pacer: of their replies
    :param queue: of messages, behind which a service comes that was called after them
    :param on_success: called after each service that was not refused
    """

    def answer(action: Action, topic: str, response: Trigger.Response) -> None:
        try:
            response.message = action()
            response.success = True
            on_success()
            requests.tell(Answer(topic=topic, message=response.message))
        except Refusal as refusal:
            response.message = f'{refusal.code}: {refusal}'
            response.success = False
            requests.refuse(refusal, topic=topic, subject='')
        pacer.flush()

    def create_service(action: Action, topic: str) -> Service:
        def callback(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            queue.add_call(partial(answer, action, topic, response))
            return response

        return node.create_service(Trigger, topic, callback, qos_profile=SERVICE_QOS)

    for name, action in actions.items():
        # Each says what it did, or why not.
        pacer.add(
            create_service(action, f'~/{name}'), is_complete=lambda reply: bool(reply.message)
        )
