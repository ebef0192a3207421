# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Pairs of pieces that overlap are counted, and those that only touch are none."""

import tracemalloc
from weakref import ref

import numpy as np
from physsim_ros.engine.overlaps import bounds_of_pieces, count_inside, count_overlaps, laid_out
from physsim_ros.model.shapes import Box, Compound, Disc, SMALLEST, Triangles
from physsim_ros.model.shapes.form import MOST_KEPT
import pytest

from ..building import DISC


def test_planks_side_by_side_at_any_angle_are_no_overlap():
    plank = Box(width=5.0, height=1.0)
    for yaw in np.linspace(0.0, np.pi, 9):
        side = np.array((-np.sin(yaw), np.cos(yaw)))
        poses = np.column_stack((np.arange(300)[:, None] * side, np.full(300, yaw)))
        every, none = np.ones(300, np.bool_), np.zeros(300, np.bool_)
        assert count_overlaps(laid_out([plank] * 300, poses), every, none, most=10**6) == 0


@pytest.mark.parametrize('radius', [SMALLEST, 0.5])
def test_discs_overlap_in_one_place_and_not_side_by_side(radius):
    discs, every, none = [Disc(radius=radius)] * 5, np.ones(5, np.bool_), np.zeros(5, np.bool_)
    poses = np.zeros((5, 3))
    assert count_overlaps(laid_out(discs, poses), every, none, most=10**6) == 10
    assert count_overlaps(laid_out(discs, poses), every, every, most=10**6) == 0
    poses[:, 0] = np.arange(5) * 2.0 * radius
    assert count_overlaps(laid_out(discs, poses), every, none, most=10**6) == 0


def test_a_count_that_ends_at_its_limit_takes_little_memory():
    count = 5000
    every, none = np.ones(count, np.bool_), np.zeros(count, np.bool_)
    layout = laid_out([DISC] * count, np.zeros((count, 3)))
    tracemalloc.start()
    assert count_overlaps(layout, every, none, most=1000) > 1000
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 60e6


def test_what_was_counted_for_a_shape_goes_with_it():
    discs = Compound(element=DISC, centers=((0.0, 0.0), (7.0, 0.0)))
    form = ref(discs.form)
    assert count_inside(discs) == 0

    del discs
    for radius in range(1, MOST_KEPT + 1):
        Disc(radius=0.0917 * radius)
    assert form() is None


CORNERS = ((0.0, 0.0), (2.0, 0.0), (0.5, 1.0))


@pytest.mark.parametrize(
    ('one', 'many'),
    [
        (DISC, Compound(element=DISC, centers=((0.0, 0.0),) * 2)),
        (Triangles(vertices=CORNERS), Triangles(vertices=CORNERS * 2)),
    ],
)
def test_boxes_of_a_body_of_one_piece_are_those_of_many(one, many):
    for pose in ((0.0, 0.0, 0.0), (3.0, -2.0, 0.7)):
        (box,) = bounds_of_pieces(one, pose)
        assert bounds_of_pieces(many, pose) == [pytest.approx(box, abs=1e-12)] * 2
