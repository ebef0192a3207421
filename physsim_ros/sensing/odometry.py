# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Where a robot is, and how it moves: by its wheels and its gyroscope, and in truth."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import Pose, rotated, Twist


class OdometryReading(NamedTuple):
    """
    A pose, and the velocity there.

    :ivar pose: x, y [m], yaw [rad]
    :ivar twist: vx forward, vy to the left [m/s], turn counter-clockwise [rad/s]; of the robot's
        origin, in its own axes
    """

    pose: Pose
    twist: Twist


def read_odometry(snapshot: Snapshot, row: int) -> OdometryReading:
    """
    Return what wheels and gyroscope tell, from the pose in which the robot was spawned.

    :param snapshot: of the world
    :param row: of the robot's body in the scene
    """
    place = int(np.searchsorted(snapshot.scene.robot_rows, row))
    states = snapshot.robots
    (x, y, yaw), twist = states.odometry[place].tolist(), states.wheels[place].tolist()
    return OdometryReading((x, y, yaw), tuple(twist))


def true_motion(snapshot: Snapshot, row: int) -> OdometryReading:
    """
    Return the pose in the world, and the velocity.

    :param snapshot: of the world
    :param row: of the robot's body in the scene
    """
    vx, vy, turn = snapshot.twists[row].tolist()
    x, y, yaw = snapshot.poses[row].tolist()
    center_x, center_y = snapshot.centers[row].tolist()
    ahead, aside = rotated((vx - turn * (y - center_y), vy + turn * (x - center_x)), -yaw)
    return OdometryReading((x, y, yaw), (ahead, aside, turn))
