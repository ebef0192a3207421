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


class View:
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
_READERS: Mapping[type[Sensor], Callable[[View, int, Any], Any]] = {
    Laser: lambda view, row, laser: read_laser(view.surroundings, row, laser),
    RangeFinder: lambda view, row, finder: read_range(view.surroundings, row, finder),
    Landmarks: lambda view, row, finder: read_landmarks(view.surroundings, row, finder),
    Bumper: lambda view, row, bumper: read_bumper(view.snapshot, view.contacts, row, bumper),
    Imu: lambda view, row, imu: read_imu(view.snapshot, view.before, row, imu),
    WheelEncoders: lambda view, row, _: read_wheels(view.snapshot, row),
    FloorEye: lambda view, row, eye: read_floor(view.snapshot, row, eye),
    Gps: lambda view, row, gps: read_gps(view.snapshot, row, gps),
}


def read_sensor(view: View, row: int, sensor: Sensor) -> Any:
    """
    Return the reading of a sensor: what the function of its kind in this folder returns.

    :param view: of the frame
    :param row: of the robot's body in the scene
    :param sensor: on it
    """
    return _READERS[type(sensor)](view, row, sensor)
