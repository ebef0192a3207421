# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
What sensors of robots read: functions of a frame and the sensor.

Law: the same frame and sensor have the same reading, whoever else senses, in any order and
after a rewind. No state, no clock, and of the engine only the core, which casts the rays;
messages of readings are in `ros`. Start with `distance`, then `surroundings` (what rays meet).
"""

from physsim_ros.sensing.battery import BatteryReading, read_battery
from physsim_ros.sensing.distance import read_landmarks, read_laser, read_range, scan_points
from physsim_ros.sensing.gps import Fix, fix_of, read_gps
from physsim_ros.sensing.motion import (
    InertialReading,
    joint_motion,
    odometry_covariances,
    OdometryReading,
    read_imu,
    read_odometry,
    read_wheels,
    true_motion,
    WheelReading,
)
from physsim_ros.sensing.sampling import is_due
from physsim_ros.sensing.surroundings import Surroundings
from physsim_ros.sensing.touch import is_bumped, read_bumper, read_floor
from physsim_ros.sensing.view import read_sensor, View

__all__ = [
    'BatteryReading',
    'Fix',
    'InertialReading',
    'OdometryReading',
    'Surroundings',
    'View',
    'WheelReading',
    'fix_of',
    'is_bumped',
    'is_due',
    'joint_motion',
    'odometry_covariances',
    'read_battery',
    'read_bumper',
    'read_floor',
    'read_gps',
    'read_imu',
    'read_landmarks',
    'read_laser',
    'read_odometry',
    'read_range',
    'read_sensor',
    'read_wheels',
    'scan_points',
    'true_motion',
]
