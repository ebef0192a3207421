# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Many worlds in one process, in each of which an agent has the same task."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import cast

from gymnasium.vector import SyncVectorEnv
from gymnasium.vector.utils import concatenate, create_empty_array
import numpy as np
from physsim_ros.gym.robot_env import RobotEnv, SavedEpisode
from physsim_ros.gym.task import Observation, Task
from physsim_ros.model.checks import Whole

_COUNT = Whole(1, 10_000)


class RobotVectorEnv(SyncVectorEnv):
    """
    Many worlds of one task, stepped one after the other.

    World k of a reset with a seed has the episodes of a `RobotEnv` that is reset with seed + k. An
    episode that has ended begins anew in the next step, whose action is ignored.

    :param task: of the agent
    :param count: number of worlds
    :raises BadProperty: it is none, or too many
    """

    def __init__(self, task: Task, count: int) -> None:
        super().__init__([partial(RobotEnv, task)] * _COUNT(count, 'count'))

    @property
    def _worlds(self) -> list[RobotEnv]:
        return cast('list[RobotEnv]', [env.unwrapped for env in self.envs])

    def save(self) -> tuple[tuple[SavedEpisode, bool], ...]:
        """Return the moment of each world, and whether its episode has ended."""
        ended = self._autoreset_envs.tolist()
        return tuple((world.save(), end) for world, end in zip(self._worlds, ended, strict=True))

    def restore(self, saved: Sequence[tuple[SavedEpisode, bool]]) -> Observation:
        """
        Continue from saved moments; return what is observed then, of all worlds.

        :raises ValueError: they are not of as many worlds
        """
        worlds = zip(self._worlds, saved, strict=True)
        observed = [world.restore(episode) for world, (episode, _) in worlds]
        self._autoreset_envs = np.array([ended for _, ended in saved])
        space = self.single_observation_space
        batch = cast('Observation', create_empty_array(space, len(observed)))
        return concatenate(space, observed, batch)
