# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Service replies, paced so that all clients can read them.

DDS sends each reply to all clients of a service, and a client keeps the last ten that it has not
read yet (`qos_profile_services_default` of rclpy), its own or not: of 20 clients with three calls
each, 10 to 40 of 60 calls got their reply. A pause after each reply, longer with more clients,
delays no client that waits for one reply before its next call.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from functools import partial
import time
from typing import Any

from physsim_ros.model.error_boundary import ErrorBoundary
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.service import Service
from rclpy.task import Future

# Depth of the requests that wait to be read: 50 clients with 20 calls each.
SERVICE_QOS = QoSProfile(depth=1000)
# Replies that are sent without a pause: half of what a client keeps.
BURST = 5
# Time for a client to read a reply [s]: a SingleThreadedExecutor takes 0.5 ms.
READING = 1e-3


class ReplyPacer:
    """
    Delays the replies of services; their actions are not delayed.

    :param node: that offers the services
    :param boundary: of the node
    """

    def __init__(self, node: Node, boundary: ErrorBoundary) -> None:
        self.paced = False
        self._boundary = boundary
        self._node = node
        # Replies that are finished: the name of the service, and the call that sends it.
        self._finished: deque[tuple[str, Callable[[], None]]] = deque()
        # Steady time at which all clients have read all replies [s].
        self._read = 0.0

    @property
    def has_waiting(self) -> bool:
        """Whether a reply waits for its pause."""
        return bool(self._finished)

    def add(self, service: Service) -> None:
        """Delay the replies of a service, whose callback returns futures of its responses."""
        send = service.send_response

        def send_when_finished(reply: Any, header: Any) -> None:
            def add_finished(_: Future) -> None:
                self._finished.append((service.srv_name, partial(send, reply.result(), header)))

            reply.add_done_callback(add_finished)
            self.flush()

        # The executor looks this name up for each reply.
        service.send_response = send_when_finished  # type: ignore[method-assign, assignment]

    def finish(self, reply: Future, response: Any) -> None:
        """Set the response of a reply, which is sent as soon as the pace allows it."""
        reply.set_result(response)
        self.flush()

    def flush(self) -> None:
        """Send the replies that are due; called at each tick."""
        while self._finished:
            service, send = self._finished[0]
            pause = READING * self._node.count_clients(service)
            now = time.monotonic()
            if self.paced and self._read > now + BURST * pause:
                return
            self._read = max(self._read, now) + pause
            self._finished.popleft()
            with self._boundary.output(service):
                send()
