# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""
What a pen goes over: the bodies that a scribble is meant for, and those a spring only touches.

Law: what is touched in passing stays.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray
from physsim_ros.drawing.scene_query import View
from physsim_ros.drawing.snapping import End
from physsim_ros.model.arrays import Floats

# Every so manieth point of a stroke is looked at: 43 places, 8 to 10 for each swing of a scribble.
_EVERY = 3
# Name of a body -> at which of these places the pen is upon it.
Over = dict[str, NDArray[np.bool_]]
# A body is meant where that share of the stroke lies upon it, or where it is swept over: its
# middle lies within the stroke, which is about as large, and the pen goes over it that often.
MEANT, AS_LARGE, SWEPT = 0.3, 0.75, 2


def bodies_under(points: Floats, over: Over, view: View) -> tuple[str, ...]:
    """
    Return the bodies that a scribble is meant for, in spawn order.

    :param points: (n, 2) float64: of the stroke [m]
    :param over: what `passed` says of them
    """
    low, high = points.min(axis=0), points.max(axis=0)
    reach = AS_LARGE * float(np.hypot(*(high - low)))
    meant = set()
    for name, hits in over.items():
        form = view.body(name).shape.form
        middle = view.in_world(name, form.centroid)
        within = bool(((middle >= low) & (middle <= high)).all()) and form.outer <= reach
        if hits.mean() >= MEANT or (within and _entries(hits) >= SWEPT):
            meant.add(name)
    if not meant and over:
        # Across a long wall: only little of either lies upon the other.
        most = max(over, key=lambda name: _entries(over[name]))
        if _entries(over[most]) >= SWEPT:
            meant.add(most)
    return tuple(name for name in view.names if name in meant)


def _entries(hits: NDArray[np.bool_]) -> int:
    """Return how often the pen comes upon a body."""
    return int(np.count_nonzero(hits[1:] & ~hits[:-1]) + hits[0])


def share_under(over: Over, ends: Iterable[End]) -> float:
    """Return the share of a stroke that lies upon the bodies at its ends."""
    hits = [over[end.body] for end in ends if end.body in over]
    return float(np.any(hits, axis=0).mean()) if hits else 0.0


def passed(points: Floats, view: View) -> Over:
    """Return for each body that the pen goes over, at which places it does."""
    low, high = points.min(axis=0), points.max(axis=0)
    x, y = ((low + high) / 2).tolist()
    reach = float(np.hypot(*(high - low))) / 2
    over: Over = {}
    for name in view.bodies_at((x, y), reach):
        hits = view.covers(name, points[::_EVERY])
        if hits.any():
            over[name] = hits
    return over
