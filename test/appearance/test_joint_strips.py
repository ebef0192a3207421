# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Symbols of joints show the limits that the joints have."""

from physsim_ros.appearance.joint_strips import joint_strips
from physsim_ros.simulation.world import World
import pytest

from ..building import DISC, join, spawn


@pytest.mark.parametrize(
    ('said', 'least', 'most', 'stops'),
    [
        ({'lower': -0.7, 'upper': 2.0}, -0.7, 2.0, 2),
        ({'lower': -0.7}, -0.7, None, 1),
        ({'upper': 2.0}, None, 2.0, 1),
        ({}, None, None, 0),
    ],
)
def test_the_track_of_a_slider_ends_where_its_way_does(said, least, most, stops):
    world = World()
    spawn(world, 'a/0', DISC)
    join(world, 'slider', [(0.0, 0.0), (1.0, 0.0)], a='a/0', b='world', **said)
    (joint,) = world.snapshot().scene.joints

    rail, *others, _ = joint_strips(joint, 0.1)

    begin, end = (corner.arm[0] for corner in rail)
    assert begin == pytest.approx(begin if least is None else least)
    assert end == pytest.approx(end if most is None else most)
    assert begin < 0.0 < end
    assert [corner.arm[0] for stop in others for corner in stop[:1]] == [
        each for each in (least, most) if each is not None
    ]
    assert len(others) == stops
