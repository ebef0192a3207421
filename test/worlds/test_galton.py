# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Balls in the bins of the Galton board have a binomial distribution."""

from math import comb, sqrt

import numpy as np
import pytest

from .film import Film, simulation

pytestmark = pytest.mark.slow

ROWS = 12
SPACING = 0.5
# The chi-square that one in a thousand fair boards exceeds, by degrees of freedom
# (NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.4): another last bit anywhere makes
# another board.
CRITICAL = {5: 20.515, 6: 22.458, 7: 24.322, 8: 26.124}
# Fewer than so many expected make no fair class.
FEWEST = 5


def classes(counts, expected):
    """Return counts and expectations, the tails taken together until enough are expected."""
    left = int(np.argmax(np.cumsum(expected) >= FEWEST)) + 1
    right = len(expected) - left
    return [
        np.array([each[:left].sum(), *each[left:right], each[right:].sum()])
        for each in (counts, expected)
    ]


def test_balls_fall_as_coins_do():
    film = Film(simulation('galton'), 50.0)
    balls = [name for name in film.names if name.startswith('ball')]
    ends = np.array([film.pose(name)[-1] for name in balls])
    speeds = np.array([np.abs(film.twist(name)[-1]).max() for name in balls])
    assert speeds.max() < 0.05, 'a ball is still under way'

    bins = np.round(ends[:, 0] / SPACING + ROWS / 2).astype(int)
    assert bins.min() >= 0
    assert bins.max() <= ROWS
    chances = np.array([comb(ROWS, right) for right in range(ROWS + 1)]) / 2**ROWS
    counts = np.bincount(bins, minlength=ROWS + 1)
    counted, expected = classes(counts, chances * len(bins))
    chi_square = ((counted - expected) ** 2 / expected).sum()
    assert chi_square < CRITICAL[len(counted) - 1]
    # One in a thousand fair boards exceeds 3.3 standard deviations of the mean.
    assert abs(bins.mean() - ROWS / 2) < 3.3 * sqrt(ROWS / 4 / len(bins))
