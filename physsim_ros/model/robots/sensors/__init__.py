# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Sensors of robots: what is mounted where, and how well it measures; one file a kind.

A sensor is a value. What it reads in a frame is for the simulation, its message an encoder in
`ros`. A new kind is a file here and a member of `SENSORS`. Start with `sensor`, then `laser`.
"""

from __future__ import annotations

from physsim_ros.model.declarations import OfKind
from physsim_ros.model.robots.sensors.bumper import Bumper
from physsim_ros.model.robots.sensors.floor_eye import FloorEye
from physsim_ros.model.robots.sensors.gps import Gps
from physsim_ros.model.robots.sensors.imu import Imu
from physsim_ros.model.robots.sensors.laser import Laser
from physsim_ros.model.robots.sensors.range_finder import RangeFinder
from physsim_ros.model.robots.sensors.sensor import Sensor
from physsim_ros.model.robots.sensors.wheel_encoders import WheelEncoders

# By the word for it.
SENSORS: dict[str, type[Sensor]] = {
    each.KIND: each for each in (Laser, RangeFinder, Bumper, Imu, WheelEncoders, FloorEye, Gps)
}


# The check of a sensor.
sensor_from = OfKind('sensor', SENSORS)

__all__ = [
    'SENSORS',
    'Bumper',
    'FloorEye',
    'Gps',
    'Imu',
    'Laser',
    'RangeFinder',
    'Sensor',
    'WheelEncoders',
    'sensor_from',
]
