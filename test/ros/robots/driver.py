# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A robot's node as people write it: it hears a laser, and publishes commands."""

from __future__ import annotations

import math
from typing import Any

from geometry_msgs.msg import Twist, TwistStamped
from physsim_ros.ros.node_without_qos_events import NodeWithoutQosEvents
from physsim_ros.testing import PhysSim
from rclpy.context import Context
from sensor_msgs.msg import LaserScan


class Driver(NodeWithoutQosEvents):
    """Drives ahead, and stops where the laser sees something in front; or as it is told."""

    def __init__(
        self,
        context: Context,
        *,
        namespace: str = 'robot_0',
        kind: type = Twist,
        speed: float = 0.2,
        margin: float = 0.5,
        looks: bool = True,
    ) -> None:
        super().__init__(f'driver_{kind.__name__}'.lower(), context=context)
        self.scans: list[LaserScan] = []
        self._speed, self._margin = speed, margin
        self.publisher = self.create_publisher(kind, f'/{namespace}/cmd_vel', 10)
        if looks:
            self.create_subscription(LaserScan, f'/{namespace}/scan', self.hear, 10)

    def hear(self, scan: LaserScan) -> None:
        self.scans.append(scan)
        ahead = min(scan.ranges[0], scan.ranges[1], scan.ranges[-1])
        self.send(self._speed if ahead > self._margin else 0.0, stamp=scan.header.stamp)

    def send(self, speed: float, turn: float = 0.0, stamp: Any = None) -> None:
        message = self.publisher.msg_type()
        twist = message.twist if isinstance(message, TwistStamped) else message
        twist.linear.x, twist.angular.z = speed, turn
        if isinstance(message, TwistStamped) and stamp is not None:
            message.header.stamp = stamp
        self.publisher.publish(message)


def driver_of(physsim: PhysSim, *, looks: bool = False, kind: type = Twist) -> Driver:
    """Return a driver in a world, which is told what to do where it does not look."""
    driver = Driver(physsim.context, kind=kind, looks=looks)
    physsim.add(driver)
    return driver


def yaw_of(orientation: Any) -> float:
    return 2.0 * math.atan2(orientation.z, orientation.w)
