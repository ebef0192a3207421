# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""An environment: it keeps Gymnasium's contract, and repeats episodes to the bit."""

from __future__ import annotations

from copy import copy, deepcopy
import pickle
from typing import Any
import warnings

from gymnasium.spaces import Box as BoxSpace
from gymnasium.spaces import Dict, Discrete
from gymnasium.utils.env_checker import check_env
import numpy as np
from physsim_ros import Robot, robot_spawn, Simulation
from physsim_ros.gym import RobotEnv, Task
from physsim_ros.model.errors import BadProperty, Malformed, Refusal, UnknownBody
import pytest

from .tasks import reward, task


def played(env: RobotEnv, steps: int, actions: int = 0) -> list[object]:
    """Play random actions, into the next episodes; return all that the environment tells."""
    rng, told = np.random.default_rng(actions), []
    for _ in range(steps):
        observation, reward, over, cut, info = env.step(rng.uniform(-1.0, 1.0, 2))
        told.append((observation.tolist(), reward, over, cut, info))
        if over or cut:
            observation, info = env.reset()
            told.append((observation.tolist(), info))
    return told


def observe_all(robot: Robot) -> dict[str, Any]:
    return {'pose': np.array(robot.odom().pose), 'bumped': int(robot.bumped)}


def turn_or_go(robot: Robot, action: int) -> None:
    robot.drive(*((0.2, 0.0), (0.0, 1.0), (0.0, -1.0))[action])


def rewarded_for_pose(robot: Robot, _: int) -> float:
    return robot.truth().pose[0]


def other_task() -> Task:
    return task(
        observe=observe_all,
        observation_space=Dict(
            {'pose': BoxSpace(-10.0, 10.0, (3,), np.float64), 'bumped': Discrete(2)}
        ),
        act=turn_or_go,
        action_space=Discrete(3),
        reward=rewarded_for_pose,
    )


def at_the_end_of_the_corridor(**options: Any) -> RobotEnv:
    return RobotEnv(task(begin=lambda robot, _: robot.place(0.0, 0.0, 0.0)), **options)


@pytest.mark.parametrize('make', [task, other_task])
@pytest.mark.parametrize('mode', ['rgb_array', None])
def test_an_environment_passes_the_check_of_gymnasium(make: Any, mode: str | None) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter('error')
        # Without a spec of a registry, other render modes cannot be checked, and it warns.
        check_env(RobotEnv(make(), render_mode=mode), skip_render_check=True)


def test_an_episode_is_repeated_by_its_seed_to_the_bit() -> None:
    first, second, third = (RobotEnv(task()) for _ in range(3))
    begun = [env.reset(seed=seed) for env, seed in ((first, 3), (second, 3), (third, 4))]
    assert begun[0][0].tolist() == begun[1][0].tolist() != begun[2][0].tolist()
    told = [played(env, 150) for env in (first, second, third)]
    assert told[0] == told[1] != told[2]
    # Several episodes, each with noise of its own.
    seeds = [each[1]['seed'] for each in told[0] if len(each) == 2]
    assert len(seeds) >= 2
    assert len({*seeds}) == len(seeds)
    assert first.robot.simulation.settings.seed == seeds[-1]


def test_an_episode_is_over_at_a_crash_and_cut_off_after_its_time() -> None:
    env = at_the_end_of_the_corridor()
    env.reset(seed=0)
    ends = [env.step(np.zeros(2))[2:4] for _ in range(60)]
    assert ends == [(False, False)] * 59 + [(False, True)]
    env.reset()
    # 2.8 rad/s, and then ahead: into the wall at its side after 0.4 m.
    for _ in range(6):
        env.step(np.array((0.0, 1.0)))
    for steps in range(40):  # noqa: B007 - counted
        _, reward, over, cut, _ = env.step(np.array((1.0, 0.0)))
        if over:
            break
    assert (over, cut) == (True, False)
    assert 10 < steps < 35
    assert reward < -4.0


def test_actions_beyond_the_space_are_cut_off_and_shares_are_those_of_the_drive() -> None:
    env = at_the_end_of_the_corridor()
    env.reset(seed=0)
    for _ in range(10):
        env.step(np.array((2.0, 0.0)))
    assert env.robot.truth().twist[0] == pytest.approx(0.22, rel=1e-6)
    for _ in range(5):
        env.step(np.array((0.0, -0.5)))
    assert env.robot.truth().twist[2] == pytest.approx(-1.42, rel=1e-6)


