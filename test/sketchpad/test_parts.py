# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The structure of the page's scripts: parts that get others of the page, made before them."""

from __future__ import annotations

from graphlib import TopologicalSorter
from pathlib import Path
import re

from physsim_ros.sketchpad.server.page_handlers import PAGE
import pytest

SCRIPTS = sorted(PAGE.rglob('*.js'))
MAIN = PAGE / 'app.js'
_IMPORT = re.compile(r"^(?:import|export) .* from '(.+)';$", re.MULTILINE)
_NEEDS = re.compile(r'Parts<([^>]*)>')


def imports_of(path: Path) -> set[Path]:
    """Return the scripts that a script imports when it is loaded."""
    found = _IMPORT.findall(path.read_text(encoding='utf-8'))
    return {(path.parent / name).resolve() for name in found}


def test_scripts_import_each_other_in_no_ring() -> None:
    # Raises CycleError, which names the ring.
    order = list(TopologicalSorter({path: imports_of(path) for path in SCRIPTS}).static_order())

    assert set(order) == set(SCRIPTS)


def test_nothing_but_its_main_script_has_the_whole_page() -> None:
    assert [path.name for path in SCRIPTS if MAIN in imports_of(path)] == []
    # Parts of the page are named by `Parts`, some at a time, and app.js makes them in order: the
    # type checker refuses one that is used before.
    main = MAIN.read_text(encoding='utf-8')
    assert 'class ' not in main
    assert re.search(r'new \w+\((this|page|app)\b', main) is None


@pytest.mark.parametrize('path', SCRIPTS, ids=lambda path: path.name)
def test_a_part_says_only_others_that_it_works_with(path: Path) -> None:
    text = path.read_text(encoding='utf-8')
    code = re.sub(r'/\*.*?\*/', '', text, flags=re.DOTALL)
    needed = {name for each in _NEEDS.findall(text) for name in re.findall(r"'(\w+)'", each)}

    # Those that a part only hands on are in the types of those that get them.
    handed = re.search(r'\(this\.parts\b|\(parts\b|\.\.\.parts\b', code) is not None
    assert handed or {name for name in needed if not re.search(rf'\b{name}\b', code)} == set()
