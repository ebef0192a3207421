# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The package for Python without ROS: its names, and the page that shows them, which runs."""

from __future__ import annotations

import ast
import doctest
import importlib
import re

import physsim_ros
import pytest

from .outside import ROOT, run_python
from .source_tree import blocks_of

PAGE = (ROOT / 'docs' / 'python.md').read_text(encoding='utf-8')
# Says which libraries a program has imported.
IMPORTED = """
import sys
heads = {name.partition('.')[0] for name in sys.modules}
watched = {'gymnasium', 'numpy', 'pymunk', 'rclpy', 'rerun', 'tornado', 'yaml'}
print('IMPORTED', sorted(heads & watched))
"""
USE_ALL = 'import physsim_ros\n[getattr(physsim_ros, name) for name in physsim_ros.__all__]\n'


def test_the_page_prints_what_it_says_and_imports_no_ros() -> None:
    programs, printed = (blocks_of('docs/python.md', each) for each in ('python', 'text'))
    assert len(programs) == len(printed)

    told, imported = run_python('-c', '\n'.join((*programs, USE_ALL)) + IMPORTED).split(
        'IMPORTED '
    )
    assert told == ''.join(printed)
    assert ast.literal_eval(imported) == ['numpy', 'pymunk', 'yaml']


@pytest.mark.parametrize('module', ['simulation.simulation', 'simulation.robot', 'sweeps.sweep'])
def test_the_examples_of_docstrings_print_what_they_say(module: str) -> None:
    results = doctest.testmod(importlib.import_module(f'physsim_ros.{module}'))

    assert results.failed == 0
    assert results.attempted > 0


def test_the_page_names_all_names() -> None:
    # Those of the fields of requests are generated.
    written, _, _ = PAGE.partition('## Fields of requests')
    table = {name for row in re.findall(r'^\| (`.*?) \|', written, re.MULTILINE)
             for name in re.findall(r'`(\w+)`', row)}  # fmt: skip
    assert sorted({*table, 'Request', 'Shape'}) == sorted(physsim_ros.__all__)


def test_worlds_environments_and_sweeps_do_without_rerun() -> None:
    pytest.importorskip('gymnasium')
    lacking = "import sys\nsys.modules.update({'rerun': None, 'pyarrow': None})\n"
    used = 'import physsim_ros.gym, physsim_ros.sweeps\nphyssim_ros.Simulation().run(0.1)\n'

    assert run_python('-c', lacking + USE_ALL + used) == ''


def test_the_package_imports_nothing_before_a_name_is_used() -> None:
    assert run_python('-c', 'import physsim_ros; dir(physsim_ros)' + IMPORTED) == 'IMPORTED []\n'


def test_an_error_is_imported_without_an_engine() -> None:
    program = 'from physsim_ros import PhysSimError, Refusal'

    assert run_python('-c', program + IMPORTED) == 'IMPORTED []\n'


def test_all_names_are_listed_and_found_and_typed_as_they_are_imported() -> None:
    tree = ast.parse((ROOT / 'physsim_ros' / '__init__.py').read_text(encoding='utf-8'))
    (typed,) = (each for each in tree.body if isinstance(each, ast.If))
    homes = {
        name.name: each.module
        for each in typed.body
        if isinstance(each, ast.ImportFrom)
        for name in each.names
    }

    assert sorted(physsim_ros.__all__) == sorted(homes)
    assert {*physsim_ros.__all__} <= {*dir(physsim_ros)}
    for name, module in homes.items():
        assert getattr(physsim_ros, name) is getattr(importlib.import_module(module), name)


def test_a_name_that_there_is_not_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'Circle'"):
        physsim_ros.Circle  # noqa: B018 - asked for
