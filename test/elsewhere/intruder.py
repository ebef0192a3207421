# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A stranger on the domain of a world: spawns bodies until its own second node has read them."""

from __future__ import annotations

import json
import sys
import time

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from visualization_msgs.msg import Marker

# In 3 s every node on this machine has found the others.
COUNT, PERIOD = 300, 0.01
PATIENCE = 90.0


def main() -> None:
    contexts = [rclpy.Context(), rclpy.Context()]
    executors = []
    for context in contexts:
        rclpy.init(context=context)
        executors.append(SingleThreadedExecutor(context=context))
    first, second = Node('first', context=contexts[0]), Node('second', context=contexts[1])
    executors[0].add_node(first)
    executors[1].add_node(second)
    publisher = first.create_publisher(Marker, '/physsim/spawn', 10)
    received: list[Marker] = []
    second.create_subscription(Marker, '/physsim/spawn', received.append, 10)
    marker = Marker(ns='intruder', type=Marker.SPHERE)
    marker.scale.x = marker.scale.y = 1.0
    deadline = time.monotonic() + PATIENCE
    while len(received) < COUNT:
        if time.monotonic() > deadline:
            sys.exit('it does not find itself')
        publisher.publish(marker)
        executors[1].spin_once(timeout_sec=PERIOD)
    heard, nodes = publisher.get_subscription_count(), sorted(first.get_node_names())
    print(json.dumps({'heard': heard, 'nodes': nodes}))  # noqa: T201 - that is the answer


if __name__ == '__main__':
    main()
