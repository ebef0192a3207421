# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

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
from physsim_ros.model.transform import cross, next_vertices, norms

# The least length of an outer boundary, in shares of that of the polyline: 0.76 for a pentagram,
# 0.63 for a spiral of two and a half rounds.
_LEAST_LENGTH = 0.68

# Nodes of a plane graph, (n, 2) [m], and of each the nodes that a side leads to.
Graph = tuple[Floats, dict[int, list[int]]]


def outer_boundary(corners: Floats) -> Floats | None:
    """
    Return the simple outline around a closed polyline that crosses itself, or None.

    :param corners: (n, 2) float64: of the polyline, in order, the first not repeated [m]
    :return: (k, 2) float64, counter-clockwise [m]; None where most of the polyline lies within, or
        beside, as of an eight
    """
    nodes, neighbours = _plane_graph(corners)
    loops = (nodes[loop] for loop in _loops(_outer_walk(nodes, neighbours)) if len(loop) > 2)
    outline = max(loops, key=signed_area, default=None)
    if outline is None or _length(outline) < _LEAST_LENGTH * _length(corners):
        return None
    return None if crosses_itself(outline) else outline


def _loops(walk: list[int]) -> list[list[int]]:
    """Return the parts of a closed walk that visit no node twice: the ends of a stroke cross."""
    loops: list[list[int]] = []
    path: list[int] = []
    for node in walk:
        if node in path:
            at = path.index(node)
            loops.append(path[at:])
            del path[at:]
        path.append(node)
    return [*loops, path]


def _plane_graph(corners: Floats) -> Graph:
    """Return the corners and crossings of a closed polyline, joined by the parts of its sides."""
    count = len(corners)
    steps = next_vertices(corners) - corners
    # Shares of the sides at which every pair of them crosses, rows by the first side.
    away = corners[None] - corners[:, None]
    sine = cross(steps[:, None], steps[None])
    parallel = sine == 0.0
    sine = np.where(parallel, 1.0, sine)
    one, other = cross(away, steps[None]) / sine, cross(away, steps[:, None]) / sine
    inside = (one > 0.0) & (one < 1.0) & (other > 0.0) & (other < 1.0)
    pairs = np.argwhere(np.triu(inside & ~parallel, 2))
    # Places along each side: share of its length, node.
    along = [[(0.0, side), (1.0, (side + 1) % count)] for side in range(count)]
    crossings: list[Floats] = []
    for first, second in pairs.tolist():
        if (second + 1) % count == first:
            continue
        node = count + len(crossings)
        along[first].append((float(one[first, second]), node))
        along[second].append((float(other[first, second]), node))
        crossings.append(corners[first] + one[first, second] * steps[first])
    neighbours: dict[int, list[int]] = {}
    for places in along:
        ordered = [node for _, node in sorted(places)]
        for node, following in itertools.pairwise(ordered):
            neighbours.setdefault(node, []).append(following)
            neighbours.setdefault(following, []).append(node)
    return np.vstack((corners, *crossings)), neighbours


def _outer_walk(nodes: Floats, neighbours: dict[int, list[int]]) -> list[int]:
    """Return the nodes around a plane graph, counter-clockwise from the lowest one."""
    places = nodes.tolist()
    start = min(neighbours, key=lambda node: (places[node][1], places[node][0]))
    walk, node, heading = [start], start, 0.0
    for _ in range(2 * sum(map(len, neighbours.values()))):
        x, y = places[node]
        headings = {
            to: math.atan2(places[to][1] - y, places[to][0] - x) for to in neighbours[node]
        }
        # The rightmost side: all others are left of it. Back along the last one comes last.
        turns = {
            to: (angle - heading + math.pi - 1e-9) % (2.0 * math.pi)
            for to, angle in headings.items()
        }
        node = min(turns, key=turns.__getitem__)
        heading = headings[node]
        if node == start:
            break
        walk.append(node)
    return walk


def _length(outline: Floats) -> float:
    return float(norms(next_vertices(outline) - outline).sum())
