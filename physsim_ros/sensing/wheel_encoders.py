# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The reading of the encoders: how far and how fast the wheels of a drive have turned."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.snapshot import Snapshot


class WheelReading(NamedTuple):
    """
    The wheels of a drive.

    :ivar names: of their joints
    :ivar positions: (w,) float64: turned since the robot was spawned [rad]
    :ivar velocities: (w,) float64: of now [rad/s]
    """

    names: tuple[str, ...]
    positions: Floats
    velocities: Floats


def read_wheels(snapshot: Snapshot, row: int) -> WheelReading:
    """
    Return how far and how fast the wheels of a robot have turned, slipping or not.

    :param snapshot: of the world
    :param row: of the robot's body in the scene
    """
    robot = snapshot.scene.bodies[row].robot
    assert robot is not None  # noqa: S101 - by the contract above
    place = int(np.searchsorted(snapshot.scene.robot_rows, row))
    # The speed of each rim is the sum of these times the velocity of the drive.
    rims = np.array(list(robot.drive.wheels.values())) / robot.drive.wheel_radius
    states = snapshot.robots
    return WheelReading(
        tuple(robot.drive.wheels),
        (rims * states.travel[place]).sum(axis=1),
        (rims * states.wheels[place]).sum(axis=1),
    )
