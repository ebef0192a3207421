# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Sweeps: one controller in many worlds, by seeds and parameters, in as many processes as asked for.

An experiment runs a case; `sweep` runs all, each in a process of its own, on this machine or by
the `map` of an executor or a cluster. Not here: how cases are spread over other machines, which
Dask does. Start with `experiment`. docs/learning.md has an example.
"""

from physsim_ros.sweeps.experiment import Case, Experiment, Run
from physsim_ros.sweeps.report import picture_of_runs, save_failures, table_of_runs
from physsim_ros.sweeps.sweep import cases_of, runs_of, sweep

__all__ = [
    'Case',
    'Experiment',
    'Run',
    'cases_of',
    'picture_of_runs',
    'runs_of',
    'save_failures',
    'sweep',
    'table_of_runs',
]
