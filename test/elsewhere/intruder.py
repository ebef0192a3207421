# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Two strangers on the domain of a world: one spawns bodies until the other has read enough."""

from __future__ import annotations

import json
import subprocess
import sys
import time

import rclpy
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from visualization_msgs.msg import Marker

# In 3 s every node on this machine has found the others.
COUNT, PERIOD = 300, 0.01
PATIENCE = 90.0


def spawn(node: Node) -> None:
    publisher = node.create_publisher(Marker, '/physsim/spawn', 10)
    marker = Marker(ns='intruder', type=Marker.SPHERE)
    marker.scale.x = marker.scale.y = 1.0
    while rclpy.ok():
        publisher.publish(marker)
        time.sleep(PERIOD)


def read(node: Node) -> None:
    received: list[Marker] = []
    node.create_subscription(Marker, '/physsim/spawn', received.append, 10)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    deadline = time.monotonic() + PATIENCE
    while len(received) < COUNT:
        if time.monotonic() > deadline:
            sys.exit('they do not find each other')
        executor.spin_once(timeout_sec=PERIOD)
    heard, nodes = node.count_subscribers('/physsim/spawn'), sorted(node.get_node_names())
    print(json.dumps({'heard': heard, 'nodes': nodes}))  # noqa: T201 - that is the answer


def main(role: str) -> None:
    rclpy.init()
    node = Node(role)
    if role == 'first':
        spawn(node)
        return
    with subprocess.Popen([sys.executable, __file__, 'first']) as first:
        try:
            read(node)
        finally:
            first.kill()


if __name__ == '__main__':
    main(*sys.argv[1:])
