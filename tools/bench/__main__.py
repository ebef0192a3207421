# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`make bench`: times, beside those of the bare engine.

`make bench ARGS='300 1000'` chooses the counts of bodies, `ARGS='robots joints'` the tables.
"""

import gc
import sys

from . import (
    browser,
    capacity,
    classroom,
    crowd,
    engine,
    fixture,
    frames,
    joints,
    learning,
    outside,
    pages,
    picture,
    resting,
    rewinding,
    robots,
    sensors,
    startup,
)

# The garbage collector skips imported modules, as in the node.
gc.collect()
gc.freeze()
_HEAD = """\
bare: Pymunk alone with the same bodies, 240 steps a second, ten iterations, no sub-steps
ours, node: this project; naive: bare Pymunk, read body by body in Python
A frame is 4 steps, a 60th of a second of simulation. ARGS='name' chooses the table [name]."""
_TABLES = {
    module.__name__.rpartition('.')[2]: module
    for module in (
        frames,
        engine,
        fixture,
        outside,
        resting,
        capacity,
        crowd,
        joints,
        learning,
        sensors,
        robots,
        rewinding,
        pages,
        classroom,
        browser,
        picture,
        startup,
    )
}


def main(words: list[str]) -> None:
    """Print the tables of some names and counts; without names, all."""
    counts = [int(word) for word in words if word.isdecimal()]
    names = [word for word in words if not word.isdecimal()]
    if unknown := set(names) - {*_TABLES}:
        sys.exit(f'no table {", ".join(unknown)}; there are {", ".join(_TABLES)}')
    print(_HEAD)
    for name, module in _TABLES.items():
        if not names or name in names:
            title, *_ = (module.__doc__ or '').strip().split('\n')
            print(f'\n[{name}] {title}', flush=True)
            if module is frames:
                frames.table(counts or [100, 300, 1000])
            else:
                module.table()


main(sys.argv[1:])
