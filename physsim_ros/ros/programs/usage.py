# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The help of `physsim`: the worlds there are, and all parameters of the node."""

from __future__ import annotations

from physsim_ros.files import shipped_worlds, user_worlds, worlds_in
from physsim_ros.ros.parameters import Spec, SPECS
from physsim_ros.ros.programs.help_tables import files_table, table

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
        files_table('worlds, for parameter world_file:', worlds_in(shipped_worlds())),
        files_table(f'worlds of your own, in {own}:', worlds_in(own)),
        table('parameters, after --ros-args, each as -p name:=value:', parameters),
    )
    return '\n'.join(('', *filter(None, tables), _ELSEWHERE))


def _meaning(spec: Spec) -> str:
    notes = []
    if spec.choices:
        notes.append('one of ' + ', '.join(spec.choices))
    if spec.low is not None and spec.high is not None:
        notes.append(f'{spec.low:g} .. {spec.high:g}')
    default = spec.default
    if isinstance(default, bool):
        default = str(default).lower()
    notes.append(f'default: {default}' if default != '' else 'default: empty')
    if spec.read_only:
        notes.append('read-only')
    return f'{spec.meaning} ({"; ".join(notes)})'
