# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Symbols of joints have the size, the turns and the limits that their joints have."""

import math

import numpy as np
from physsim_ros.appearance.joint_strips import joint_strips
from physsim_ros.model.joints import JointKind
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


@pytest.mark.parametrize(
    ('kind', 'said', 'strip', 'reaches', 'turns'),
    [
        ('axle', {}, 0, (0.1, 0.1), 1.0),
        ('axle', {'stiffness': 1.0}, 1, (0.1, 0.25), 3.0),
        ('motor', {'rate': 2.0}, 1, (0.2, 0.2), 0.75),
        ('motor', {'rate': -2.0}, 1, (0.2, 0.2), -0.75),
        ('spring', {}, 2, (0.05, 0.05), 1.0),
    ],
)
def test_what_goes_about_a_point_of_a_joint_has_its_reach_and_its_turns(
    kind, said, strip, reaches, turns
):
    world = World()
    spawn(world, 'a/0', DISC)
    points = [(0.0, 0.0), (1.0, 0.0)][: JointKind(kind).points]
    join(world, kind, points, a='a/0', b='world', **said)
    (joint,) = world.snapshot().scene.joints

    x, y = np.transpose([corner.arm for corner in joint_strips(joint, 0.1)[strip]])

    reach = np.hypot(x, y)
    assert (reach.min(), reach.max()) == pytest.approx(reaches)
    turned = np.unwrap(np.arctan2(y, x))
    assert (turned[-1] - turned[0]) / math.tau == pytest.approx(turns)
