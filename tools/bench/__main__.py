# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
`make bench`: times, beside those of the bare engine.

`make bench ARGS='300 1000'` chooses the counts of bodies, `ARGS='robots joints'` the tables.
"""

import gc
import sys

from . import (
    capacity,
    chromium_page,
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
_TABLES = {
    module.__name__.rpartition('.')[2]: module.table
    for module in (
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
        chromium_page,
        picture,
        startup,
    )
}


def main(words: list[str]) -> None:
    """Print the tables of some names and counts; without names, all."""
    counts = [int(word) for word in words if word.isdecimal()]
    names = [word for word in words if not word.isdecimal()]
    if unknown := set(names) - {'frames', *_TABLES}:
        sys.exit(f'no table {", ".join(unknown)}; there are frames, {", ".join(_TABLES)}')
    if not names or 'frames' in names:
        frames.table(counts or [100, 300, 1000])
    for name, table in _TABLES.items():
        if not names or name in names:
            table()


main(sys.argv[1:])
