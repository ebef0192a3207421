# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Law 48: bodies of every size rest on each other without sinking in."""

import math

import numpy as np
from physsim_ros.model.shapes import Box, Disc
import pytest

from .scenes import DT, G, simulation, spawn

SIZES = [0.001, 0.01, 0.1, 1.0, 10.0, 100.0, 1000.0]


def ground(sim, size):
    """Add an anchored slab to a scene of bodies of a size, its top going through the origin."""
    slab = Box(width=50.0 * size, height=10.0 * size)
    spawn(sim, 'floor/0', slab, (0.0, -5.0 * size, 0.0), anchored=True)


def rested(sim, size):
    """Return the snapshot after twelve times as long as a body falls by its size, and 2 s."""
    sim.world.step(round((2.0 + 12.0 * math.sqrt(2 * size / G)) / DT))
    return sim.world.snapshot()


def overlaps(heights, thickness):
    """
    Return the overlap of each body of a stack with that below, as a share of its thickness.

    :param heights: (n,) float64: of the centres from the bottom up [m]
    """
    return 1.0 - np.diff(np.concatenate([[-thickness / 2], heights])) / thickness


def check_overlap(report, what, overlap, size):
    """Hold overlaps at rest against what a body of a size may have."""
    # The overlap that the solver leaves on purpose is a share of the body at 1 mm, and less of
    # larger bodies.
    tolerance = 0.06 if size < 0.01 else 0.01
    share = float(np.max(overlap))
    report.check(48, f'{what} of {size:g} m, overlap', share, 0.0, tolerance, 'sizes')


def falls_on_stack(size):
    """Return a box of a size that falls on a stack of three [m]."""
    sim = simulation()
    ground(sim, size)
    for number, level in enumerate((0.5, 1.5, 2.5, 4.5)):
        spawn(sim, f'box/{number}', Box(width=size, height=size), (0.0, level * size, 0.0))
    return sim


@pytest.mark.parametrize('size', SIZES)
def test_a_box_that_falls_on_a_stack_does_not_sink_in(report, size):
    end = rested(falls_on_stack(size), size)

    check_overlap(report, 'a box on three', overlaps(end.poses[1:, 1], size), size)
    speed = float(np.abs(end.twists[1:, :2]).max()) / math.sqrt(G * size)
    report.check(48, 'a box on three, speed at the end', speed, 0.0, 0.01, '√(g size)')
    tilt = float(np.abs(end.poses[1:, 2]).max())
    report.check(48, 'a box on three, tilt', tilt, 0.0, 0.03, 'rad')


@pytest.mark.parametrize('size', SIZES)
def test_a_ball_comes_to_rest_without_sinking_in(report, size):
    sim = simulation()
    ground(sim, size)
    ball = spawn(sim, 'ball/0', Disc(radius=size), (0.0, 2.0 * size, 0.0))

    end = rested(sim, size)

    check_overlap(report, 'ball', overlaps(end.poses[[ball], 1], 2.0 * size), size)
    speed = float(np.abs(end.twists[ball, :2]).max()) / math.sqrt(G * size)
    report.check(48, 'ball, speed at the end', speed, 0.0, 0.01, '√(g size)')


@pytest.mark.parametrize('size', SIZES)
def test_ten_coins_stand_on_each_other(report, size):
    sim = simulation()
    ground(sim, size)
    coin = Box(width=20.0 * size, height=size)
    heights = size * (np.arange(10) + 0.5)
    for number, height in enumerate(heights.tolist()):
        spawn(sim, f'coin/{number}', coin, (0.0, height, 0.0))

    end = rested(sim, size)

    check_overlap(report, 'ten coins', overlaps(end.poses[1:, 1], size), size)
    sunk = (heights[-1] - end.poses[-1, 1]) / heights[-1]
    report.check(48, 'ten coins, sink of the top', sunk, 0.0, 0.04, 'heights')
    moved = float(np.abs(end.poses[1:, 0]).max()) / size
    report.check(48, 'ten coins, displacement', moved, 0.0, 0.1, 'sizes')
    tilt = float(np.abs(end.poses[1:, 2]).max())
    report.check(48, 'ten coins, tilt', tilt, 0.0, 0.01, 'rad')


def test_a_small_box_is_pushed_out_until_a_tenth_of_its_half_width_is_left(report):
    sim = simulation()
    ground(sim, 0.02)
    spawn(sim, 'box/0', Box(width=0.02, height=0.02), (0.0, 0.006, 0.0))

    end = rested(sim, 0.02)

    left = overlaps(end.poses[1:, 1], 0.02)[0] * 0.02
    report.check(48, 'a box of 2 cm that was 4 mm in the floor, overlap', left, 1e-3, 2e-4, 'm')
