# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The cyclic garbage collector, suspended while many objects are made that stay.

Theory: CPython visits all objects, and stops all threads, whenever their number has grown by a
quarter: 0.3 to 1.2 s for a world of 15,000 bodies, and more than half of the time in which 20,000
are loaded. The objects of a world make no cycles of references, so that they are freed without a
collection, and little garbage comes from elsewhere: some 100 objects in ten seconds with a page.
Programs collect that by `ros.programs.collector`.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
import gc

# Least number of objects, made while collection was suspended, that the next one leaves out [1].
_MANY = 10_000


@contextmanager
def suspended_collection() -> Iterator[None]:
    """Suspend the garbage collector; also a decorator."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            if gc.get_count()[0] > _MANY and not gc.get_freeze_count():
                # Both together put all objects into the oldest generation, which the next
                # collections do not visit.
                gc.freeze()
                gc.unfreeze()
            gc.enable()
