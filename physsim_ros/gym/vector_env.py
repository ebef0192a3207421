# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Many worlds in one process, in each of which an agent has the same task."""

from __future__ import annotations

from collections.abc import Sequence
from copy import deepcopy
from functools import partial
from typing import Any, cast

from gymnasium.vector import AutoresetMode, SyncVectorEnv
from gymnasium.vector.utils import concatenate, create_empty_array
import numpy as np
from physsim_ros.gym.robot_env import check_episode, RobotEnv, SavedEpisode
from physsim_ros.gym.task import Observation, Task
from physsim_ros.model.checks import Whole

_COUNT = Whole(1, 10_000)


class RobotVectorEnv(SyncVectorEnv):
    """
    Many worlds of one task in one process: Gymnasium's `SyncVectorEnv` with saved moments.

    A copy, also a shallow one, and a pickle have worlds of their own. After a reset with a seed,
    world k has the episodes of a `RobotEnv` reset with seed + k.

    :param task: the task
    :param num_envs: number of worlds
    :param render_mode: with 'rgb_array', `render` returns a picture of each; None is no pictures
    :param autoreset_mode: an episode that has ended begins anew in the next step, whose action is
        ignored; in the same step; or (disabled) by a reset with a mask
    :raises BadProperty: the number is out of range, or there is no such render mode
    :raises ValueError: there is no such autoreset mode

    :ivar envs: the environment of each world, a `RobotEnv`
    """

    def __init__(
        self,
        task: Task,
        num_envs: int = 1,
        *,
        render_mode: str | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
    ) -> None:
        _COUNT(num_envs, 'num_envs')
        make = partial(RobotEnv, task, render_mode=render_mode)
        super().__init__([make] * num_envs, autoreset_mode=autoreset_mode)

    def __copy__(self) -> RobotVectorEnv:
        """Return a copy with worlds of its own, as a copy of a `RobotEnv` has."""
        return deepcopy(self)

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Observation, dict[str, Any]]:
        """
        Begin an episode in each world, or in some.

        :param seed: of world k it is seed + k; or the seed of each; None is the next one of each
        :param options: under 'reset_mask' (num_envs,) bool: the worlds in which one begins
        :return: the observations of all worlds, and under 'seed' the seeds of the noise of those
            in which an episode has begun, by the flags under '_seed'
        :raises ValueError: there are not as many seeds or flags as worlds, or no flag is set
        :raises TypeError: the flags are no array of bool
        """
        # Gymnasium 1.4 takes `reset_mask` out of the caller's own options.
        result: tuple[Observation, dict[str, Any]] = super().reset(
            seed=seed if seed is None or isinstance(seed, int) else [*seed],
            options=None if options is None else {**options},
        )
        return result

    def save(self) -> tuple[tuple[SavedEpisode, bool], ...]:
        """Return the moment of each world, and whether its episode has ended."""
        ended = self._autoreset_envs.tolist()
        return tuple((env.save(), end) for env, end in zip(self._robots, ended, strict=True))

    @property
    def _robots(self) -> list[RobotEnv]:
        return cast('list[RobotEnv]', self.envs)

    def restore(self, saved: Sequence[tuple[SavedEpisode, bool]]) -> Observation:
        """
        Continue from saved moments; return what is observed then, of all worlds.

        :raises ValueError: they are not of as many worlds
        :raises Malformed: one is no saved episode; then no world has changed
        """
        episodes = [check_episode(episode) for episode, _ in saved]
        pairs = [*zip(self._robots, episodes, strict=True)]
        # Attributes of Gymnasium 1.1 to 1.4: the observation of each world, which stays where it
        # is not reset, and whether its episode has ended.
        self._env_obs = [env.restore(episode) for env, episode in pairs]
        self._autoreset_envs = np.array([ended for _, ended in saved])
        space = self.single_observation_space
        batch = cast('Observation', create_empty_array(space, self.num_envs))
        return concatenate(space, self._env_obs, batch)
