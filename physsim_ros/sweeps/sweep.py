# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A sweep: all cases of an experiment, wherever they are run."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
import itertools
from typing import Any, Protocol

from physsim_ros.sweeps.experiment import Case, Experiment, Run


class Map(Protocol):
    """As `map` of Python, that of an executor of `concurrent.futures`, and others."""

    def __call__(self, run: Callable[[Case], Run], cases: Sequence[Case], /) -> Iterable[Run]:
        """Return the results of a function for each case, in the order of the cases."""


def cases_of(seeds: Iterable[int], **parameters: Sequence[Any]) -> list[Case]:
    """
    Return a case for each seed and each combination of parameters.

    :param seeds: of the noise
    :param parameters: values of each parameter, by its name
    """
    seeds = list(seeds)
    combinations: Iterable[Mapping[str, Any]] = (
        dict(zip(parameters, values, strict=True))
        for values in itertools.product(*parameters.values())
    )
    return [Case(seed=seed, parameters=each) for each in combinations for seed in seeds]


def sweep(experiment: Experiment, cases: Iterable[Case], spread: Map = map) -> list[Run]:
    """
    Run all cases, and return what came of them, in their order.

    :param experiment: that is run
    :param cases: of it, as by `cases_of`
    :param spread: `map` runs one after the other; `map` of a process pool executor on all
        processors; for those of a Dask cluster see docs/learning.md
    :raises Refusal: before the first run, as `Experiment.check`; and as `Experiment.run`
    """
    cases = list(cases)
    for case in cases:
        experiment.check(case)
    return list(spread(experiment.run, cases))
