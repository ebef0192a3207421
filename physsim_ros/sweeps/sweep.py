# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
A sweep: all cases of an experiment, in as many processes at once as are asked for.

Law: each run is in a process of its own, so that no run ends another one, or the sweep; its result
is there as soon as it has ended.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
import itertools
from pathlib import Path
from typing import Any, Protocol

from physsim_ros.model.checks import Whole
from physsim_ros.sweeps.experiment import Case, Experiment, Run
from physsim_ros.sweeps.processes import run_apart
from physsim_ros.sweeps.rows import Rows

_PROCESSES = Whole(1, 10_000)
_Numbered = tuple[int, Case]
_Ended = tuple[int, Run]


class Map(Protocol):
    """As `map` of an executor of `concurrent.futures`; results may come in any order."""

    def __call__(
        self, run: Callable[[_Numbered], _Ended], cases: Sequence[_Numbered], /
    ) -> Iterable[_Ended]:
        """Return the results of a function for each case."""


class _RunApart:
    """
    Runs a case of an experiment in a process of its own; it pickles.

    Dask 2026.8 hashes the arguments of a `partial`, and refuses those of a world.

    :param experiment: of the case
    """

    def __init__(self, experiment: Experiment) -> None:
        self._experiment = experiment

    def __call__(self, case: _Numbered) -> _Ended:
        return next(run_apart(self._experiment, [case]))


def cases_of(seeds: Iterable[int], **parameters: Sequence[Any]) -> list[Case]:
    """
    Return a case for each seed and each combination of parameters.

    >>> [(case.seed, case.parameters) for case in cases_of(seeds=[0, 1], gain=[2.0])]
    [(0, {'gain': 2.0}), (1, {'gain': 2.0})]

    :param seeds: seeds of the noise
    :param parameters: values of each parameter, by its name
    """
    seeds = list(seeds)
    combinations: Iterable[Mapping[str, Any]] = (
        dict(zip(parameters, values, strict=True))
        for values in itertools.product(*parameters.values())
    )
    return [Case(seed=seed, parameters=each) for each in combinations for seed in seeds]


def runs_of(
    experiment: Experiment,
    cases: Iterable[Case],
    spread: Map | None = None,
    *,
    processes: int = 1,
    folder: Path | None = None,
) -> Iterator[tuple[int, Run]]:
    """
    Run all cases, and yield the number and the run of each case as soon as it ends.

    :param experiment: the experiment
    :param cases: its cases, as `cases_of` returns them
    :param spread: runs the cases elsewhere, such as on a Dask cluster; None is this machine
    :param processes: greatest number of processes at once on this machine
    :param folder: folder in which runs and worlds of failures are written; runs that it already
        has are yielded first, and not run again. None writes nothing
    :raises Refusal: before the first run, as `Experiment.check`; the number of processes is out of
        range; the folder has the runs of another experiment; also as `Experiment.run`
    """
    numbered = [*enumerate(cases)]
    for _, case in numbered:
        experiment.check(case)
    _PROCESSES(processes, 'processes')
    rows = None if folder is None else Rows(experiment, folder)
    return _runs_of(experiment, numbered, spread, processes, rows)


def _runs_of(
    experiment: Experiment,
    cases: list[_Numbered],
    spread: Map | None,
    processes: int,
    rows: Rows | None,
) -> Iterator[_Ended]:
    done = {} if rows is None else rows.runs_of(cases)
    yield from done.items()
    left = [(number, case) for number, case in cases if number not in done]
    if spread is None:
        ended: Iterable[_Ended] = run_apart(experiment, left, processes)
    else:
        ended = spread(_RunApart(experiment), left)
    for number, run in ended:
        if rows is not None:
            rows.add(number, run)
        yield number, run


def sweep(
    experiment: Experiment,
    cases: Iterable[Case],
    spread: Map | None = None,
    *,
    processes: int = 1,
    folder: Path | None = None,
) -> list[Run]:
    """
    Run all cases, and return their runs in the order of the cases.

    Parameters and refusals are those of `runs_of`.
    """
    ended = dict(runs_of(experiment, cases, spread, processes=processes, folder=folder))
    return [ended[number] for number in sorted(ended)]
