# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Command the speed of a robot fifty times a second, until it is told to leave."""

from __future__ import annotations

import sys
import time

from geometry_msgs.msg import Twist, TwistStamped
import rclpy
from rclpy.node import Node

PERIOD = 0.02


def main(kind: str, speed: float) -> None:
    rclpy.init()
    node = Node('commander')
    message = {'Twist': Twist, 'TwistStamped': TwistStamped}[kind]()
    twist = message.twist if isinstance(message, TwistStamped) else message
    twist.linear.x = speed
    publisher = node.create_publisher(type(message), '/robot_0/cmd_vel', 10)
    while rclpy.ok():
        publisher.publish(message)
        time.sleep(PERIOD)
    node.destroy_node()


if __name__ == '__main__':
    main(sys.argv[1], float(sys.argv[2]))
