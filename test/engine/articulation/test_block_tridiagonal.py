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

"""Equations that are solved group by group give what the whole matrix gives."""

from __future__ import annotations

import random

import numpy as np
from physsim_ros.engine.articulation.block_tridiagonal import DENSE, Equations
from physsim_ros.engine.islands import meetings
import pytest


class Scene:
    """
    Rows that push bodies at random, group by group.

    :param sizes: rows of each group
    :param reach: so far along its group from a row the two bodies are that it pushes, at most
    """

    def __init__(self, seed: int, sizes: list[int], reach: int = 3) -> None:
        pick = random.Random(seed)
        rows = list(range(sum(sizes)))
        pick.shuffle(rows)
        first = np.zeros(len(rows), np.intp)
        second = np.zeros(len(rows), np.intp)
        groups, body = [], 0
        for size in sizes:
            group, rows = rows[:size], rows[size:]
            for place, row in enumerate(group):
                # Each leads on from the one before, so that the group hangs together.
                first[row] = body + place
                second[row] = body + place + pick.randint(1, reach)
                if place:
                    second[row] = body + max(0, place - pick.randint(1, reach))
            body += size + reach
            groups.append(np.array(group, np.intp))
        self.count = len(first)
        self.sides = np.concatenate((first, second))
        self.pushes = np.random.default_rng(seed).normal(size=(2 * self.count, 3))
        self.equations = Equations(
            groups, *meetings(self.sides, np.arange(2 * self.count)), self.count
        )

    @property
    def shared(self) -> np.ndarray:
        left, right = self.equations.left, self.equations.right
        return (self.pushes[left] * self.pushes[right]).sum(axis=1)

    @property
    def matrix(self) -> np.ndarray:
        jacobian = np.zeros((self.count, 3 * (self.sides.max() + 1)))
        for side, body in enumerate(self.sides.tolist()):
            columns = slice(3 * body, 3 * body + 3)
            jacobian[side % self.count, columns] += self.pushes[side]
        return jacobian @ jacobian.T


SIZES = [[1], [3, 3, 3, 5, 1, 5], [DENSE], [DENSE + 1], [400], [2, 2, 200, 2, 300, 7]]


@pytest.mark.parametrize('sizes', SIZES)
@pytest.mark.parametrize('share', [1.0, 0.7])
def test_the_unknowns_are_those_of_the_whole_matrix(sizes: list[int], share: float) -> None:
    scene = Scene(len(sizes), sizes)
    numbers = np.random.default_rng(1)
    wanted = numbers.normal(size=scene.count)
    active = numbers.random(scene.count) < share

    unknown = scene.equations.solve(scene.shared, wanted, active)

    assert (unknown[~active] == 0.0).all()
    found = scene.matrix[np.ix_(active, active)] @ unknown[active]
    assert found == pytest.approx(wanted[active], abs=1e-5)


@pytest.mark.parametrize('sizes', SIZES)
def test_rows_that_say_something_new_follow_from_none(sizes: list[int]) -> None:
    scene = Scene(len(sizes), sizes)
    found = scene.equations.dependent(scene.shared, np.ones(scene.count, np.bool_))
    assert found == []


@pytest.mark.parametrize('sizes', [[6, 6], [2 * DENSE], [200, 9]])
def test_of_rows_that_say_the_same_one_follows_from_the_other(sizes: list[int]) -> None:
    scene = Scene(3, sizes)
    twins: dict[tuple[int, int], int] = {}
    # Of those on the same two bodies all say the same, and once more with another sign.
    for row in range(scene.count):
        bodies = int(scene.sides[row]), int(scene.sides[row + scene.count])
        twin = twins.setdefault(bodies, row)
        scene.pushes[row] = -scene.pushes[twin]
        scene.pushes[row + scene.count] = -scene.pushes[twin + scene.count]
    alike = scene.count - len(twins)
    every = np.ones(scene.count, np.bool_)
    rank = int(np.linalg.matrix_rank(scene.matrix, tol=1e-6))
    assert len(scene.equations.dependent(scene.shared, every)) == scene.count - rank >= alike
    # Who does not count follows from none.
    none = np.zeros(scene.count, np.bool_)
    assert scene.equations.dependent(scene.shared, none) == []
