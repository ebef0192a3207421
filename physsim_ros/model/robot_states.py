# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The states of the robots of a world: what drives and odometry have, besides pose and twist."""

from __future__ import annotations

from collections.abc import Sequence
import itertools
from typing import NamedTuple, Self

import numpy as np
from physsim_ros.model.arrays import Floats, Ints
from physsim_ros.model.transform import ORIGIN, Pose, REST, Twist

# Of a planar pose: xx, xy, yy [m²], x yaw, y yaw [m rad], yaw yaw [rad²].
Covariance = tuple[float, float, float, float, float, float]
# Step at which a command without a timeout ends.
NEVER = 2**62


class RobotState(NamedTuple):
    """
    The state of one robot; `RobotStates` has its fields.

    In a saved state, `until` counts from the moment of saving.
    """

    aim: Twist
    until: int
    wheels: Twist
    travel: Pose
    odometry: Pose
    covariance: Covariance

    def shifted(self, steps: int) -> Self:
        """Return the state in a world that counts its steps from so many earlier."""
        if self.until == NEVER:
            return self
        return self._replace(until=max(self.until + steps, 0))


# Of a robot that was just spawned.
SPAWNED = RobotState(REST, 0, REST, ORIGIN, ORIGIN, (0.0,) * 6)


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
    :ivar covariance: (r, 6) float64: of that pose: xx, xy, yy [m²], x yaw, y yaw [m rad], yaw yaw
        [rad²]
    """

    aim: Floats
    until: Ints
    wheels: Floats
    travel: Floats
    odometry: Floats
    covariance: Floats

    @classmethod
    def of(cls, robots: Sequence[RobotState]) -> RobotStates:
        """Return the states of robots; of none the same value, which frames share."""
        if not robots:
            return NO_ROBOTS
        aim, until, *others = zip(*robots, strict=True)
        return cls(_columns(aim), np.array(until, np.int64), *map(_columns, others))

    def rows(self) -> list[RobotState]:
        """Return the state of each robot."""
        rows = zip(*(column.tolist() for column in self), strict=True)
        return [RobotState(tuple(aim), until, *map(tuple, others)) for aim, until, *others in rows]

    @property
    def nbytes(self) -> int:
        """Memory of the arrays [bytes]."""
        return sum(column.nbytes for column in self) if len(self.until) else 0


def _columns(rows: Sequence[tuple[float, ...]]) -> Floats:
    """Return (r, w) float64; of rows in rows NumPy takes three times as long."""
    return np.array([*itertools.chain.from_iterable(rows)], np.float64).reshape(len(rows), -1)


NO_ROBOTS = RobotStates(
    aim=np.empty((0, 3)),
    until=np.empty(0, np.int64),
    wheels=np.empty((0, 3)),
    travel=np.empty((0, 3)),
    odometry=np.empty((0, 3)),
    covariance=np.empty((0, 6)),
)
