# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The states of robots and actors: what they have besides pose and twist.

A world has one array of each, a record for every robot or actor in the order of the scene; the
state of a single one is a value of a class below, with the fields of the records.
"""

from __future__ import annotations

from typing import NamedTuple, Self, TypeVar

import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.transform import ORIGIN, Pose, REST, Twist

# Of a planar pose: xx, xy, yy [m²], x yaw, y yaw [m rad], yaw yaw [rad²].
Covariance = tuple[float, float, float, float, float, float]
# Step at which a command without a timeout ends, and an actor that waits starts.
NEVER = 2**62
# (r,) `ROBOT_STATE`, or (a,) `ACTOR_STATE`.
Records = NDArray[np.void]


class RobotState(NamedTuple):
    """
    The state of a robot: drive and odometry.

    Velocities are as seen from the robot: vx forward, vy to the left [m/s], turn [rad/s].

    :ivar aim: velocity that the last command aims at; 0 after its timeout
    :ivar until: step at which the command ends, in a saved state from the moment of saving; NEVER
        is none
    :ivar wheels: velocity that the wheels have; that of the robot where no wheel slips
    :ivar travel: integral of that [m, m, rad]; a wheel has turned by the factors of its drive
        times this, over its radius
    :ivar odometry: x, y [m], yaw [rad] by wheels and gyroscope, from the pose in which the robot
        was spawned
    :ivar covariance: of that pose
    :ivar drawn: charge that its battery has given since it was spawned, less what docks have given
        [A s]
    """

    aim: Twist
    until: int
    wheels: Twist
    travel: Pose
    odometry: Pose
    covariance: Covariance
    drawn: float = 0.0

    def shifted(self, steps: int) -> Self:
        """Return the state with its steps counted from a beginning that is earlier."""
        if self.until == NEVER:
            return self
        return self._replace(until=max(self.until + steps, 0))


class DriveCommand(NamedTuple):
    """
    A command that a robot has received, and that its drive does not obey yet.

    :ivar begun: step at which the drive obeys it, in a saved state from the moment of saving
    :ivar aim: velocity that it aims at, as of `RobotState`
    :ivar until: step at which it ends, likewise; NEVER is none
    """

    begun: int
    aim: Twist
    until: int

    def shifted(self, steps: int) -> Self:
        """Return the command with its steps counted from a beginning that is earlier."""
        until = self.until if self.until == NEVER else self.until + steps
        return self._replace(begun=self.begun + steps, until=until)


class ActorState(NamedTuple):
    """
    The state of an actor.

    :ivar begun: step at which it starts, or started, in a saved state from the moment of saving;
        NEVER where it waits for a gate or a distance
    :ivar reached: count of the points that a pedestrian has reached; 0 of a path
    """

    begun: int
    reached: int

    def shifted(self, steps: int) -> Self:
        """Return the state with its steps counted from a beginning that is earlier."""
        return self if self.begun == NEVER else self._replace(begun=self.begun + steps)


# Of a robot that was just spawned, and of an actor that waits for its start.
SPAWNED = RobotState(REST, 0, REST, ORIGIN, ORIGIN, (0.0,) * 6)
WAITING = ActorState(NEVER, 0)

ROBOT_STATE = np.dtype(
    [
        ('aim', np.float64, 3),
        ('until', np.int64),
        ('wheels', np.float64, 3),
        ('travel', np.float64, 3),
        ('odometry', np.float64, 3),
        ('covariance', np.float64, 6),
        ('drawn', np.float64),
    ]
)
ACTOR_STATE = np.dtype([('begun', np.int64), ('reached', np.int64)])
# The states of worlds without robots or actors, in memory once.
NO_ROBOTS, NO_ACTORS = np.empty(0, ROBOT_STATE), np.empty(0, ACTOR_STATE)

_State = TypeVar('_State', RobotState, ActorState)


def states_in(records: Records, kind: type[_State]) -> list[_State]:
    """Return the state that each record has."""
    columns = (records[name].tolist() for name in kind._fields)
    rows = zip(*columns, strict=True)
    return [kind._make(tuple(it) if isinstance(it, list) else it for it in row) for row in rows]
