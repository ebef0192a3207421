# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Noise: the same numbers everywhere, independent by seed, name, step and place, normal."""

import hashlib

import numpy as np
from physsim_ros.model.noise import normals
import pytest

COUNT = 200_000


def test_the_same_numbers_as_ever():
    numbers = normals(7, 'tb3/0/scan', 1234, 1000)

    assert hashlib.sha256(numbers.tobytes()).hexdigest()[:16] == 'd4de9fb65c09007c'


def test_a_number_does_not_depend_on_how_many_there_are():
    assert normals(1, 'a', 5, 100)[:7].tobytes() == normals(1, 'a', 5, 7).tobytes()
    assert normals(1, 'a', 5, 0).shape == (0,)


def test_numbers_are_normal():
    numbers = normals(1, 'a', 5, COUNT)

    # Five standard errors of each estimate.
    error = 5 / COUNT**0.5
    assert abs(numbers.mean()) < error
    assert numbers.var() == pytest.approx(1.0, abs=error * 2**0.5)
    assert np.mean(numbers < -1.0) == pytest.approx(0.1587, abs=2e-3 + error * 0.37)
    assert np.mean(numbers < 2.0) == pytest.approx(0.9772, abs=2e-3 + error * 0.15)
    assert np.abs(numbers).max() < 6.0


@pytest.mark.parametrize('other', [(2, 'a', 5), (1, 'b', 5), (1, 'a', 6), (-1, 'a', 5)])
def test_other_seeds_names_and_steps_have_independent_numbers(other):
    numbers, others = normals(1, 'a', 5, COUNT), normals(*other, COUNT)

    assert abs(np.corrcoef(numbers, others)[0, 1]) < 5 / COUNT**0.5


def test_numbers_of_successive_steps_do_not_overlap():
    assert not np.intersect1d(normals(1, 'a', 5, 40), normals(1, 'a', 6, 40)[:8]).size
