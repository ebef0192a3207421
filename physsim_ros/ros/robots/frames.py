# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The frames of a robot (REP 105), and the transforms between them.

`odom` to `base_footprint` moves, as the odometry reckons; `base_footprint` to `base_link` and from
that to the sensors stays. Where the robot really is, on `ground_truth`, is no transform: a
localiser publishes `map` to `odom`.
"""

from __future__ import annotations

from enum import StrEnum
import math
from typing import Any

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from physsim_ros.model.robots import Robot
from physsim_ros.model.transform import Pose

ODOM, FOOTPRINT, BASE = 'odom', 'base_footprint', 'base_link'
# Depth of `/tf`: that of tf2_ros.
TF_DEPTH = 100


class RobotTf(StrEnum):
    """
    Where transforms of robots are published.

    Prefixed: on `/tf`, names of frames begin with the namespace; namespaced: on `<namespace>/tf`,
    plain names, as Nav2 has several robots.
    """

    PREFIXED = 'prefixed'
    NAMESPACED = 'namespaced'
    NONE = 'none'


class RobotFrames:
    """
    The frames of a robot.

    :param namespace: of the robot, '' or one without a slash in front
    :param robot_tf: where its transforms are published
    """

    def __init__(self, namespace: str, robot_tf: RobotTf) -> None:
        plain = not namespace or robot_tf is RobotTf.NAMESPACED
        self._prefix = '' if plain else f'{namespace}/'

    def name(self, frame: str) -> str:
        """Return the name of a frame, as `odom` or that of a sensor."""
        return f'{self._prefix}{frame}'

    def moving(self, stamp: Time, odometry: Pose) -> TransformStamped:
        """
        Return the transform from `odom` to `base_footprint`.

        :param odometry: x, y [m], yaw [rad] that the robot reckons
        """
        return self._transform(stamp, ODOM, FOOTPRINT, odometry)

    def fixed(self, stamp: Time, robot: Robot) -> list[TransformStamped]:
        """Return the transforms that stay: of `base_link`, and of the places of the sensors."""
        return [
            self._transform(stamp, FOOTPRINT, BASE, (0.0, 0.0, 0.0)),
            *(self._transform(stamp, BASE, each.name, each.at) for each in robot.sensors),
        ]

    def _transform(self, stamp: Time, parent: str, child: str, pose: Pose) -> TransformStamped:
        message = TransformStamped(child_frame_id=self.name(child))
        message.header.stamp, message.header.frame_id = stamp, self.name(parent)
        x, y, yaw = pose
        message.transform = Transform(translation=Vector3(x=x, y=y), rotation=rotation_of(yaw))
        return message


def tf_message_type() -> Any:
    """Return the type of messages on `/tf`; None where its package is not installed."""
    try:
        from tf2_msgs.msg import TFMessage  # noqa: PLC0415 - no part of common_interfaces
    except ModuleNotFoundError:
        return None
    return TFMessage


def rotation_of(yaw: float) -> Quaternion:
    """Return a turn about z [rad]."""
    return Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2))
