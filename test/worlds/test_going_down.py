# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Bodies slide, roll and fall over in the order that each scene is famous for."""

import math

import numpy as np
from numpy.testing import assert_allclose
import pytest

from .film import at, film, first, FRAMES, G

LANE = math.radians(15)
HOOP = 0.4


def gone(film, name):
    """Return how far a body has come from where it was, (f,)."""
    return np.hypot(*(film.pose(name)[:, :2] - film.pose(name)[0, :2]).T)


@pytest.mark.parametrize(('number', 'friction'), [(0, 0.3), (1, 0.5), (2, 0.6), (3, 0.8)])
def test_what_has_less_friction_than_the_tangent_slides(number, friction):
    incline = film('incline', 4.0)
    slope = math.radians(30)
    pull = G * (math.sin(slope) - friction * math.cos(slope))

    way = gone(incline, f'block/{number}')[at(0.75)]

    # 1 %, and a millimetre of settling.
    assert_allclose(way, max(0.0, pull) * 0.75**2 / 2, rtol=0.01, atol=1e-3)


def test_ice_comes_before_the_disc_and_the_disc_before_the_hoop():
    incline = film('incline', 4.0)
    arrivals = [first(incline.x(racer) > 9.0) for racer in ('ice/0', 'disc/0', 'hoop/0')]

    assert arrivals[0] + FRAMES / 6 < arrivals[1]
    assert arrivals[1] + FRAMES / 6 < arrivals[2]


@pytest.mark.parametrize('racer', ['ice', 'disc', 'hoop'])
def test_a_racer_is_as_fast_as_its_inertia_lets_it(racer):
    incline = film('incline', 4.0)
    scene = incline.frames[0].scene
    if racer == 'ice':
        kept = 0.0
    else:
        rows = [scene.names.index(f'{racer}/0')]
        rows += [scene.names.index('rim/0')] if racer == 'hoop' else []
        mass, moment = scene.inertia[rows].sum(axis=0)
        kept = moment / (mass * HOOP**2)

    way = gone(incline, f'{racer}/0')[at(2.0)]

    assert_allclose(way, G * math.sin(LANE) / (1 + kept) * 2.0**2 / 2, rtol=1e-3)


def test_all_dominoes_fall_one_after_the_other():
    dominoes = film('dominoes', 12.0)
    tilts = [np.abs(dominoes.yaw(f'domino/{number}')) for number in range(28)]

    falls = [first(tilt > 0.3) for tilt in tilts]

    assert falls == sorted(falls)
    # They lie on each other, and the last one lies on the ground.
    assert min(tilt[-1] for tilt in tilts) > 1.0
    assert_allclose(tilts[-1][-1], math.pi / 2, atol=0.01)


def test_a_domino_fells_one_fifteen_times_as_heavy():
    dominoes = film('dominoes', 12.0)
    weights = [
        body.total_mass for body in dominoes.frames[0].scene.bodies if 'domino' in body.name
    ]

    assert weights[-1] > 14 * weights[0]