@pytest.mark.parametrize('other', [False, True])
def test_a_saved_episode_continues_to_the_bit(other: bool) -> None:
    env = RobotEnv(task())
    env.reset(seed=5)
    played(env, 17)
    saved = env.save()
    branches = [played(env, 100, actions=1)]
    if other:
        env, saved = RobotEnv(task()), pickle.loads(pickle.dumps(saved))  # noqa: S301 - its own
        # Whatever it did before.
        env.reset(seed=8)
        played(env, 5)
    for actions in (1, 2, 1):
        observation = env.restore(saved)
        assert observation in env.observation_space
        branches.append(played(env, 100, actions=actions))
    assert branches[0] == branches[1] == branches[3] != branches[2]


def pickled(env: RobotEnv) -> RobotEnv:
    copied: RobotEnv = pickle.loads(pickle.dumps(env))  # noqa: S301
    return copied


@pytest.mark.parametrize('copied', [copy, deepcopy, pickled])
def test_a_copy_of_an_environment_continues_to_the_bit_on_its_own(copied: Any) -> None:
    env = RobotEnv(task(), render_mode='rgb_array')
    env.reset(seed=5)
    env.action_space.seed(3)
    played(env, 17)
    other = copied(env)
    assert other.robot.simulation is not env.robot.simulation
    assert other.render_mode == 'rgb_array'
    told = played(env, 100, actions=1)
    assert other.action_space.sample().tolist() == env.action_space.sample().tolist()
    assert played(other, 100, actions=1) == told


def test_a_task_pickles_and_environments_of_it_have_generators_of_their_own() -> None:
    one, other = (RobotEnv(pickle.loads(pickle.dumps(task()))) for _ in range(2))  # noqa: S301
    one.action_space.seed(1)
    other.action_space.seed(1)
    assert one.action_space.sample().tolist() == other.action_space.sample().tolist()
    assert one.observation_space == other.observation_space
    assert one.observation_space.shape == (36,)


def test_an_observed_scan_is_shares_of_the_range() -> None:
    env = at_the_end_of_the_corridor()
    observation, _ = env.reset(seed=2)
    assert observation.dtype == np.float32
    # 3.5 m ahead is nothing; 0.475 m to the left is the wall, with noise of 1 cm.
    assert observation[0] == 1.0
    assert observation[9] == pytest.approx(0.475 / 3.5, abs=0.02)


def test_a_picture_shows_the_robot_where_it_is() -> None:
    env = at_the_end_of_the_corridor(render_mode='rgb_array')
    env.reset(seed=0)
    first = env.render()
    assert first is not None
    assert first.dtype == np.uint8
    assert first.shape[1:] == (480, 3)
    env.robot.place(2.0, 0.0, 0.0)
    second = env.render()
    assert second is not None
    # Columns that differ are those of the two places: bounds from -1 to 6 m with a margin of 4 %.
    columns = np.flatnonzero((first != second).any(axis=(0, 2)))
    scale = 480 / (7.0 * 1.08)
    for at in (1.28, 3.28):
        near = columns[np.abs(columns - at * scale) < 20]
        assert near.mean() == pytest.approx(at * scale, abs=1.5)
    assert RobotEnv(task()).render() is None


def test_what_does_not_fit_is_refused() -> None:
    with pytest.raises(BadProperty, match='does not divide'):
        RobotEnv(task(period=0.033))
    with pytest.raises(BadProperty, match='render_mode must be one of rgb_array'):
        RobotEnv(task(), render_mode='human')
    for times in ({'period': 0.0}, {'longest': float('inf')}, {'longest': -1.0}):
        with pytest.raises(Refusal, match=next(iter(times))):
            task(**times)
    with pytest.raises(UnknownBody, match='robots: robot/0'):
        RobotEnv(task(robot='robot/1'))
    with pytest.raises(BadProperty, match='not a robot'):
        RobotEnv(task(robot='wall/0'))
    blind = Simulation()
    blind.perform(robot_spawn('mouse'))
    with pytest.raises(BadProperty, match='no laser'):
        RobotEnv(Task(world=blind.save(), reward=reward))


def test_what_is_no_saved_episode_is_refused() -> None:
    env = RobotEnv(task())
    env.reset(seed=1)
    before = env.robot.truth()
    with pytest.raises(Malformed, match='saved must be of class SavedEpisode, not None'):
        env.restore(None)  # type: ignore[arg-type]
    assert env.robot.truth() == before
