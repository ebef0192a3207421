# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
What sensors of robots read: functions of a frame, the sensor and the seed; one file a kind.

Law: the same frame, sensor and seed have the same reading, whoever else senses, in any order and
after a rewind. No state, no clock, no engine; messages of readings are in `ros`. Start with
`laser`, then `surroundings` (what rays meet) and `fan` (how).
"""

from physsim_ros.sensing.bumper import is_bumped, read_bumper
from physsim_ros.sensing.floor_eye import FloorMarks, read_floor
from physsim_ros.sensing.gps import Fix, fix_of, read_gps
from physsim_ros.sensing.imu import InertialReading, read_imu
from physsim_ros.sensing.laser import read_laser, scan_points
from physsim_ros.sensing.odometry import OdometryReading, read_odometry, true_motion
from physsim_ros.sensing.range_finder import read_range
from physsim_ros.sensing.schedule import is_due
from physsim_ros.sensing.surroundings import Surroundings
from physsim_ros.sensing.view import read_sensor, View
from physsim_ros.sensing.wheel_encoders import read_wheels, WheelReading

__all__ = [
    'Fix',
    'FloorMarks',
    'InertialReading',
    'OdometryReading',
    'Surroundings',
    'View',
    'WheelReading',
    'fix_of',
    'is_bumped',
    'is_due',
    'read_bumper',
    'read_floor',
    'read_gps',
    'read_imu',
    'read_laser',
    'read_odometry',
    'read_range',
    'read_sensor',
    'read_wheels',
    'scan_points',
    'true_motion',
]
