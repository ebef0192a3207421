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
The outer boundary of a closed polyline that crosses itself: the ten corners of a pentagram.

The boundary is walked from an outermost corner, turning into the outermost side at each crossing,
as in the overlay of polygons (de Berg and others, Computational Geometry, chapter 2).
"""

from __future__ import annotations

import itertools
import math

import numpy as np
from physsim_ros.model.arrays import Floats
from physsim_ros.model.shapes import crosses_itself, signed_area
from physsim_ros.model.transform import cross

# The number of sides above which an outline is no figure of straight sides.
_MOST_SIDES = 16


def outer_boundary(corners: Floats) -> Floats | None:
    """
    Return the simple outline around all corners, or None where there is none.

    :param corners: (n, 2) float64: of a closed polyline, in order, the first not repeated [m]
    :return: (k, 2) float64, counter-clockwise [m]; None where some corner lies within, so that the
        crossings are not those of a star, or where the parts only touch, as in an eight
    """
    count = len(corners)
    if count > _MOST_SIDES:
        return None
    nodes: list[Floats] = list(corners)
    # Places along each side: share of its length, node.
    along: list[list[tuple[float, int]]] = [
        [(0.0, side), (1.0, (side + 1) % count)] for side in range(count)
    ]
    steps = np.roll(corners, -1, axis=0) - corners
    for one, other in itertools.combinations(range(count), 2):
        if (one + 1) % count == other or (other + 1) % count == one:
            continue
        sine = float(cross(steps[one], steps[other]))
        if sine == 0.0:
            continue
        away = corners[other] - corners[one]
        a = float(cross(away, steps[other])) / sine
        b = float(cross(away, steps[one])) / sine
        if 0.0 < a < 1.0 and 0.0 < b < 1.0:
            along[one].append((a, len(nodes)))
            along[other].append((b, len(nodes)))
            nodes.append(corners[one] + a * steps[one])
    neighbours: dict[int, list[int]] = {}
    for places in along:
        ordered = [node for _, node in sorted(places)]
        for node, following in itertools.pairwise(ordered):
            neighbours.setdefault(node, []).append(following)
            neighbours.setdefault(following, []).append(node)
    walk = _outer_walk(np.array(nodes), neighbours)
    if not set(range(count)) <= set(walk) or len(set(walk)) < len(walk):
        return None
    outline = np.array(nodes)[walk]
    return None if crosses_itself(outline) or signed_area(outline) <= 0.0 else outline


def _outer_walk(nodes: Floats, neighbours: dict[int, list[int]]) -> list[int]:
    """Return the nodes around a plane graph, counter-clockwise from the lowest one."""
    start = min(neighbours, key=lambda node: (nodes[node][1], nodes[node][0]))
    walk, node, heading = [start], start, 0.0
    for _ in range(2 * sum(map(len, neighbours.values()))):

        def turn_right(to: int, node: int = node, heading: float = heading) -> float:
            """Return how far to the right a neighbour lies: all other sides are left of it."""
            x, y = nodes[to] - nodes[node]
            return (math.atan2(y, x) - heading + math.pi - 1e-9) % (2.0 * math.pi)

        following = min(neighbours[node], key=turn_right)
        x, y = nodes[following] - nodes[node]
        heading = math.atan2(y, x)
        node = following
        if node == start:
            break
        walk.append(node)
    return walk
