# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
An environment: one world, in which an agent drives a robot.

Laws: an episode depends on its seed and on the actions alone, to the bit; so does what follows a
saved episode, in this environment and in any other of the task.
"""

from __future__ import annotations

from collections.abc import Mapping
from copy import deepcopy
from dataclasses import dataclass, replace
from typing import Any, cast, SupportsFloat

from gymnasium import Env
import numpy as np
from numpy.typing import NDArray
from physsim_ros.appearance import picture_of
from physsim_ros.gym.task import Action, Observation, Task
from physsim_ros.model.checks import OfClass, OneOf
from physsim_ros.simulation.robot import Robot
from physsim_ros.simulation.simulation import SavedMoment, Simulation

# Seeds of episodes are below it; a world takes as many.
_SEEDS = 2**31
# Width of the pictures of a video [pixels].
_WIDTH = 480
_RENDER_MODE = OneOf(('rgb_array',))


@dataclass(frozen=True, slots=True, kw_only=True)
class SavedEpisode:
    """
    A moment of an episode, which can be pickled.

    :param moment: saved moment of the world
    :param steps: number of steps since the episode began
    :param random: state of the generator that draws the seeds of the next episodes
    """

    moment: SavedMoment
    steps: int
    random: Mapping[str, Any]


def check_episode(saved: object) -> SavedEpisode:
    """
    Return a saved episode.

    :raises Malformed: it is none
    """
    return cast('SavedEpisode', OfClass(SavedEpisode)(saved, 'saved'))


def _robot_of(task: Task) -> Robot:
    """
    Return the robot of a task, in a world of its own.

    :raises BadProperty: the period of the task does not divide into steps of its physics rate
    :raises UnknownBody: the robot is not in the world
    """
    simulation = Simulation(
        physics_rate=task.physics_rate,
        publish_rate=1.0 / task.period,
        history=0.0,
        # None within an episode: nobody goes back, but to a saved moment.
        checkpoints=task.longest,
    )
    simulation.begin(task.world)
    return Robot(simulation, task.robot)


class RobotEnv(Env[Observation, Action]):
    """
    One world in which an agent has a task: a Gymnasium environment.

    A copy or a pickle of an environment continues from its present moment.

    :param task: the task
    :param render_mode: with 'rgb_array', `render` returns pictures; None is no pictures
    :raises BadProperty: the render mode is unknown, or the period of the task is not a whole
        number of physics steps
    :raises UnknownBody: the robot is not in the world of the task

    :ivar task: the task
    :ivar robot: the robot that the agent drives; `robot.simulation` is its world
    """

    # Gymnasium's own name and type; an environment adds its frames a second.
    metadata = {'render_modes': [*_RENDER_MODE.words]}  # noqa: RUF012

    def __init__(self, task: Task, *, render_mode: str | None = None) -> None:
        self.task = task
        if render_mode is not None:
            _RENDER_MODE(render_mode, 'render_mode')
        self.render_mode = render_mode
        self.metadata = {**self.metadata, 'render_fps': max(1, round(1.0 / task.period))}
        self.robot = _robot_of(task)
        # Each environment samples by a generator of its own.
        self.action_space = deepcopy(task.action_space)
        self.observation_space = deepcopy(task.observed(self.robot))
        self._longest = round(task.longest / task.period)
        self._steps = 0

    def __getstate__(self) -> dict[str, Any]:
        """Return what copies and pickles are made of: the world is a saved episode, by `save`."""
        own = {name: each for name, each in self.__dict__.items() if name not in {'task', 'robot'}}
        # Generators of a shallow copy are its own, too.
        return {'task': self.task, 'robot': self.save(), **deepcopy(own)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Continue as another environment did, to the bit."""
        self.__dict__.update(state)
        self.robot = _robot_of(self.task)
        self.restore(state['robot'])

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """
        Begin an episode.

        :param seed: seed of this episode and those after it; None continues the sequence
        :param options: not used
        :return: the first observation, and a mapping with the `seed` of the episode's noise
        """
        super().reset(seed=seed, options=options)
        of_episode = int(self.np_random.integers(_SEEDS))
        world = self.task.world
        settings = replace(world.settings, seed=of_episode)
        self.robot.simulation.begin(replace(world, settings=settings))
        if self.task.begin is not None:
            self.task.begin(self.robot, np.random.default_rng(of_episode))
        self._steps = 0
        return self.task.observe(self.robot), {'seed': of_episode}

    def step(
        self, action: Action
    ) -> tuple[Observation, SupportsFloat, bool, bool, dict[str, Any]]:
        """
        Perform an action for one period of the task.

        :return: observation, reward, terminated, truncated, and an empty mapping
        """
        task, robot = self.task, self.robot
        task.act(robot, action)
        robot.simulation.run(task.period)
        self._steps += 1
        reward, is_over = float(task.reward(robot, action)), bool(task.is_over(robot))
        return task.observe(robot), reward, is_over, self._steps >= self._longest, {}

    def save(self) -> SavedEpisode:
        """
        Return this moment of the episode, for `restore`.

        This environment and all that restore the moment continue with the same bits; see
        `Simulation.checkpoint`.
        """
        return SavedEpisode(
            moment=self.robot.simulation.checkpoint(),
            steps=self._steps,
            random=self.np_random.bit_generator.state,
        )

    def restore(self, saved: SavedEpisode) -> Observation:
        """
        Continue from a saved moment, and return the observation there.

        :raises Malformed: the value is not a saved episode
        """
        check_episode(saved)
        self.robot.simulation.restore(saved.moment)
        self._steps = saved.steps
        self.np_random.bit_generator.state = saved.random
        return self.task.observe(self.robot)

    def render(self) -> NDArray[np.uint8] | None:
        """Return a picture of the world, (height, width, 3) uint8; None without a render mode."""
        if self.render_mode is None:
            return None
        return picture_of(self.robot.simulation.frame.snapshot, _WIDTH)
