# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Results of a sweep: a table, a picture, and world files of the runs that failed."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from physsim_ros.appearance import picture_of
from physsim_ros.model.texts import abbreviated
from physsim_ros.simulation.simulation import Simulation
from physsim_ros.sweeps.experiment import Experiment, Run
from physsim_ros.sweeps.rows import save_failure

# Ways of runs that ended well, and of those that failed.
_WELL, _FAILED = (0.15, 0.45, 0.85, 0.35), (0.85, 0.15, 0.15, 0.8)
# Seeds of the runs of a row that failed for one reason; more are counted.
_MOST_SEEDS = 8
# Length of a reason in the table [characters].
_LONGEST_REASON = 80


def table_of_runs(runs: Iterable[Run]) -> str:
    """
    Return a table with a row for each combination of parameters.

    Its columns are the parameters, the number of runs and of failures, the mean time [s] and mean
    way [m] until failure or end, the mean score if the experiment has a score, and the reasons of
    failures with the seeds of the runs, the most frequent reason first.
    """
    groups: dict[str, list[Run]] = {}
    for run in runs:
        groups.setdefault(_text_of(run), []).append(run)
    scored = any(not np.isnan(run.score) for group in groups.values() for run in group)
    score = ['score'] if scored else []
    rows = [['parameters', 'runs', 'failed', 'time [s]', 'way [m]', *score, 'failures: seeds']]
    for text, group in groups.items():
        failed = [run for run in group if run.failure]
        row = [text, f'{len(group)}', f'{len(failed)}']
        row += [f'{np.mean([run.seconds for run in group]):.1f}']
        row += [f'{np.mean([run.length for run in group]):.2f}']
        if scored:
            row += [f'{np.mean([run.score for run in group]):.3g}']
        rows.append([*row, _failures_of(failed)])
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    lines = []
    for text, *numbers, failures in rows:
        cells = [each.rjust(width) for each, width in zip(numbers, widths[1:-1], strict=True)]
        lines.append('  '.join((text.ljust(widths[0]), *cells, failures)).rstrip())
    return '\n'.join(lines)


def _text_of(run: Run) -> str:
    return ', '.join(f'{name}={value}' for name, value in run.case.parameters.items()) or '-'


def _failures_of(failed: Iterable[Run]) -> str:
    """Return the reasons why runs failed, each with the seeds of its runs."""
    seeds: dict[str, list[str]] = {}
    for run in failed:
        reason = abbreviated(run.failure, _LONGEST_REASON)
        seeds.setdefault(reason, []).append(str(run.case.seed))
    by_count = sorted(seeds.items(), key=lambda each: -len(each[1]))
    return '; '.join(f'{reason}: {_listed(each)}' for reason, each in by_count)


def _listed(seeds: Sequence[str]) -> str:
    more = len(seeds) - _MOST_SEEDS
    return ' '.join([*seeds[:_MOST_SEEDS], f'and {more} more'] if more > 0 else seeds)


def picture_of_runs(
    experiment: Experiment, runs: Iterable[Run], width: int = 960
) -> NDArray[np.uint8]:
    """
    Return a picture of the world with the ways of all runs; failed runs are red.

    :param experiment: experiment of the runs
    :param width: width of the picture [pixels]
    :return: (height, width, 3) uint8; `PIL.Image.fromarray(picture).save('runs.png')` writes it
    """
    simulation = Simulation(physics_rate=experiment.physics_rate, publish_rate=1.0)
    simulation.begin(experiment.world)
    # The failed ones on top.
    ordered = sorted(runs, key=lambda run: bool(run.failure))
    lines = [(run.way, _FAILED if run.failure else _WELL) for run in ordered]
    # A run whose process has ended may have no way.
    ends = [(run.way[-1], _FAILED) for run in ordered if run.failure and len(run.way)]
    return picture_of(simulation.frame.snapshot, width, lines=lines, crosses=ends)


def save_failures(runs: Iterable[Run], folder: Path) -> list[Path]:
    """
    Write the world of each failed run shortly before its failure, and return the paths.

    The page opens them, as with `physsim --ros-args -p world_file:=failures/run_3_seed_3.yaml`.

    :param folder: folder of the files, created if it does not exist
    :raises BadWorldFile: a file cannot be written
    """
    saved = (save_failure(number, run, folder) for number, run in enumerate(runs))
    return [path for path in saved if path is not None]
