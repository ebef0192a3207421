# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Modules import each other in no circle, imports for types alone included."""

import ast
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


def _name(path):
    parts = path.relative_to(ROOT).with_suffix('').parts
    return '.'.join(parts[:-1] if parts[-1] == '__init__' else parts)


MODULES = {_name(path): path for path in (ROOT / 'physsim_ros').rglob('*.py')}


def _imported(path):
    """Yield the modules of the package that a module imports."""
    for node in ast.walk(ast.parse(path.read_text(encoding='utf-8'))):
        if isinstance(node, ast.ImportFrom) and node.module in MODULES:
            for alias in node.names:
                inside = f'{node.module}.{alias.name}'
                yield inside if inside in MODULES else node.module


@pytest.mark.linter
def test_modules_import_each_other_in_no_circle():
    graph = {name: set(_imported(path)) for name, path in MODULES.items()}

    # It raises CycleError, which names the circle.
    order = list(TopologicalSorter(graph).static_order())

    assert order.index('physsim_ros.engine.settings') < order.index('physsim_ros.engine.space')
