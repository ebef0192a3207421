# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Robots: bodies that drive, by a mapping below the key `robot` of a body.

A robot is a drive, odometry, sensors, parts and the namespace of its topics; values only, checked
as they are made. Shipped robots are files (`files.robot_files`), the floor that drives act on
is a stage of the engine. Start with `robot`, then `parts`; a new drive is a class in `drives`, a
new sensor one in `sensors`.
"""

from physsim_ros.model.robots.battery import Battery, MOST_DOCKS
from physsim_ros.model.robots.drives import Car, Differential, Drive, DRIVES, Omni
from physsim_ros.model.robots.part_names import BASE, part_name
from physsim_ros.model.robots.parts import Link, LinkJoint, Towed, TOWED_WORDS, TREE_KINDS
from physsim_ros.model.robots.robot import (
    BATTERY_TOPIC,
    check_namespace,
    JOINT_TOPICS,
    Odometry,
    Robot,
    whole_of,
)
from physsim_ros.model.robots.sensors import Sensor, sensor_from

__all__ = [
    'BASE',
    'BATTERY_TOPIC',
    'DRIVES',
    'JOINT_TOPICS',
    'MOST_DOCKS',
    'TOWED_WORDS',
    'TREE_KINDS',
    'Battery',
    'Car',
    'Differential',
    'Drive',
    'Link',
    'LinkJoint',
    'Odometry',
    'Omni',
    'Robot',
    'Sensor',
    'Towed',
    'check_namespace',
    'part_name',
    'sensor_from',
    'whole_of',
]
