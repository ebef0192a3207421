# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Sweeps: the same runs in whatever process, what is told of them, and worlds to look at."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import fields, replace
import gc
import multiprocessing
import os
from pathlib import Path
import threading
from typing import Any

import numpy as np
from physsim_ros import load_world, Robot, robot_spawn, Simulation
from physsim_ros.model.checkpoint import WorldState
from physsim_ros.model.errors import Refusal, UnknownBody
from physsim_ros.sweeps import (
    Case,
    cases_of,
    Experiment,
    picture_of_runs,
    Run,
    runs_of,
    save_failures,
    sweep,
    table_of_runs,
)
import pytest

from .followers import experiment, Fated, stumbling, way_right

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


def test_processes_have_the_same_runs_to_the_bit() -> None:
    brief = experiment(seconds=8.0)
    runs = [brief.run(case) for case in CASES]

    assert {bool(run.failure) for run in runs} == {False, True}
    assert told(sweep(brief, CASES, processes=3)) == told(runs)
    with ProcessPoolExecutor(2, multiprocessing.get_context('fork')) as pool:
        assert told(sweep(brief, CASES, pool.map)) == told(runs)


@pytest.mark.slow
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

        def spread(run: Callable[[Any], Any], cases: Any) -> Any:
            futures = client.map(run, cases)
            return (future.result() for future in distributed.as_completed(futures))

        assert told(sweep(experiment(), CASES, spread)) == told(runs)
        fated = experiment(controller=Fated, seconds=1.5, cpu_limit=1.0)
        cases = cases_of(range(1), fate=('kill', 'exit', ''))
        failures = [run.failure for run in sweep(fated, cases, spread)]
        assert failures[0] == 'killed by SIGKILL'
        assert failures[1].startswith('SystemExit: 3')
        assert failures[2] == ''


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
    # A process that ended twice has left no way.
    assert reds([replace(runs[0], way=np.empty((0, 2))), *runs[4:]]) == 0


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


FAILURES = {
    'exit': 'SystemExit: 3 (_exit, line ',
    'raise': 'ValueError: boom (_raise, line ',
    'kill': 'killed by SIGKILL',
    'end at once': 'its process ended with exit code 4',
    'hang': 'took more than 1 s of CPU time',
    '': '',
}


@pytest.mark.parametrize('fate', FAILURES)
def test_the_end_of_a_process_is_the_failure_of_its_run_with_the_world_before(fate: str) -> None:
    fated = experiment(controller=Fated, seconds=1.5, cpu_limit=1.0)
    well, ended, after = sweep(fated, cases_of(range(1), fate=('', fate, '')))
    assert ended.failure.startswith(FAILURES[fate])
    assert well.failure == after.failure == ''
    if not fate:
        return
    # The tenth call does not return; the world is that of 0.4 s before.
    assert ended.seconds == pytest.approx(0.9)
    assert np.array_equal(ended.way, well.way[:10])
    assert ended.before is not None
    simulation = Simulation(publish_rate=10.0)
    simulation.begin(ended.before)
    pose = Robot(simulation, 'robot/0').truth().pose
    assert pose[:2] == pytest.approx(well.way[5], abs=1e-12)


def test_a_run_that_waits_for_ever_is_ended_at_its_wall_limit() -> None:
    (well,) = sweep(experiment(controller=Fated, seconds=1.5), cases_of(range(1), fate=('',)))
    sleeping = experiment(controller=Fated, seconds=1.5, wall_limit=0.5)
    (ended,) = sweep(sleeping, cases_of(range(1), fate=('sleep',)))
    assert ended.failure == 'took more than 0.5 s'
    # On a busy machine the limit comes before the tenth call, which does not return.
    count = len(ended.way)
    assert count <= 10
    assert np.array_equal(ended.way, well.way[:count])


