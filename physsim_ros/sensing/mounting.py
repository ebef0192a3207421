# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Poses of sensors, and the bodies that they are on."""

from __future__ import annotations

from physsim_ros.model.robots import BASE, part_name
from physsim_ros.model.robots.sensors import Sensor
from physsim_ros.model.snapshot import Snapshot
from physsim_ros.model.transform import composed, Pose


def placed(snapshot: Snapshot, row: int, sensor: Sensor) -> Pose:
    """
    Return the pose of a sensor in the world: x, y [m], yaw [rad].

    :param row: of the robot's body in the scene
    """
    x, y, yaw = snapshot.poses[mounted_row(snapshot, row, sensor)].tolist()
    return composed((x, y, yaw), sensor.at)


def mounted_row(snapshot: Snapshot, row: int, sensor: Sensor) -> int:
    """
    Return the row of the body that a sensor is on; that of the robot where its link is gone.

    :param row: of the robot's body in the scene
    """
    if sensor.link == BASE:
        return row
    scene = snapshot.scene
    return scene.row_of.get(part_name(scene.names[row], sensor.link), row)
