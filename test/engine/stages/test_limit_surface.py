# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Friction with the floor lies on its limit surface, or stops the slip."""

import numpy as np
from physsim_ros.engine.stages.limit_surface import friction_of, LimitSurface
import pytest

DT = 1 / 240


def _bodies(count, seed=1):
    chance = np.random.default_rng(seed)
    slips = chance.normal(size=(count, 3)) * 10.0 ** chance.uniform(-6, 2, (count, 1))
    most = chance.uniform(0.001, 5.0, count) * 9.81 * DT
    lever = 10.0 ** chance.uniform(-2, 1, count)
    gyration = lever**2 * 10.0 ** chance.uniform(-1, 1, count)
    return slips, most, lever, gyration


def _size(changes, most, lever, gyration):
    """Return the size of impulses by the limit surface; 1 is on it."""
    around = changes[:, 2] * gyration / lever
    return np.hypot(np.hypot(changes[:, 0], changes[:, 1]), around) / most


def test_what_slips_has_friction_on_the_surface_and_what_sticks_within_it():
    bodies = _bodies(5000)

    changes, slides = friction_of(bodies[0], LimitSurface.of(*bodies[1:]))

    size = _size(changes, *bodies[1:])
    assert 100 < slides.sum() < 4900
    assert size[slides] == pytest.approx(1.0, abs=1e-9)
    assert (size[~slides] <= 1.0 + 1e-12).all()
    assert np.array_equal(changes[~slides], -bodies[0][~slides])


def test_friction_is_against_the_slip_that_is_left():
    slips, most, lever, gyration = _bodies(5000)

    changes, slides = friction_of(slips, LimitSurface.of(most, lever, gyration))

    # Maximum dissipation: the slip is normal to the surface where the friction is.
    left = (slips + changes)[slides]
    lever, changes = lever[slides], changes[slides]
    gyration, most = gyration[slides], most[slides]
    normal = np.column_stack((changes[:, :2], changes[:, 2] * gyration / lever**2))
    speed = np.hypot(np.hypot(left[:, 0], left[:, 1]), lever * left[:, 2])
    expected = -normal / most[:, None] * speed[:, None]
    assert np.abs(left - expected).max(axis=1) == pytest.approx(0.0, abs=1e-6)


def test_no_slip_has_no_friction():
    changes, slides = friction_of(np.zeros((1, 3)), LimitSurface.of(*np.ones((3, 1))))

    assert not slides.any()
    assert not changes.any()


def test_friction_never_turns_a_slip_round():
    bodies = _bodies(5000, seed=2)

    changes, _ = friction_of(bodies[0], LimitSurface.of(*bodies[1:]))

    assert ((bodies[0] + changes) * bodies[0] >= 0.0).all()
