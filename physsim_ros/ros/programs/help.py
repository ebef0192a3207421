# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The help of `physsim`: tables of worlds and parameters with their meanings."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
import re
import shutil
import textwrap

from physsim_ros.files import shipped_lessons, shipped_worlds, title_of, user_worlds, worlds_in
from physsim_ros.ros.parameters import Spec, SPECS

# Width of the column of names, and least width of that of meanings [characters].
_NAMES, _MEANINGS = 22, 40
# Sign behind which a title goes into detail.
_LATER = re.compile('[:;] ')
# Last paragraph of the help.
_ELSEWHERE = """\
config/physsim.yaml sets all of them (--params-file). A running world describes
its parameters (`ros2 param describe /physsim NAME`), and its topics and
services (`ros2 node info /physsim`).
"""


def physsim_help() -> str:
    """Return the end of the help of `physsim`: worlds, parameters and where to read on."""
    own = user_worlds()
    parameters = {name: _meaning(spec) for name, spec in SPECS.items()}
    tables = (
        _files_table('worlds, for parameter world_file:', worlds_in(shipped_worlds())),
        _files_table('lessons, also for parameter world_file:', worlds_in(shipped_lessons())),
        _files_table(f'worlds of your own, in {own}:', worlds_in(own)),
        _table('parameters, after --ros-args, each as -p name:=value:', parameters),
    )
    return '\n'.join(('', *filter(None, tables), _ELSEWHERE))


def _files_table(title: str, files: Mapping[str, Path]) -> str:
    """Return a table of files with the beginnings of their titles; '' if there is none."""
    titles = {name: title_of(path) for name, path in files.items()}
    # What follows a colon or semicolon tells more than a list needs.
    return _table(title, {name: _LATER.split(said)[0] for name, said in titles.items()})


def _table(title: str, meanings: Mapping[str, str]) -> str:
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


def _meaning(spec: Spec) -> str:
    notes = []
    if spec.choices:
        notes.append('one of ' + ', '.join(spec.choices))
    if spec.span is not None:
        notes.append(spec.span.span)
    default = spec.default
    if isinstance(default, bool):
        default = str(default).lower()
    notes.append(f'default: {default}' if default != '' else 'default: empty')
    if spec.read_only:
        notes.append('read-only')
    return f'{spec.meaning} ({"; ".join(notes)})'
