# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
The past of a world: a tree of requests with checkpoints, a cursor on it, cached frames, undo.

Not here: the moment that is shown (`playback`). Start with the theory of operation at the head of
`node`; then `tree` (all lines of events), `cursor` (a world at a moment of one) and `past`, the
front. Other folders import the names below.
"""

from physsim_ros.simulation.past.amendment import amend, take_back
from physsim_ros.simulation.past.budget import (
    DEFAULT_MEMORY,
    frame_size,
    LEAST_MEMORY,
    MEGABYTE,
    MOST_MEMORY,
    request_size,
)
from physsim_ros.simulation.past.node import CachedFrame, Moment
from physsim_ros.simulation.past.past import Past
from physsim_ros.simulation.past.replay import finish

__all__ = [
    'DEFAULT_MEMORY',
    'LEAST_MEMORY',
    'MEGABYTE',
    'MOST_MEMORY',
    'CachedFrame',
    'Moment',
    'Past',
    'amend',
    'finish',
    'frame_size',
    'request_size',
    'take_back',
]
