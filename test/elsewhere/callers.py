# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Twenty clients call a service three times each, all at once; count the replies."""

from __future__ import annotations

import time

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_srvs.srv import Trigger
from visitor import PATIENCE, Visitor

NODES, CALLS = 20, 3


def main() -> None:
    visitor = Visitor('/physsim/pause')
    # A world replies to clients that it has discovered: the first call is repeated until then.
    visitor.call('/physsim/pause')
    executor = SingleThreadedExecutor()
    clients = []
    for number in range(NODES):
        node = Node(f'caller{number}')
        executor.add_node(node)
        clients.append(node.create_client(Trigger, '/physsim/pause'))
    deadline = time.monotonic() + PATIENCE
    waiting = list(clients)
    while waiting and time.monotonic() < deadline:
        futures = [client.call_async(Trigger.Request()) for client in waiting]
        until = time.monotonic() + 1.0
        while time.monotonic() < until and not all(future.done() for future in futures):
            executor.spin_once(timeout_sec=0.05)
        pairs = zip(waiting, futures, strict=True)
        waiting = [client for client, future in pairs if not future.done()]
    futures = [client.call_async(Trigger.Request()) for client in clients for _ in range(CALLS)]
    until = time.monotonic() + PATIENCE / 3
    while time.monotonic() < until and not all(future.done() for future in futures):
        executor.spin_once(timeout_sec=0.05)
    executor.shutdown()
    visitor.finish(calls=len(futures), replies=sum(future.done() for future in futures))
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
