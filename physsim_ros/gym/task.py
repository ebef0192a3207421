# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A task: a world with a robot, and functions for observation, action, reward and end.

If these functions are defined in a module and have no state, a task can be pickled, and an episode
with the same seed and actions repeats to the bit.
"""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Annotated, Any, TypeAlias

from gymnasium.spaces import Box, Space
import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.checks import LONGEST, Within
from physsim_ros.model.declarations import Checked
from physsim_ros.model.errors import BadProperty
from physsim_ros.simulation.robot import Robot

# Actions and observations of an agent: values of its spaces.
Action: TypeAlias = Any
Observation: TypeAlias = Any


def drive(robot: Robot, action: NDArray[np.float32]) -> None:
    """
    Drive at shares of the greatest speed and turn rate of the robot.

    :param action: (2,) float32: forward and counter-clockwise, each -1 .. 1
    :raises BadProperty: the robot has no drive
    """
    limits = robot.description.drive
    if limits is None:
        raise BadProperty('{robot} has no drive', field='robot', robot=robot.name)
    speed, turn = np.clip(action, -1.0, 1.0).tolist()
    robot.drive(speed * limits.max_speed, turn * limits.max_turn)


def observe_scan(robot: Robot) -> NDArray[np.float32]:
    """
    Return the scan of the first laser, (beams,) float32: 0 .. 1, shares of its greatest range.

    It is 1 where nothing is within range or a beam is blind, and 0 where something is nearer than
    the least range.
    """
    laser = robot.first_laser
    # `fmin` of NaN and 1 is 1.
    shares = np.fmin(robot.scan() / laser.range[1], 1.0)
    return np.maximum(shares, 0.0).astype(np.float32)


def _shares() -> Space[Any]:
    """Return the space of the actions of `drive`."""
    return Box(-1.0, 1.0, (2,), np.float32)


def _never(_: Robot) -> bool:
    return False


@dataclass(frozen=True, kw_only=True)
class Task(Checked):
    """
    What an agent is to do with a robot.

    :param world: state with the robot, with which each episode begins; each has its own noise
    :param reward: returns the reward after a step, from the robot and the action of that step
    :param robot: name of the robot's body
    :param begin: changes the world when an episode begins, by a random generator of its seed, such
        as with `robot.place`; None changes nothing
    :param act: performs an action, which lasts until the next step
    :param action_space: space of the actions
    :param observe: returns the observation
    :param observation_space: space of the observations; None is that of `observe_scan`
    :param is_over: returns whether an episode has ended, well or badly (Gymnasium: terminated)
    :param physics_rate: steps a second of the world [Hz], a multiple of 1 / period
    :raises BadProperty: a time is out of range
    """

    world: WorldState
    reward: Callable[[Robot, Action], float]
    robot: str = 'robot/0'
    begin: Callable[[Robot, np.random.Generator], object] | None = None
    act: Callable[[Robot, Action], object] = drive
    action_space: Space[Any] = field(default_factory=_shares)
    observe: Callable[[Robot], Observation] = observe_scan
    observation_space: Space[Any] | None = None
    is_over: Callable[[Robot], bool] = _never
    period: Annotated[float, Within(1e-4, 1.0, 's'), 'simulation time of a step'] = 0.1
    longest: Annotated[
        float,
        Within(1e-4, LONGEST, 's'),
        'simulation time after which an episode is cut off (Gymnasium: truncated)',
    ] = 60.0
    physics_rate: float = 240.0

    def observed(self, robot: Robot) -> Space[Any]:
        """
        Return the space of the observations.

        :raises BadProperty: the task has no space, and the robot has no laser
        """
        if self.observation_space is not None:
            return self.observation_space
        return Box(0.0, 1.0, (robot.first_laser.beams,), np.float32)
