# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
What sensors of robots read: functions of a frame and the sensor.

Law: the same frame and sensor have the same reading, whoever else senses, in any order and
after a rewind. No state, no clock, and of the engine only the core, which casts the rays;
messages of readings are in `ros`. Start with `distance`, then `surroundings` (what rays meet).
"""

from physsim_ros.sensing.battery import BatteryReading, read_battery
from physsim_ros.sensing.distance import read_laser, scan_points
from physsim_ros.sensing.motion import (
    odometry_covariances,
    OdometryReading,
    read_odometry,
    true_motion,
)
from physsim_ros.sensing.sampling import is_due, reading_name
from physsim_ros.sensing.sensed_frame import read_sensor, SensedFrame
from physsim_ros.sensing.surroundings import Surroundings
from physsim_ros.sensing.touch import is_bumped

__all__ = [
    'BatteryReading',
    'OdometryReading',
    'SensedFrame',
    'Surroundings',
    'is_bumped',
    'is_due',
    'odometry_covariances',
    'read_battery',
    'read_laser',
    'read_odometry',
    'read_sensor',
    'reading_name',
    'scan_points',
    'true_motion',
]
