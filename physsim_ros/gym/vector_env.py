# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Many worlds in one process, in each of which an agent has the same task."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any, cast

from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space, concatenate, create_empty_array, iterate
import numpy as np
from numpy.typing import NDArray
from physsim_ros.gym.robot_env import check_episode, RobotEnv, SavedEpisode
from physsim_ros.gym.task import Action, Observation, Task
from physsim_ros.model.checks import Whole

_COUNT = Whole(1, 10_000)
# Of all worlds.
_Flags = NDArray[np.bool_]


class RobotVectorEnv(VectorEnv[Observation, Action, NDArray[Any]]):
    """
    Many worlds of one task, stepped one after the other.

    World k of a reset with a seed has the episodes of a `RobotEnv` that is reset with seed + k. An
    episode that has ended begins anew in the next step, whose action is ignored.

    :param task: of the agent
    :param count: number of worlds
    :raises BadProperty: it is none, or too many

    :ivar envs: the environment of each world
    """

    def __init__(self, task: Task, count: int) -> None:
        self.num_envs = _COUNT(count, 'count')
        self.envs = [RobotEnv(task) for _ in range(count)]
        first = self.envs[0]
        self.metadata = {**first.metadata, 'autoreset_mode': AutoresetMode.NEXT_STEP}
        self.single_action_space = first.action_space
        self.single_observation_space = first.observation_space
        self.action_space = batch_space(first.action_space, count)
        self.observation_space = batch_space(first.observation_space, count)
        self._ended = np.zeros(count, np.bool_)

    def reset(
        self,
        *,
        seed: int | Sequence[int | None] | None = None,
        options: dict[str, Any] | None = None,
    ) -> tuple[Observation, dict[str, Any]]:
        """
        Begin an episode in each world.

        :param seed: of world k it is seed + k; or the seed of each; None is the next one of each
        :param options: none is known
        :return: the first observations, and under `seed` the seeds of the noise, (count,) int64
        :raises ValueError: there are not as many seeds as worlds
        """
        if seed is None or isinstance(seed, int):
            seed = [None if seed is None else seed + k for k in range(self.num_envs)]
        pairs = [*zip(self.envs, seed, strict=True)]
        begun = [env.reset(seed=each, options=options) for env, each in pairs]
        self._ended[:] = False
        observations, infos = zip(*begun, strict=True)
        return self._batch(observations), _infos(infos)

    def step(
        self, actions: Action
    ) -> tuple[Observation, NDArray[np.float64], _Flags, _Flags, dict[str, Any]]:
        """
        Act for a period in each world, or begin an episode where the last one has ended.

        :param actions: of all worlds
        :return: observations, rewards, whether episodes are over, whether they are cut off, and
            under `seed` the seeds of those that began, by the flags under `_seed`
        """
        each_action = iterate(self.action_space, actions)
        of_worlds = [*zip(self.envs, self._ended.tolist(), each_action, strict=True)]
        steps = [_begun(env) if ended else env.step(action) for env, ended, action in of_worlds]
        observations, rewards, overs, cuts, infos = zip(*steps, strict=True)
        over, cut = np.array(overs, np.bool_), np.array(cuts, np.bool_)
        self._ended = over | cut
        return self._batch(observations), np.array(rewards, float), over, cut, _infos(infos)

    def save(self) -> tuple[tuple[SavedEpisode, bool], ...]:
        """Return the moment of each world, and whether its episode has ended."""
        ended = self._ended.tolist()
        return tuple((env.save(), end) for env, end in zip(self.envs, ended, strict=True))

    def restore(self, saved: Sequence[tuple[SavedEpisode, bool]]) -> Observation:
        """
        Continue from saved moments; return what is observed then, of all worlds.

        :raises ValueError: they are not of as many worlds
        :raises Malformed: one is no saved episode; then no world has changed
        """
        episodes = [check_episode(episode) for episode, _ in saved]
        pairs = [*zip(self.envs, episodes, strict=True)]
        observations = [env.restore(episode) for env, episode in pairs]
        self._ended = np.array([ended for _, ended in saved])
        return self._batch(observations)

    def _batch(self, observations: Iterable[Observation]) -> Observation:
        """Return the observations of all worlds as one of `observation_space`."""
        space = self.single_observation_space
        batch = cast('Observation', create_empty_array(space, self.num_envs))
        return concatenate(space, [*observations], batch)


def _begun(env: RobotEnv) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
    """Return the first step of a new episode."""
    observation, info = env.reset()
    return observation, 0.0, False, False, info


def _infos(infos: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """Return the `info` of all worlds, as Gymnasium has it of those whose episodes began."""
    began = np.array(['seed' in info for info in infos])
    if not began.any():
        return {}
    return {'seed': np.array([info.get('seed', 0) for info in infos]), '_seed': began}
