# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Sweeps: one controller in many worlds, by seeds and parameters, on as many processors as there are.

An experiment runs a case; `sweep` runs all, by the `map` of an executor, of a cluster, or of
Python. Not here: how they are spread, which `concurrent.futures` and Dask do. Start with
`experiment`. docs/learning.md has an example.
"""

from physsim_ros.sweeps.experiment import Case, cases_of, Experiment, Run, sweep
from physsim_ros.sweeps.report import picture_of_runs, save_failures, table_of_runs

__all__ = [
    'Case',
    'Experiment',
    'Run',
    'cases_of',
    'picture_of_runs',
    'save_failures',
    'sweep',
    'table_of_runs',
]
