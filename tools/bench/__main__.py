# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`make bench`: times, beside those of the bare engine.

`make bench ARGS='300 1000'` chooses the counts of bodies, `ARGS='robots joints'` the tables.
"""

import gc
from importlib import import_module
import sys

_HEAD = """\
bare: Pymunk alone with the same bodies, 240 steps a second, ten iterations, no sub-steps
ours, node: this project; naive: bare Pymunk, read body by body in Python
A frame is 4 steps, a 60th of a second of simulation. ARGS='name' chooses the table [name]."""
# The modules that print a table each.
_TABLES = (
    *('frames', 'engine', 'fixture', 'outside', 'resting', 'capacity', 'crowd', 'joints'),
    'accuracy',
    *('learning', 'sensors', 'robots', 'rewinding'),
    *('pages', 'classroom', 'browser', 'picture', 'startup'),
)


def main(words: list[str]) -> None:
    """Print the tables of some names and counts; without names, all."""
    counts = [int(word) for word in words if word.isdecimal()]
    names = [word for word in words if not word.isdecimal()]
    if unknown := set(names) - {*_TABLES}:
        sys.exit(f'no table {", ".join(unknown)}; there are {", ".join(_TABLES)}')
    print(_HEAD)
    for name in _TABLES:
        if names and name not in names:
            continue
        module = import_module(f'{__package__}.{name}')
        # The garbage collector skips imported modules, as in the node.
        gc.collect()
        gc.freeze()
        title, *_ = (module.__doc__ or '').strip().split('\n')
        print(f'\n[{name}] {title}', flush=True)
        if name == 'frames':
            module.table(counts or [100, 300, 1000])
        else:
            module.table()


main(sys.argv[1:])
