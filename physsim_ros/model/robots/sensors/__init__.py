# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Sensors of robots: what is mounted where, and how well it measures.

A sensor is a value. A function in the file of the same name in `sensing` reads it in a frame, one
in `ros` makes the message. A new kind is a class and a member of `SENSORS`. Start with `sensor`,
then `distance`.
"""

from __future__ import annotations

from physsim_ros.model.declarations import OfKind
from physsim_ros.model.robots.sensors.distance import Landmarks, Laser, MOST_BEAMS, RangeFinder
from physsim_ros.model.robots.sensors.gps import Gps
from physsim_ros.model.robots.sensors.motion import Imu, WheelEncoders
from physsim_ros.model.robots.sensors.sensor import angles, LEAST_INCREMENT, Sensor, topic_name
from physsim_ros.model.robots.sensors.touch import Bumper, FloorEye

# By the word for it.
SENSORS: dict[str, type[Sensor]] = {
    each.KIND: each
    for each in (Laser, RangeFinder, Landmarks, Bumper, Imu, WheelEncoders, FloorEye, Gps)
}


# The check of a sensor.
sensor_from = OfKind('sensor', SENSORS)

__all__ = [
    'LEAST_INCREMENT',
    'MOST_BEAMS',
    'SENSORS',
    'Bumper',
    'FloorEye',
    'Gps',
    'Imu',
    'Landmarks',
    'Laser',
    'RangeFinder',
    'Sensor',
    'WheelEncoders',
    'angles',
    'sensor_from',
    'topic_name',
]
