# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Rows with bounds are solved island by island: what is elsewhere changes nothing."""

import numpy as np
from physsim_ros.engine.joints.saddle_point import Problem, SaddlePoint
import pytest

EVEN = 1e-4
# An island far heavier than this has impulses whose rounding is as large as these.
HEAVY = 1e12


def random_island(seed, *, mass=1.0):
    """Return a chain of bodies with rows that only push, and what they are to reach."""
    pick = np.random.default_rng(seed)
    bodies, rows = 6, 12
    ends = np.array([pick.choice(bodies, 2, replace=False) for _ in range(rows)])
    # The first body does not move.
    inverse = np.full((bodies, 3), 1.0 / mass)
    inverse[0] = 0.0
    jacobian = pick.normal(size=(rows, 2, 3))
    problem = Problem(
        jacobian,
        pick.normal(size=rows),
        np.zeros(rows),
        np.where(pick.random(rows) < 0.5, np.inf, 0.3 * mass),
    )
    return ends, inverse, problem


def solve(ends, inverse, problem, *, rounds=30):
    system = SaddlePoint(ends, inverse)
    sides = np.zeros(len(ends), np.int64)
    return system.solve(problem, sides, np.full(len(ends), EVEN), rounds)


def both(one, other):
    """Return two islands as one system."""
    (ends, inverse, problem), (more, masses, far) = one, other
    together = Problem(*(np.concatenate(each) for each in zip(problem, far, strict=True)))
    return np.concatenate((ends, more + len(inverse))), np.concatenate((inverse, masses)), together


@pytest.mark.parametrize('seed', range(20))
@pytest.mark.parametrize('rounds', [4, 30])
def test_an_island_is_solved_as_if_it_were_alone(seed, rounds):
    island, other = random_island(seed), random_island(seed + 100)

    alone = solve(*island, rounds=rounds)
    beside = solve(*both(island, other), rounds=rounds)

    count = len(alone.impulses)
    assert beside.sides[:count].tolist() == alone.sides.tolist()
    assert beside.impulses[:count] == pytest.approx(alone.impulses, rel=1e-9, abs=1e-12)


def test_the_rounding_of_heavy_bodies_hides_no_bound_of_light_ones():
    island = random_island(3)

    alone = solve(*island)
    beside = solve(*both(island, random_island(4, mass=HEAVY)))

    assert not alone.wrong.any()
    assert (alone.impulses >= 0.0).all()
    assert beside.impulses[: len(alone.impulses)] == pytest.approx(alone.impulses, rel=1e-9)


def test_bodies_that_share_only_what_does_not_move_are_islands_of_their_own():
    ends = np.array([[0, 1], [0, 2], [2, 3]])
    inverse = np.ones((4, 3))
    inverse[0] = 0.0

    system = SaddlePoint(ends, inverse)

    assert len(set(system.islands.tolist())) == 3
    assert system.island_of_row[1] == system.island_of_row[2] != system.island_of_row[0]


def test_a_problem_on_which_block_pivoting_goes_in_a_circle_is_solved():
    # With this matrix of three rows that push one body, block principal pivoting comes back to
    # the sides that it began with.
    matrix = np.array([(4.0, 5.0, -5.0), (5.0, 9.0, -5.0), (-5.0, -5.0, 7.0)])
    jacobian = np.zeros((3, 2, 3))
    jacobian[:, 1] = np.linalg.cholesky(matrix)
    problem = Problem(jacobian, np.array([2.0, 1.0, -3.0]), np.zeros(3), np.full(3, np.inf))
    inverse = np.array([(0.0, 0.0, 0.0), (1.0, 1.0, 1.0)])

    solution = solve(np.array([(0, 1)] * 3), inverse, problem)

    assert not solution.wrong.any()
    assert solution.impulses == pytest.approx((0.5, 0.0, 0.0), rel=2 * EVEN)
