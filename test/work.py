# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Work that is counted, so that it is the same on every machine, however busy that is."""

from __future__ import annotations

from collections.abc import Callable
import cProfile


def calls_of(act: Callable[[], object]) -> int:
    """Return how often an act calls functions, of Python or C."""
    profile = cProfile.Profile()
    profile.runcall(act)
    return sum(entry.callcount for entry in profile.getstats())
