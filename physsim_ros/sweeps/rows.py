# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Rows: the runs of a sweep in a folder, written as they come, so that a second call continues them.

Laws: a folder has the runs of one experiment. A row that was cut off is run again. The folder has
`runs.jsonl`, a JSON object a line, the first of which names the experiment; and a world file for
each run that failed, whatever other cases had its number in another call.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import fields, replace
import hashlib
from itertools import count
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
from physsim_ros.files import load_world, save_world, text_of
from physsim_ros.model.errors import BadProperty
from physsim_ros.sweeps.experiment import Case, Experiment, Run

_FILE = 'runs.jsonl'


class Rows:
    """
    The runs of an experiment in a folder.

    :param experiment: of the runs
    :param folder: which is made where it is not there
    :raises BadProperty: it has the runs of another experiment, or a file that has no runs
    """

    def __init__(self, experiment: Experiment, folder: Path) -> None:
        self._experiment = experiment
        self._folder = folder
        self._path = folder / _FILE
        folder.mkdir(parents=True, exist_ok=True)
        self._rows: dict[str, Mapping[str, Any]] = {}
        identity, rows = _line(_identity(experiment)), self._read()
        if not rows:
            self._path.write_text(identity, encoding='utf-8')
        elif rows[0] != json.loads(identity):
            template = '{path} has the runs of another experiment: {row}'
            row = _line(rows[0]).strip()
            raise BadProperty(template, field='folder', path=self._path, row=row)
        self._rows.update((row['case'], row) for row in rows[1:])
        # Names of the world files.
        self._files = {row['before'] for row in rows[1:]}

    def _read(self) -> list[dict[str, Any]]:
        """Return the rows that are whole; cut the last one off if it is not."""
        if not self._path.exists():
            return []
        data = self._path.read_bytes()
        whole = data[: data.rfind(b'\n') + 1]
        try:
            rows = [json.loads(line) for line in whole.splitlines()]
        except (ValueError, RecursionError) as error:
            template = '{path} is no file of runs'
            raise BadProperty(template, field='folder', path=self._path) from error
        if len(whole) < len(data):
            self._path.write_bytes(whole)
        return rows

    def runs_of(self, cases: Iterable[tuple[int, Case]]) -> dict[int, Run]:
        """Return the runs that the folder has of numbered cases, by number."""
        return {
            number: self._run(case, self._rows[key])
            for number, case in cases
            if (key := _key(case)) in self._rows
        }

    def _run(self, case: Case, row: Mapping[str, Any]) -> Run:
        rate, before = self._experiment.physics_rate, row['before']
        # Of the settings, a file lacks the limits.
        settings = self._experiment.world.settings
        return Run(
            case=case,
            failure=row['failure'],
            seconds=row['seconds'],
            way=np.array(row['way'], float).reshape(-1, 2),
            score=math.nan if row['score'] is None else row['score'],
            before=before
            and load_world(self._folder / before, settings=settings, physics_rate=rate),
            physics_rate=rate,
        )

    def add(self, number: int, run: Run) -> None:
        """
        Write a run.

        :param number: of its case
        :raises BadWorldFile: the world of its failure cannot be written
        """
        # The number may be that of another case in an earlier call.
        free = next(each for each in count(number) if file_name(each, run) not in self._files)
        path = save_failure(free, run, self._folder)
        self._files.add(path and path.name)
        row = {
            'case': _key(run.case),
            'failure': run.failure,
            'seconds': run.seconds,
            'score': None if math.isnan(run.score) else run.score,
            'length': run.length,
            'before': path and path.name,
            'way': run.way.tolist(),
        }
        with self._path.open('a', encoding='utf-8') as file:
            file.write(_line(row))


def save_failure(number: int, run: Run, folder: Path) -> Path | None:
    """
    Write the world of a failed run; return its path, or None where there is none.

    :param number: of its case
    :raises BadWorldFile: the file cannot be written
    """
    if run.before is None:
        return None
    name = file_name(number, run)
    return save_world(run.before, name, world_dir=folder, physics_rate=run.physics_rate)


def file_name(number: int, run: Run) -> str:
    """Return the name of the world file of a failed run, by the number of its case."""
    return f'run_{number}_seed_{run.case.seed}.yaml'


def _line(row: Mapping[str, Any]) -> str:
    return json.dumps(row, default=repr) + '\n'


def _key(case: Case) -> str:
    """Return the text of a case: its seed and its parameters."""
    return json.dumps([case.seed, dict(case.parameters)], sort_keys=True, default=repr)


def _identity(experiment: Experiment) -> dict[str, Any]:
    """Return every field of an experiment: the world to the bit, functions by their names."""
    values = {each.name: getattr(experiment, each.name) for each in fields(experiment)}
    # A digest is of a world that runs: the text of its file stands for a state.
    text = text_of(replace(experiment.world, memory=None), experiment.physics_rate)
    values['world'] = hashlib.blake2b(text.encode(), digest_size=16).hexdigest()
    return {
        name: _name_of(value) if value is None or callable(value) else value
        for name, value in values.items()
    }


def _name_of(function: object) -> str:
    name = getattr(function, '__qualname__', type(function).__qualname__)
    return '' if function is None else f'{getattr(function, "__module__", "")}.{name}'
