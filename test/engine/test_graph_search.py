# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Search of graphs: what pairs of nodes connect."""

from __future__ import annotations

import numpy as np
from physsim_ros.engine.graph_search import components, ranges, reachable


def test_ranges_follow_one_another() -> None:
    rows = ranges(np.array([7, 2, 5, 0]), np.array([2, 0, 3, 1]))
    assert rows.tolist() == [7, 8, 5, 6, 7, 0]


def test_there_are_no_ranges_of_nothing() -> None:
    nothing = np.empty(0, np.intp)
    assert ranges(nothing, nothing).tolist() == []


def test_what_pairs_connect_with_a_mark_is_reachable_and_nothing_else() -> None:
    marked = np.array([True, False, False, False, False, False])
    pairs = np.array([(3, 1), (1, 0), (4, 5), (5, 4)])
    assert reachable(marked, pairs).tolist() == [True, True, False, True, False, False]
    assert marked.sum() == 1


def test_nodes_of_a_component_have_its_least_node() -> None:
    pairs = np.array([(5, 4), (4, 3), (3, 2), (6, 1), (0, 7)])
    assert components(9, pairs).tolist() == [0, 1, 2, 2, 2, 2, 1, 0, 8]


def test_without_pairs_each_node_is_a_component() -> None:
    assert components(3, np.empty((0, 2), np.intp)).tolist() == [0, 1, 2]
