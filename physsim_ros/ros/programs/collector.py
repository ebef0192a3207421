# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The garbage collection of a program that runs worlds; theory: `runtime.garbage_collection`."""

from __future__ import annotations

import gc
import sys
import time

# Share of the time that collections of all objects take at most [1].
SHARE = 0.001
# Collections of younger objects between two of all [1], as CPython's own third threshold.
_BETWEEN = 10
# A threshold that is never reached [1].
_NEVER = 2**30


class Collector:
    """
    Collects the garbage among all objects of the process, in place of CPython, but seldom.

    The duration of a collection is predicted from the last one, in proportion to the blocks of
    memory in use. CPython goes on to collect younger objects.
    """

    def __init__(self) -> None:
        gc.set_threshold(*gc.get_threshold()[:2], _NEVER)
        gc.enable()
        self._collect()

    def collect_if_due(self) -> None:
        """Collect garbage if there may be some, and the last collection is long enough ago."""
        if gc.get_count()[2] < _BETWEEN:
            return
        took = self._each * sys.getallocatedblocks()
        if time.monotonic() - self._ended > took / SHARE:
            self._collect()

    def _collect(self) -> None:
        began = time.thread_time()
        gc.collect()
        # Of a block of memory [s].
        self._each = (time.thread_time() - began) / sys.getallocatedblocks()
        self._ended = time.monotonic()
