# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Modules import each other in no circle, imports for types alone included."""

import ast
from graphlib import TopologicalSorter

import pytest

from .sources import module_name, trees


def _imported(tree, modules):
    """Yield the modules of the package that a module imports."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module in modules:
            for alias in node.names:
                inside = f'{node.module}.{alias.name}'
                yield inside if inside in modules else node.module


@pytest.mark.linter
def test_modules_import_each_other_in_no_circle():
    modules = {module_name(path): tree for path, tree in trees().items()}
    graph = {name: set(_imported(tree, modules)) for name, tree in modules.items()}

    # It raises CycleError, which names the circle.
    order = list(TopologicalSorter(graph).static_order())

    assert order.index('physsim_ros.engine.settings') < order.index('physsim_ros.engine.space')
