# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Linear complementarity problems of impacts."""

import numpy as np
from physsim_ros.engine.lcp import solve_lcp
import pytest


@pytest.mark.parametrize('seed', range(40))
def test_impulses_push_and_contacts_do_not_approach(seed):
    random = np.random.default_rng(seed)
    rows = random.integers(1, 12)
    jacobian = random.normal(size=(rows, rows + 12))
    matrix, rates = jacobian @ jacobian.T, random.normal(size=rows)
    impulses = solve_lcp(matrix.tolist(), rates.tolist())
    assert impulses is not None
    impulses = np.array(impulses)
    after = matrix @ impulses + rates
    assert impulses.min() >= 0.0
    assert after.min() > -1e-6
    assert np.abs(impulses * after).max() < 1e-6


def test_three_points_of_which_two_would_do_share_the_impulse_evenly():
    # Feet at -1, 0 and 1 m of a body of 1 kg and 1 kg m², in units of their effective masses.
    jacobian = np.array([(1.0, -1.0), (1.0, 0.0), (1.0, 1.0)])
    impulses = solve_lcp((jacobian @ jacobian.T).tolist(), [-3.0, -3.0, -3.0])
    assert impulses == pytest.approx([0.75, 1.5, 0.75], rel=1e-5)


def test_a_body_that_is_squeezed_has_no_solution():
    # By two points that face each other.
    assert solve_lcp([[1.0, -1.0], [-1.0, 1.0]], [-1.0, -1.0]) is None
