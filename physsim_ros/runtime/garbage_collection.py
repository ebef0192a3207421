# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The cyclic garbage collector, suspended while many objects are made that stay."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
import gc

# Least number of objects, made while collection was suspended, that the next one leaves out [1].
_MANY = 10_000


@contextmanager
def suspended_collection() -> Iterator[None]:
    """
    Suspend the garbage collector; also a decorator.

    It visits all objects whenever their number has grown by a quarter. Without this function that
    is more than half of the time in which 20,000 bodies are loaded.
    """
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
