# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The sources and documents that the tests of this folder look at."""

import ast
from functools import cache
import re

from ..source_tree import ROOT

PACKAGE = ROOT / 'physsim_ros'
DOCS = ROOT / 'docs'
DOCUMENTS = [
    path
    for path in (
        *(ROOT / f'{name}.md' for name in ('README', 'CONTRIBUTING', 'QUALITY_DECLARATION')),
        *sorted(DOCS.rglob('*.md')),
    )
    if '_build' not in path.parts
]
# Folders in which paths of documents begin.
BASES = [ROOT, PACKAGE]


@cache
def sources():
    """Return the paths of all Python files but that which cffi writes when the core is built."""
    folders = ('physsim_ros', 'test', 'tools', 'launch')
    found = [path for folder in folders for path in (ROOT / folder).rglob('*.py')]
    generated = PACKAGE / 'engine/core/_declarations.py'
    return sorted({*found, ROOT / 'setup.py'} - {generated})


@cache
def trees():
    """Return the modules of the package, parsed, by their paths."""
    paths = [path for path in sources() if path.is_relative_to(PACKAGE)]
    return {path: ast.parse(path.read_text(encoding='utf-8')) for path in paths}


def module_name(path):
    """Return the dotted name of a module or package."""
    parts = path.relative_to(ROOT).with_suffix('').parts
    return '.'.join(parts[:-1] if parts[-1] == '__init__' else parts)


def spans(text):
    """Return the texts in backticks; fenced blocks do not count."""
    inline = re.sub(r'^```.*?^```', '', text, flags=re.MULTILINE | re.DOTALL)
    return re.findall(r'`([^`\n]+)`', inline)
