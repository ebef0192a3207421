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

"""What meets at one place, and what hangs together."""

from __future__ import annotations

import itertools
import random

import numpy as np
from physsim_ros.engine.islands import Graph, meetings, ranges, spread
import pytest


def test_ranges_follow_one_another() -> None:
    rows = ranges(np.array([7, 2, 5, 0]), np.array([2, 0, 3, 1]))
    assert rows.tolist() == [7, 8, 5, 6, 7, 0]


def test_there_are_none_of_nothing() -> None:
    nothing = np.empty(0, np.intp)
    assert ranges(nothing, nothing).tolist() == []
    assert [each.tolist() for each in meetings(nothing, nothing)] == [[], []]


def test_all_that_are_at_one_place_meet_both_ways_round() -> None:
    places, items = np.array([4, 9, 4, 4]), np.array([10, 20, 30, 40])
    one, other = meetings(places, items)
    expected = [*itertools.product((10, 30, 40), repeat=2), (20, 20)]
    assert sorted(zip(one.tolist(), other.tolist(), strict=True)) == sorted(expected)


def test_a_mark_spreads_to_all_that_hangs_together() -> None:
    marked = np.array([True, False, False, False, False, False])
    one, other = np.array([3, 1, 4, 5]), np.array([1, 0, 5, 4])
    assert spread(marked, one, other).tolist() == [True, True, False, True, False, False]
    assert marked.sum() == 1


@pytest.mark.parametrize('seed', range(5))
def test_levels_are_how_many_meetings_lead_there_from_the_end(seed: int) -> None:
    pick = random.Random(seed)
    # A tree, so that all hangs together, and some more.
    pairs = [(pick.randrange(number), number) for number in range(1, 60)]
    pairs += [(pick.randrange(60), pick.randrange(60)) for _ in range(10)]
    both = [*pairs, *((b, a) for a, b in pairs)]
    levels = Graph(*np.array(both).T, 60).from_end(0)
    far = {member: number for number, level in enumerate(levels) for member in level.tolist()}
    assert sorted(far) == list(range(60))
    # The first and the last are as far apart as any two that one can see from the other.
    assert len(levels[0]) == 1
    near: dict[int, set[int]] = {}
    for a, b in both:
        near.setdefault(a, set()).add(b)
    for member, number in far.items():
        assert min((far[other] for other in near[member]), default=0) >= number - 1
        assert number == 0 or any(far[other] == number - 1 for other in near[member])