def test_a_controller_that_ends_its_process_as_it_is_made_leaves_the_world_of_the_beginning() -> (
    None
):
    fated = experiment(controller=Fated, seconds=0.5)
    (run,) = sweep(fated, cases_of(range(1), fate=('kill',), calls=(0,)))
    assert run.failure == 'killed by SIGKILL'
    assert run.seconds == 0.0
    assert run.before is not None


def test_no_run_frees_the_garbage_of_the_process_that_began_it() -> None:
    class Garbage:
        """A cycle of references, as a node of ROS that was destroyed; its end tells where."""

        def __init__(self) -> None:
            self.itself = self

        def __del__(self) -> None:
            if os.getpid() != parent:
                os._exit(5)

    class Collects(Fated):
        """Has its garbage collected."""

        def __call__(self, robot: Robot) -> None:
            gc.collect()
            super().__call__(robot)

    parent = os.getpid()
    gc.disable()
    try:
        Garbage()
        (run,) = sweep(
            experiment(controller=Collects, seconds=0.3), cases_of(range(1), fate=('',))
        )
    finally:
        gc.enable()
    assert run.failure == ''


def test_what_a_controller_starts_ends_with_its_run() -> None:
    class Starts(Fated):
        """Starts a process that does not end by itself."""

        def __call__(self, robot: Robot) -> None:
            if os.fork() == 0:
                threading.Event().wait()
            super().__call__(robot)

    starting = experiment(controller=Starts, seconds=0.3)
    (run,) = sweep(starting, cases_of(range(1), fate=('',)))
    assert run.failure == ''


def test_many_runs_outlive_the_deaths_of_every_third_and_are_told_as_they_end(
    tmp_path: Path,
) -> None:
    fated = experiment(controller=Fated, begin=None, seconds=0.2)
    cases = cases_of(range(24), fate=('',), calls=(1,))
    cases = [
        replace(case, parameters={**case.parameters, 'fate': ('', 'kill', 'exit')[case.seed % 3]})
        for case in cases
    ]
    first = runs_of(fated, cases, processes=4, folder=tmp_path)
    some = [next(first) for _ in range(8)]
    first.close()
    ended = sweep(fated, cases, processes=4, folder=tmp_path)
    assert [bool(run.failure) for run in ended] == [case.seed % 3 > 0 for case in cases]
    assert [run.case for run in ended] == cases
    assert told([run for _, run in some]) == told([ended[number] for number, _ in some])
    assert len((tmp_path / 'runs.jsonl').read_text().splitlines()) == 25


def test_a_second_call_continues_a_folder_with_the_same_runs(tmp_path: Path) -> None:
    scored = experiment(score=way_right, seconds=4.0)
    runs = sweep(scored, CASES)
    sweep(scored, CASES[2:5], folder=tmp_path)
    path = tmp_path / 'runs.jsonl'
    # A line that was cut off as its writer was killed.
    path.write_bytes(path.read_bytes()[:-20])
    started: list[int] = []

    def spread(run: Callable[[Any], Any], cases: Any) -> Any:
        started.extend(number for number, _ in cases)
        return map(run, cases)

    again = sweep(scored, CASES, spread, folder=tmp_path)
    assert started == [0, 1, 4, 5, 6, 7]
    assert told(again[:2]) == told(runs[:2])
    assert [run.score for run in again] == [run.score for run in runs]
    assert [run.way.tolist() for run in again] == [run.way.tolist() for run in runs]
    assert [run.failure for run in again] == [run.failure for run in runs]
    for kept, run in zip(again, runs, strict=True):
        assert (kept.before is None) == (run.before is None)
    sweep(scored, CASES, never_spread, folder=tmp_path)


@pytest.mark.parametrize('name', [each.name for each in fields(Experiment)])
def test_an_experiment_that_differs_in_any_field_is_another_one(tmp_path: Path, name: str) -> None:
    one = experiment()
    match getattr(one, name):
        case float() as number:
            other: Any = 2.0 * number
        case str() as text:
            other = f'{text}0'
        case WorldState() as world:
            other = replace(world, settings=replace(world.settings, gravity=(0.0, 1.0)))
        case _:
            other = never_spread
    sweep(one, [], folder=tmp_path)

    sweep(one, [], folder=tmp_path)
    with pytest.raises(Refusal, match='another experiment') as caught:
        sweep(replace(one, **{name: other}), [], folder=tmp_path)
    assert caught.value.field == 'folder'


