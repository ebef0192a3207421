# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sweeps: the same runs in whatever process, what is told of them, and worlds to look at."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
import multiprocessing
from pathlib import Path
from typing import Any

import numpy as np
from physsim_ros import load_world, Robot, Simulation
from physsim_ros.model.errors import Refusal, UnknownBody
from physsim_ros.sweeps import (
    Case,
    cases_of,
    Experiment,
    picture_of_runs,
    Run,
    save_failures,
    sweep,
    table_of_runs,
)
import pytest

from .followers import experiment, stumbling, way_right

ROOT = Path(__file__).parents[2]
CASES = cases_of(range(4), gain=(0.0, 8.0))


def told(runs: list[Run]) -> list[object]:
    return [
        (
            run.case.seed,
            run.case.parameters,
            run.failure,
            run.seconds,
            run.way.tolist(),
            run.before,
        )
        for run in runs
    ]


@pytest.fixture(scope='module')
def runs() -> list[Run]:
    return sweep(experiment(score=way_right), CASES)


def test_a_controller_without_gain_crashes_and_one_with_it_does_not(runs: list[Run]) -> None:
    assert [run.failure for run in runs] == ['crashed'] * 4 + [''] * 4
    assert all(run.seconds == pytest.approx(20.0) for run in runs[4:])
    assert all(run.seconds < 20.0 for run in runs[:4])
    assert [run.before is None for run in runs] == [False] * 4 + [True] * 4
    # 0.2 m/s; it turns on the spot at the corner.
    assert all(3.0 < run.length < 4.0 for run in runs[4:])
    # Each seed begins elsewhere.
    assert len({tuple(run.way[0]) for run in runs}) == 4


def test_processes_have_the_same_runs_to_the_bit(runs: list[Run]) -> None:
    with ProcessPoolExecutor(2, multiprocessing.get_context('fork')) as pool:
        assert told(sweep(experiment(), CASES, pool.map)) == told(runs)


def test_a_cluster_has_the_same_runs_to_the_bit(
    runs: list[Run], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    distributed = pytest.importorskip('distributed')
    monkeypatch.setenv('PYTHONPATH', str(ROOT))
    with (
        distributed.LocalCluster(
            n_workers=2,
            threads_per_worker=1,
            dashboard_address=None,
            local_directory=tmp_path,
        ) as cluster,
        distributed.Client(cluster) as client,
    ):

        def spread(run: Callable[[Case], Run], cases: Any) -> Any:
            return client.gather(client.map(run, cases))

        assert told(sweep(experiment(), CASES, spread)) == told(runs)


def test_a_table_tells_who_crashed_and_why(runs: list[Run]) -> None:
    table = table_of_runs(runs).splitlines()
    assert table[0].split() == [
        'parameters', 'runs', 'failed', 'time', '[s]', 'way', '[m]', 'score', 'failures:', 'seeds'
    ]  # fmt: skip
    assert table[1].split()[:3] == ['gain=0.0', '4', '4']
    assert table[1].endswith('  crashed: 0 1 2 3')
    assert table[2].split()[:4] == ['gain=8.0', '4', '0', '20.0']
    assert len(table) == 3
    many = table_of_runs(runs[:4] * 3).splitlines()
    assert many[1].endswith('crashed: 0 1 2 3 0 1 2 3 and 4 more')


def test_a_table_names_the_most_frequent_reason_first_and_no_reason_at_length(
    runs: list[Run],
) -> None:
    lost, long = replace(runs[0], failure='lost'), replace(runs[1], failure='x' * 1000)
    table = table_of_runs([lost, long, *runs[2:4]]).splitlines()
    crashed, other, last = table[1].rpartition('  ')[2].split('; ')
    assert (crashed, other) == ('crashed: 2 3', 'lost: 0')
    assert last.startswith('xxxx')
    assert len(last) < 100


def test_a_picture_has_the_ways_red_where_they_failed(runs: list[Run]) -> None:
    def reds(some: list[Run]) -> int:
        red, green, _ = picture_of_runs(experiment(), some, 480).astype(int).transpose(2, 0, 1)
        return int((red > green + 60).sum())

    assert reds(runs[4:]) == 0
    # Half a metre at 63 pixels a metre, and a cross, each.
    assert reds(runs[:4]) > 4 * 30


def test_a_failed_run_opens_at_the_moment_before_and_fails_again(
    runs: list[Run], tmp_path: Path
) -> None:
    paths = save_failures(runs, tmp_path / 'failures')
    assert [path.name for path in paths] == [f'run_{seed}_seed_{seed}.yaml' for seed in range(4)]
    for path, run in zip(paths, runs, strict=False):
        simulation = Simulation(publish_rate=10.0)
        simulation.begin(load_world(path))
        robot = Robot(simulation, 'robot/0')
        assert not robot.bumped
        x, y = robot.truth().pose[:2]
        assert np.hypot(x - run.way[-5, 0], y - run.way[-5, 1]) < 1e-9
        simulation.run(0.2)
        assert not robot.bumped
        simulation.run(0.2)
        # By the command that it was given last.
        assert robot.bumped


def test_an_error_of_a_controller_is_the_failure_of_its_run_alone() -> None:
    failed, other = sweep(experiment(controller=stumbling, before=1.0), [Case(), Case(seed=1)])
    assert failed.failure.startswith('ZeroDivisionError: no idea what to do (control, line ')
    assert failed.seconds == other.seconds == 1.0
    assert failed.before is not None
    assert np.isnan(failed.score)
    assert 'score' not in table_of_runs([failed, other])


def test_cases_are_all_combinations_of_parameters_each_with_all_seeds() -> None:
    cases = cases_of((5, 6), gain=(1, 2), name=('a', 'b', 'c'))
    assert len(cases) == 12
    assert cases[:2] == [Case(seed=seed, parameters={'gain': 1, 'name': 'a'}) for seed in (5, 6)]
    assert cases[-1] == Case(seed=6, parameters={'gain': 2, 'name': 'c'})
    assert cases_of(range(2)) == [Case(seed=0), Case(seed=1)]


def test_an_experiment_that_cannot_be_is_refused() -> None:
    with pytest.raises(UnknownBody):
        experiment(robot='robot/7').run(Case(parameters={'gain': 1.0}))
    for times in ({'period': 0.0}, {'seconds': float('nan')}, {'before': -1.0}):
        with pytest.raises(Refusal, match=next(iter(times))):
            experiment(**times)
    without = experiment()
    with pytest.raises(TypeError, match='world'):
        Experiment(controller=without.controller)  # type: ignore[call-arg]


@pytest.mark.parametrize(
    ('parameters', 'code', 'told'),
    [
        ({'gian': [1.0]}, 'unknown_property', "no parameter 'gian'; nearest is 'gain'"),
        ({'gain': [1.0], 'x': [1]}, 'unknown_property', "no parameter 'x'; it has gain"),
        ({}, 'bad_property', 'the controller needs the parameter gain'),
    ],
)
def test_a_parameter_that_the_controller_does_not_have_is_refused_before_the_first_run(
    parameters: dict[str, Any], code: str, told: str
) -> None:
    def never(*_: object) -> Any:
        pytest.fail('a case was run')

    with pytest.raises(Refusal, match=told) as caught:
        sweep(experiment(), [Case(parameters={'gain': 1.0}), *cases_of((1,), **parameters)], never)
    assert caught.value.code == code
