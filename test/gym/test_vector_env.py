# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Many worlds in one process: each has the episodes that it would have alone."""

from __future__ import annotations

from copy import copy, deepcopy
import pickle
from typing import Any

import gymnasium
from gymnasium.vector import AutoresetMode, SyncVectorEnv
import numpy as np
from physsim_ros.gym import RobotEnv, RobotVectorEnv
from physsim_ros.model.errors import BadProperty, Malformed
import pytest

from .tasks import task

COUNT, STEPS = 3, 90


def actions(step: int) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    return np.random.default_rng(step).uniform((0.5, -0.5), (1.0, 1.0), (COUNT, 2))


def test_each_world_has_the_episodes_of_an_environment_of_its_seed() -> None:
    many, alone = RobotVectorEnv(task(), COUNT), [RobotEnv(task()) for _ in range(COUNT)]
    observed, _ = many.reset(seed=7)
    for number, env in enumerate(alone):
        assert env.reset(seed=7 + number)[0].tolist() == observed[number].tolist()
    ended, crashes = [False] * COUNT, 0
    for step in range(STEPS):
        observed, rewards, overs, cuts, _ = many.step(actions(step))
        for number, env in enumerate(alone):
            if ended[number]:
                observation, _ = env.reset()
                reward, over, cut = 0.0, False, False
            else:
                observation, reward, over, cut, _ = env.step(actions(step)[number])
            assert observed[number].tolist() == observation.tolist()
            assert (rewards[number], overs[number], cuts[number]) == (reward, over, cut)
            ended[number] = over or cut
            crashes += over
    assert crashes >= 1


def test_saved_worlds_continue_to_the_bit_ended_ones_too() -> None:
    many = RobotVectorEnv(task(longest=2.0), COUNT)
    many.reset(seed=1)
    for step in range(20):
        _, _, _, cuts, _ = many.step(actions(step))
    assert cuts.any()
    saved = many.save()
    told = []
    for _ in range(2):
        observed = many.restore(saved)
        assert observed.shape == (COUNT, 36)
        told.append(
            [tuple(each.tolist() for each in many.step(actions(step))[:4]) for step in range(45)]
        )
    assert told[0] == told[1]
    steps = [env.robot.simulation.step for env in many.envs]
    with pytest.raises(ValueError, match='zip'):
        many.restore(saved[:-1])
    with pytest.raises(ValueError, match='num_envs'):
        many.reset(seed=[1])
    assert [env.robot.simulation.step for env in many.envs] == steps
    with pytest.raises(Malformed, match='saved must be of class SavedEpisode, not None'):
        many.restore([*saved[:-1], (None, False)])


def pickled(many: RobotVectorEnv) -> RobotVectorEnv:
    copied: RobotVectorEnv = pickle.loads(pickle.dumps(many))  # noqa: S301 - its own
    return copied


@pytest.mark.parametrize('copied', [copy, deepcopy, pickled])
def test_a_copy_has_worlds_of_its_own_which_continue_to_the_bit(copied: Any) -> None:
    many = RobotVectorEnv(task(longest=0.5), COUNT)
    many.reset(seed=1)
    for step in range(4):
        many.step(actions(step))
    other = copied(many)
    told = [
        [tuple(each.tolist() for each in vector.step(actions(step))[:4]) for step in range(5, 9)]
        for vector in (many, other)
    ]
    assert told[0] == told[1]


def test_worlds_tell_the_seeds_of_the_episodes_that_begin() -> None:
    many = RobotVectorEnv(task(longest=0.2, begin=None), COUNT)
    _, infos = many.reset(seed=[1, 2, 1])
    first = infos['seed'].tolist()
    assert first[0] == first[2] != first[1]
    told = [many.step(actions(step))[3:] for step in range(3)]
    assert [cuts.tolist() for cuts, _ in told] == [[False] * 3, [True] * 3, [False] * 3]
    assert [{*infos} for _, infos in told] == [set(), set(), {'seed', '_seed'}]
    assert told[2][1]['_seed'].all()
    assert many.metadata['autoreset_mode'].name == 'NEXT_STEP'


@pytest.mark.parametrize('count', [0, -1, 2.5, 10**9])
def test_a_number_of_worlds_that_cannot_be_is_refused(count: int) -> None:
    with pytest.raises(BadProperty, match='num_envs'):
        RobotVectorEnv(task(), count)


@pytest.mark.parametrize('mode', AutoresetMode)
def test_each_autoreset_mode_is_that_of_gymnasium(mode: AutoresetMode) -> None:
    short = task(longest=0.3)
    mine = RobotVectorEnv(short, COUNT, autoreset_mode=mode)
    other = SyncVectorEnv([lambda: RobotEnv(short)] * COUNT, autoreset_mode=mode)
    told: list[list[object]] = [[], []]
    for vector, tells in zip((mine, other), told, strict=True):
        assert vector.metadata['autoreset_mode'] == mode
        tells.append(repr(vector.reset(seed=5)))
        for step in range(7):
            *results, infos = vector.step(actions(step))
            tells.append(repr((results, infos)))
            over = results[2] | results[3]
            if mode is AutoresetMode.DISABLED and over.any():
                tells.append(repr(vector.reset(options={'reset_mask': over})))
    assert told[0] == told[1]


def test_a_mask_resets_its_worlds_alone_and_stays_in_the_options_of_the_caller() -> None:
    many = RobotVectorEnv(task(), COUNT, autoreset_mode='Disabled')
    many.reset(seed=1)
    before, *_ = many.step(actions(0))
    steps = [env.robot.simulation.step for env in many.envs]
    options = {'reset_mask': np.array([False, True, False])}
    for _ in range(2):
        after, infos = many.reset(seed=[None, 9, None], options=options)
        assert [env.robot.simulation.step for env in many.envs] == [steps[0], 0, steps[2]]
        assert after[[0, 2]].tolist() == before[[0, 2]].tolist()
        assert after[1].tolist() == RobotEnv(task()).reset(seed=9)[0].tolist()
        assert infos['_seed'].tolist() == [False, True, False]
    saved = many.save()
    other = RobotVectorEnv(task(), COUNT, autoreset_mode='Disabled')
    other.restore(saved)
    for vector in (many, other):
        told, _ = vector.reset(seed=3, options={'reset_mask': np.array([True, False, False])})
        assert told[1].tolist() == after[1].tolist()
    with pytest.raises(TypeError, match='reset_mask'):
        many.reset(options={'reset_mask': [True] * COUNT})


def test_worlds_are_made_by_the_registry_of_gymnasium_and_seen() -> None:
    name = 'physsim_test/Corridor-v0'
    gymnasium.register(
        name, RobotEnv, vector_entry_point=RobotVectorEnv, kwargs={'task': task(longest=0.5)}
    )
    try:
        alone = gymnasium.make(name, render_mode='rgb_array')
        assert alone.reset(seed=2)[0].shape == (36,)
        for mode, kind in (('vector_entry_point', RobotVectorEnv), ('sync', SyncVectorEnv)):
            many = gymnasium.make_vec(
                name, num_envs=2, vectorization_mode=mode, render_mode='rgb_array'
            )
            assert isinstance(many.unwrapped, kind)
            assert (many.num_envs, many.render_mode) == (2, 'rgb_array')
            observed, _ = many.reset(seed=2)
            assert observed.shape == (2, 36)
            assert [picture.shape[2] for picture in many.render()] == [3, 3]
            assert many.get_attr('np_random_seed') == (2, 3)
            many.close()
    finally:
        del gymnasium.registry[name]
