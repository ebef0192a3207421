# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A frame as the sensors of all robots see it, and the reading of any sensor in it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any

from physsim_ros.model.robots.sensors import (
    Bumper,
    FloorEye,
    Gps,
    Imu,
    Landmarks,
    Laser,
    RangeFinder,
    Sensor,
    WheelEncoders,
)
from physsim_ros.model.snapshot import Frame, NO_CONTACTS, Snapshot
from physsim_ros.sensing.distance import read_landmarks, read_laser, read_range
from physsim_ros.sensing.gps import read_gps
from physsim_ros.sensing.motion import read_imu, read_wheels
from physsim_ros.sensing.surroundings import Surroundings
from physsim_ros.sensing.touch import read_bumper, read_floor


class SensedFrame:
    """
    A frame as the sensors of all robots see it; what they share is made when it is first needed.

    :param frame: that is shown
    :param before: the last snapshot of another time, which was shown before it; None is none
    """

    def __init__(self, frame: Frame, before: Snapshot | None) -> None:
        self.frame = frame
        self.snapshot = frame.snapshot
        self.contacts = NO_CONTACTS if frame.contacts is None else frame.contacts
        self.before = before

    @cached_property
    def surroundings(self) -> Surroundings:
        """Bodies and walls that rays can meet."""
        return Surroundings(self.snapshot)


# Reading of a sensor of a kind on the body of a row.
_READERS: Mapping[type[Sensor], Callable[[SensedFrame, int, Any], Any]] = {
    Laser: lambda sensed, row, laser: read_laser(sensed.surroundings, row, laser),
    RangeFinder: lambda sensed, row, finder: read_range(sensed.surroundings, row, finder),
    Landmarks: lambda sensed, row, finder: read_landmarks(sensed.surroundings, row, finder),
    Bumper: lambda sensed, row, bumper: read_bumper(sensed.snapshot, sensed.contacts, row, bumper),
    Imu: lambda sensed, row, imu: read_imu(sensed.snapshot, sensed.before, row, imu),
    WheelEncoders: lambda sensed, row, _: read_wheels(sensed.snapshot, row),
    FloorEye: lambda sensed, row, eye: read_floor(sensed.snapshot, row, eye),
    Gps: lambda sensed, row, gps: read_gps(sensed.snapshot, row, gps),
}


def read_sensor(sensed: SensedFrame, row: int, sensor: Sensor) -> Any:
    """
    Return the reading of a sensor: what the function of its kind in this folder returns.

    :param sensed: of the frame
    :param row: of the robot's body in the scene
    :param sensor: on it
    """
    return _READERS[type(sensor)](sensed, row, sensor)