def never_spread(_: object, cases: Any) -> Any:
    assert not cases
    return ()


def test_a_folder_keeps_the_worlds_of_cases_that_had_the_same_number(tmp_path: Path) -> None:
    failing = experiment(begin=None, controller=Fated)
    first, second = (cases_of([0], fate=['raise'], calls=[calls]) for calls in (8, 16))
    runs = {str(cases): sweep(failing, cases, folder=tmp_path) for cases in (first, second)}

    for cases in (first, second):
        (again,), (run,) = sweep(failing, cases, never_spread, folder=tmp_path), runs[str(cases)]
        assert run.before is not None
        assert again.before == run.before


@pytest.mark.parametrize(
    'said', [{'drive': {'latency': 0.1}}, {'sensors': {'scan': {'blind': [[0, 1]]}}},
             {'battery': {'level': 0.5}}, {'command_topic': 'drive'}],
)  # fmt: skip
def test_a_folder_has_the_runs_of_one_world(tmp_path: Path, said: dict[str, Any]) -> None:
    worlds = []
    for changes in ({}, said):
        simulation = Simulation()
        simulation.perform(robot_spawn({'from': 'turtlebot3_burger', **changes}))
        worlds.append(simulation.save())
    sweep(replace(experiment(), world=worlds[0]), [], folder=tmp_path)

    with pytest.raises(Refusal) as caught:
        sweep(replace(experiment(), world=worlds[1]), [], folder=tmp_path)
    assert caught.value.field == 'folder'


def test_the_world_of_a_run_is_read_again_with_its_limits(tmp_path: Path) -> None:
    usual = experiment(controller=stumbling)
    limits = replace(usual.world.settings, max_bodies=50)
    limited = replace(usual, world=replace(usual.world, settings=limits))
    (run,) = sweep(limited, [Case()], folder=tmp_path)

    (again,) = sweep(limited, [Case()], never_spread, folder=tmp_path)

    assert run.before is not None
    assert again.before == run.before


def test_a_run_fails_beside_robots_without_a_drive() -> None:
    simulation = Simulation()
    simulation.begin(experiment().world)
    simulation.perform(robot_spawn('arm', name='arm/0', at=(2.0, 0.0)))

    beside = replace(experiment(controller=stumbling), world=simulation.save())
    (run,) = sweep(beside, [Case()])

    assert run.failure.startswith('ZeroDivisionError: no idea what to do')
    assert run.before is not None


def test_a_run_that_would_not_call_its_controller_is_refused() -> None:
    with pytest.raises(Refusal) as caught:
        experiment(seconds=0.05, period=0.1)
    assert caught.value.field == 'seconds'
    (run,) = sweep(experiment(seconds=0.1, period=0.1), [Case(parameters={'gain': 1.0})])
    assert run.seconds == pytest.approx(0.1)


def test_a_failure_is_told_in_one_line() -> None:
    def control(_: Robot) -> None:
        raise ValueError('one\n  two')

    run = experiment(controller=lambda: control).run(Case())

    assert run.failure.startswith('ValueError: one two (control, line ')


def test_a_folder_with_something_else_is_refused(tmp_path: Path) -> None:
    (tmp_path / 'runs.jsonl').write_text('seed,failure\n')
    with pytest.raises(Refusal, match='no file of runs'):
        sweep(experiment(), [], folder=tmp_path)


def test_a_refusal_of_a_run_is_raised_where_the_sweep_is() -> None:
    with pytest.raises(UnknownBody):
        sweep(experiment(robot='robot/7'), [Case(parameters={'gain': 1.0})])


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
