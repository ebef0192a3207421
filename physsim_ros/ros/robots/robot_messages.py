# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The messages of one robot, each of a frame.

Law: a message of a moment is the same whoever subscribes, or none does, as in a test.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from nav_msgs.msg import Odometry
from physsim_ros.model.robots import Battery, Robot, Sensor
from physsim_ros.model.robots.sensors import Laser
from physsim_ros.model.states import SPAWNED
from physsim_ros.ros.robots.frames import BASE, FOOTPRINT, ODOM, RobotFrames
from physsim_ros.ros.robots.messages import (
    battery_message,
    odometry_message,
    SENSOR_MESSAGES,
    StampedFrame,
)
from physsim_ros.sensing import odometry_covariances, read_odometry, true_motion
from sensor_msgs.msg import BatteryState


class RobotMessages:
    """
    The messages of a robot, of a frame and the row of its body in the scene.

    :param body: name of the robot's body
    :param robot: that it is
    :param frames: of the robot
    :param world_frame: name of the world frame
    :param lasers: as they are published, by name; others are those of the robot
    """

    def __init__(
        self,
        body: str,
        robot: Robot,
        frames: RobotFrames,
        *,
        world_frame: str,
        lasers: Mapping[str, Laser],
    ) -> None:
        self._body, self._robot, self._frames = body, robot, frames
        self._world_frame = world_frame
        self._lasers = lasers

    def transforms(self, kind: type, sensed: StampedFrame, row: int) -> Any:
        """Return the message of the transforms that move."""
        transforms = self._frames.of_links(sensed.stamp, sensed.snapshot, self._body, self._robot)
        if self._robot.drive is not None:
            pose = read_odometry(sensed.snapshot, row).pose
            transforms = [self._frames.moving(sensed.stamp, pose), *transforms]
        return kind(transforms=transforms)

    def odometry(self, sensed: StampedFrame, row: int) -> Odometry:
        """Return where wheels and gyroscope tell that the robot is, and how it moves."""
        return odometry_message(
            sensed,
            read_odometry(sensed.snapshot, row),
            parent=self._frames.name(ODOM),
            child=self._frames.name(FOOTPRINT),
            covariances=odometry_covariances(sensed.snapshot, row),
        )

    def truth(self, sensed: StampedFrame, row: int) -> Odometry:
        """Return where the robot is, and how it moves."""
        return odometry_message(
            sensed,
            true_motion(sensed.snapshot, row),
            parent=self._world_frame,
            child=self._frames.name(BASE),
            covariances=(SPAWNED.covariance, SPAWNED.covariance),
        )

    def battery(self, battery: Battery, sensed: StampedFrame, row: int) -> BatteryState:
        """Return the state of the battery."""
        message = battery_message(sensed, row, battery)
        message.header.frame_id = self._frames.name(BASE)
        return message

    def reading(self, sensor: Sensor, sensed: StampedFrame, row: int) -> Any:
        """Return the message of a sensor of it."""
        kind = SENSOR_MESSAGES[type(sensor)]
        message = kind.message(sensed, row, self._lasers.get(sensor.name, sensor))
        if kind.stamped:
            message.header.stamp = sensed.stamp
            message.header.frame_id = self._frames.name(sensor.name)
        return message
