# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Tables of names and meanings, for the help of the programs."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
import shutil
import textwrap

from physsim_ros.files import title_of

# Width of the column of names, and least width of that of meanings [characters].
_NAMES, _MEANINGS = 22, 40


def files_table(title: str, files: Mapping[str, Path]) -> str:
    """Return a table of files, each with the sentence that it begins with; '' if there is none."""
    return table(title, {name: title_of(path) for name, path in files.items()})


def table(title: str, meanings: Mapping[str, str]) -> str:
    """Return names with their meanings below a title, as wide as the terminal; '' if none."""
    if not meanings:
        return ''
    width = max(_MEANINGS, shutil.get_terminal_size().columns - _NAMES - 2)
    lines = [title]
    for name, meaning in meanings.items():
        first, *others = textwrap.wrap(meaning, width, break_on_hyphens=False)
        lines.append(f'  {name:{_NAMES - 2}}  {first}')
        lines += [' ' * (_NAMES + 2) + other for other in others]
    return '\n'.join(lines) + '\n'
