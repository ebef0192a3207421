# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Tests that need other processes find these, and nobody else."""

from __future__ import annotations

from contextlib import ExitStack
from pathlib import Path
import subprocess
import sys

from physsim_ros.testing.domain import DOMAINS, own_domain
import pytest

from .outside import installed_program, Outside, ROOT


def test_programs_are_those_that_colcon_installed_before_those_of_pip(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    program = tmp_path / 'overlay' / 'lib' / 'physsim_ros' / 'physsim'
    program.parent.mkdir(parents=True)
    program.touch(mode=0o755)
    monkeypatch.setenv('AMENT_PREFIX_PATH', f'/opt/ros/nothing:{tmp_path / "overlay"}')
    assert installed_program('physsim') == str(program)
    monkeypatch.delenv('AMENT_PREFIX_PATH')
    assert installed_program('physsim') != str(program)
    beside = Path(sys.executable).name
    assert installed_program(beside) == str(Path(sys.executable))


def test_domains_are_given_to_one_at_a_time() -> None:
    with own_domain() as one, own_domain() as other:
        assert one != other
        assert {one, other} <= set(DOMAINS)
    # In another process too.
    with own_domain() as mine:
        program = (
            'from physsim_ros.testing.domain import own_domain\nwith own_domain() as it: print(it)'
        )
        command = [sys.executable, '-c', program]
        other = int(subprocess.check_output(command, text=True, cwd=ROOT))
        assert other != mine


def test_a_domain_comes_back() -> None:
    given = []
    for _ in range(150):
        with own_domain() as domain:
            given.append(domain)
    assert len(set(given)) < len(given)


@pytest.mark.slow
def test_programs_of_two_tests_on_one_domain_do_not_meet(tmp_path: Path) -> None:
    with own_domain() as domain, ExitStack() as closing:
        tests = []
        for name in ('one', 'other'):
            directory = tmp_path / name
            directory.mkdir()
            tests.append(Outside(directory, domain, closing))
            tests[-1].start_world().wait_for('ready')
        for test, name in zip(tests, ('mine', 'theirs'), strict=True):
            assert test.run_program('spawner', name)['names'] == [f'{name}/0']
