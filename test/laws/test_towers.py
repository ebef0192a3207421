# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 43: towers stand, and neither lean over nor sway."""

import numpy as np
from physsim_ros.model.shapes import Box
import pytest

from .scenes import floor, run, simulation, spawn
from ..slow import slow

SIZE = 0.5


@pytest.mark.parametrize('seconds', [20.0, slow(60.0)])
@pytest.mark.parametrize('count', [20, 40])
def test_a_tower_of_boxes_stands(report, count, seconds):
    sim = simulation(elasticity=0.0)
    floor(sim)
    heights = SIZE * (np.arange(count) + 0.5)
    for number, height in enumerate(heights.tolist()):
        spawn(sim, f'box/{number}', Box(width=SIZE, height=SIZE), (0.0, height, 0.0))

    end = run(sim, seconds)

    what = f'tower of {count} boxes'
    report.check(43, f'{what}, lean of the top', end.poses[-1, 0], 0.0, 0.1, 'm')
    sunk = float(np.abs(end.poses[1:, 1] - heights).max())
    report.check(43, f'{what}, sink', sunk, 0.0, 0.01, 'm')
    speed = float(np.hypot(*end.twists[1:, :2].T).max())
    report.check(43, f'{what}, speed at the end', speed, 0.0, 1e-3, 'm/s')
