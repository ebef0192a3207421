# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The frames of a robot (REP 105), and the transforms between them.

`odom` to `base_footprint` moves, as the odometry reckons, and each link on the one that it hangs
on; `base_footprint` to `base_link` and from links to their sensors stays. A link has its frame at
the point of the joint that it hangs on, about which the joint turns in URDF. Where the robot
really is, on `ground_truth`, is no transform: a localiser publishes `map` to `odom`.
"""

from __future__ import annotations

from enum import StrEnum
from typing import Any

from builtin_interfaces.msg import Time
from geometry_msgs.msg import Transform, TransformStamped, Vector3
from physsim_ros.model.robots import BASE as ROBOT_BASE
from physsim_ros.model.robots import part_name, Robot, Sensor
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import composed, ORIGIN, Point, Pose, seen_from, world_to_local
from physsim_ros.ros.planar import rotation_of

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
            *(
                self._transform(stamp, frame_of(each.link), each.name, mounting_of(robot, each))
                for each in robot.sensors
            ),
        ]

    def of_links(
        self, stamp: Time, snapshot: Snapshot, body: str, robot: Robot
    ) -> list[TransformStamped]:
        """
        Return the transforms of links, each to the one that it hangs on; of those that are there.

        :param body: name of the robot's body
        """
        rows = snapshot.scene.row_of
        transforms = []
        for link in robot.links:
            above = robot.joint_above(link.name).b
            ends = part_name(body, above), part_name(body, link.name)
            if all(end in rows for end in ends):
                poses = (snapshot.poses[rows[end]].tolist() for end in ends)
                origin, place = (
                    composed((x, y, yaw), (*origin_of(robot, each), 0.0))
                    for (x, y, yaw), each in zip(poses, (above, link.name), strict=True)
                )
                pose = seen_from(origin, place)
                transforms.append(self._transform(stamp, frame_of(above), link.name, pose))
        return transforms

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


def frame_of(link: str) -> str:
    """Return the frame of a link."""
    return BASE if link == ROBOT_BASE else link


def origin_of(robot: Robot, link: str) -> Point:
    """Return the origin of the frame of a link in that of its body [m]."""
    if link == ROBOT_BASE:
        return ORIGIN[:2]
    return world_to_local(robot.joint_above(link).points[0], robot.place_of(link))


def mounting_of(robot: Robot, sensor: Sensor) -> Pose:
    """Return the pose of a sensor in the frame of its link."""
    x, y = origin_of(robot, sensor.link)
    return sensor.at[0] - x, sensor.at[1] - y, sensor.at[2]
