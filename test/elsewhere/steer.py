# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Steer a robot by its laser for some seconds, slower or faster, and tell where it went."""

from __future__ import annotations

import random
import sys
import time

from geometry_msgs.msg import TwistStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Float64
from visitor import ALL, stamp_of, Visitor

DURATION = 3_000_000_000


def main() -> None:
    longest = float(sys.argv[1])
    visitor = Visitor()
    chance = random.Random(longest)
    truth = visitor.listen(Odometry, '/robot_0/ground_truth')
    commands = visitor.publisher(TwistStamped, '/robot_0/cmd_vel')
    scans = []

    def steer(scan: LaserScan) -> None:
        scans.append(stamp_of(scan))
        # Think for a while, by the wall.
        until = time.monotonic() + chance.uniform(0.0, longest)
        visitor.spin_until(lambda: time.monotonic() > until, 'a thought')
        command = TwistStamped()
        command.header.stamp = scan.header.stamp
        left, right = min(scan.ranges[45:135]), min(scan.ranges[225:315])
        command.twist.linear.x = 0.2
        command.twist.angular.z = min(2.0, max(-2.0, left - right))
        commands.publish(command)

    waiting: list[LaserScan] = []
    visitor.node.create_subscription(LaserScan, '/robot_0/scan', waiting.append, ALL)
    speed = visitor.publisher(Float64, '/physsim/speed')
    visitor.spin_until(lambda: visitor.node.count_publishers('/robot_0/scan'), 'a laser')
    speed.publish(Float64(data=1.0))
    while not truth or stamp_of(truth[-1]) < DURATION:
        visitor.spin_until(
            lambda: waiting or (truth and stamp_of(truth[-1]) >= DURATION), 'a scan'
        )
        if waiting:
            steer(waiting.pop(0))
    poses = [
        (stamp_of(each), each.pose.pose.position.x, each.pose.pose.position.y)
        for each in truth
        if stamp_of(each) <= DURATION
    ]
    visitor.finish(scans=[each for each in scans if each <= DURATION], poses=poses)


if __name__ == '__main__':
    main()
