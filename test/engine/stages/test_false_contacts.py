# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Polygons that face each other exactly touch where they touch, and nowhere else."""

import math

import numpy as np
from physsim_ros.model.shapes import Box, Disc
import pytest

from ...laws.scenes import NOWHERE, simulation, spawn, steps

PAIRS = 400


def _pairs(gap, speed):
    """
    Put pairs of squares side by side, at many headings.

    :param gap: between the two, at most [m]
    :param speed: of the second square away from the first [m/s]
    """
    random = np.random.default_rng(3)
    sim = simulation(gravity=NOWHERE, elasticity=0.5)
    square = Box(width=1.0, height=1.0)
    for number in range(PAIRS):
        heading = random.uniform(0.0, 2.0 * math.pi)
        along = np.array((math.cos(heading), math.sin(heading)))
        place = np.array((number % 20, number // 20)) * 5.0
        other = place + along * (1.01 + random.uniform(0.0, gap))
        spawn(sim, f'one/{number}', square, (*place, heading))
        spawn(sim, f'other/{number}', square, (*other, heading), velocity=tuple(along * speed))
    return sim


def test_squares_that_part_do_not_touch_again():
    sim = _pairs(gap=0.2, speed=0.3)
    # Discs touch a wall in the same steps.
    spawn(sim, 'wall/0', Box(width=1.0, height=200.0), (-9.0, 0.0, 0.0), anchored=True)
    for number in range(60):
        place = (-9.6 - number / 24, number, 0.0)
        spawn(sim, f'disc/{number}', Disc(radius=0.1), place, velocity=(10.0, 0.0))
    *_, last = steps(sim, 60)
    first_of_pairs = np.arange(0, 2 * PAIRS, 2)
    assert np.abs(last.twists[first_of_pairs]).max() == 0.0
    assert last.twists[-60:, 0] == pytest.approx(-5.0, rel=1e-3)


@pytest.mark.parametrize('speed', [-2.3, -9.0])
def test_squares_that_meet_do_not_pass_through_each_other(speed):
    nearest = np.inf
    for last in steps(_pairs(gap=0.03, speed=speed), 24):
        between = last.poses[1::2, :2] - last.poses[::2, :2]
        nearest = min(nearest, np.hypot(between[:, 0], between[:, 1]).min())
    assert nearest > 0.99
    # As all have met once: https://en.wikipedia.org/wiki/Coefficient_of_restitution
    parting = last.twists[1::2, :2] - last.twists[::2, :2]
    assert np.hypot(parting[:, 0], parting[:, 1]) == pytest.approx(-speed / 2, rel=1e-3)
