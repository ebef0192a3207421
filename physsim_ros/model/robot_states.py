# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The states of the robots of a world: what drives and odometry have, besides pose and twist."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Self

import numpy as np
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.transform import ORIGIN, Point, Pose, REST, Twist

# Step at which a command without a timeout ends.
NEVER = 2**62


class Driven(NamedTuple):
    """
    The state of one robot in a file; see `RobotStates`.

    :ivar steps: number of further steps for which the last command counts; None is for ever
    """

    aim: Twist
    steps: int | None
    wheels: Twist
    travel: Pose
    odometry: Pose
    path: Point


# Of a robot that was just spawned.
SPAWNED = Driven(REST, 0, REST, ORIGIN, ORIGIN, (0.0, 0.0))


class RobotStates(NamedTuple):
    """
    The states of r robots, in the order of the scene.

    Velocities are as seen from the robot: vx forward, vy to the left [m/s], turn [rad/s].

    :ivar aim: (r, 3) float64: velocity that the last command aims at; 0 after its timeout
    :ivar until: (r,) int64: step at which the command ends; NEVER is none
    :ivar wheels: (r, 3) float64: velocity that the wheels have; that of the robot where no wheel
        slips
    :ivar travel: (r, 3) float64: integral of that [m, m, rad]; a wheel has turned by the factors
        of its drive times this, over its radius
    :ivar odometry: (r, 3) float64: x, y [m], yaw [rad] by wheels and gyroscope, from the pose in
        which the robot was spawned
    :ivar path: (r, 2) float64: length of the way of the wheels [m], and sum of the turns of the
        body in either direction [rad]; the variance of the odometry grows with them
    """

    aim: Floats
    until: Ints
    wheels: Floats
    travel: Floats
    odometry: Floats
    path: Floats

    @classmethod
    def at_rest(cls, count: int) -> Self:
        """Return the states of a number of robots that were just spawned."""
        aim, wheels, travel, odometry = (np.zeros((count, 3)) for _ in range(4))
        until, path = np.zeros(count, np.int64), np.zeros((count, 2))
        return cls(aim, until, wheels, travel, odometry, path)

    def copy(self) -> Self:
        """Return a copy; of no robots the same value, which frames share."""
        if not len(self.until):
            return self
        return type(self)(
            aim=self.aim.copy(),
            until=self.until.copy(),
            wheels=self.wheels.copy(),
            travel=self.travel.copy(),
            odometry=self.odometry.copy(),
            path=self.path.copy(),
        )

    @classmethod
    def of(cls, robots: Sequence[Driven], step: int) -> RobotStates:
        """Return the states of robots of a file in a world that has made so many steps."""
        if not robots:
            return NO_ROBOTS
        until = [NEVER if each.steps is None else step + each.steps for each in robots]
        poses = ([each.aim, each.wheels, each.travel, each.odometry] for each in robots)
        columns = np.array([*poses], np.float64).swapaxes(0, 1)
        aim, wheels, travel, odometry = (np.ascontiguousarray(column) for column in columns)
        path = np.array([each.path for each in robots], np.float64)
        return cls(aim, np.array(until, np.int64), wheels, travel, odometry, path)

    def driven(self, step: int) -> list[Driven]:
        """Return the states for a file, of a world that has made so many steps."""
        rows = zip(*(column.tolist() for column in self), strict=True)
        return [
            Driven(
                aim=tuple(aim),
                steps=None if until == NEVER else max(until - step, 0),
                wheels=tuple(wheels),
                travel=tuple(travel),
                odometry=tuple(odometry),
                path=tuple(path),
            )
            for aim, until, wheels, travel, odometry, path in rows
        ]

    @property
    def nbytes(self) -> int:
        """Memory of the arrays [bytes]."""
        return sum(column.nbytes for column in self)


NO_ROBOTS = RobotStates.at_rest(0)
