# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 55: what falls onto a pile stays out of it, while more falls."""

import random

import numpy as np
from physsim_ros.model.shapes import Box, Disc
import pytest

from .scenes import run, simulation, spawn, walls

RADIUS = 0.25


def _overlaps(poses):
    """Return the depths [m] of all discs that overlap, by the distances of their centres."""
    gaps = np.hypot(*(poses[:, None, :2] - poses[None, :, :2]).transpose(2, 0, 1)) - 2 * RADIUS
    depths = -gaps[np.triu_indices(len(poses), 1)]
    return depths[depths > 0.0]


@pytest.mark.parametrize(
    ('count', 'elasticity'),
    [(200, 0.0), (200, 0.5), pytest.param(1000, 0.0, marks=pytest.mark.slow)],
)
def test_discs_and_boxes_that_fall_into_a_bin_stay_out_of_each_other(report, count, elasticity):
    sim = simulation()
    rng, half = random.Random(count), 0.6 * count**0.5
    walls(sim, -half, 0.0, half, 1000.0)
    columns = int(2 * half / 0.7)
    rows = []
    for number in range(count):
        shape = Disc(radius=RADIUS) if number % 2 else Box(width=0.5, height=0.5)
        x = 0.5 - half + number % columns * 0.7 + rng.uniform(-0.1, 0.1)
        pose = (x, 0.5 + number // columns * 0.7, 0.0)
        row = spawn(sim, f'body/{number}', shape, pose, elasticity=elasticity)
        rows += [row] * (number % 2)

    for seconds in (2.0, 2.0, 4.0):
        depths = _overlaps(run(sim, seconds).poses[rows])
        what = f'{count} bodies in a bin, elasticity {elasticity:g}'
        # The overlap of bodies that bounce is 5 to 12.5 mm, by the order of shapes in the tree.
        most = 13e-3 if elasticity > 0.0 else 6e-3
        report.check(55, f'{what}: greatest overlap', depths.max(), 0.0, most, 'm')
        report.check(55, f'{what}: mean overlap', depths.mean(), 0.0, 2e-3, 'm')
