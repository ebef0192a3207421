# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Robots: bodies that drive, by a mapping below the key `robot` of a body.

A robot is a drive, odometry, sensors and the namespace of its topics; values only, checked as they
are made. Shipped robots are files (`files.resources`), the floor that drives act on is a stage of
the engine. Start with `robot`; a new drive is a class in `drives`, a new sensor one in `sensors`.
"""

from physsim_ros.model.robots.drives import Car, Differential, Drive, DRIVES, Omni, Towed
from physsim_ros.model.robots.robot import check_namespace, Odometry, Robot
from physsim_ros.model.robots.sensors import Sensor, sensor_from

__all__ = [
    'DRIVES',
    'Car',
    'Differential',
    'Drive',
    'Odometry',
    'Omni',
    'Robot',
    'Sensor',
    'Towed',
    'check_namespace',
    'sensor_from',
]
