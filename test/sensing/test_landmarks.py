# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Finders of landmarks: range and bearing of what is in sight."""

import math

import numpy as np
from physsim_ros.model.robots.sensors import Landmarks
from physsim_ros.model.shapes import Box, Disc, Polygon
from physsim_ros.sensing import Surroundings
from physsim_ros.sensing.distance import read_landmarks
import pytest

from .worlds import add_robot, plane, seen
from ..building import spawn

NAMES = ('post/0', 'post/1', 'post/2')


def read(world, row, finder, seed=3):
    return read_landmarks(Surroundings(seen(world, seed)), row, finder)


def posts(*places, **properties):
    """Return a world of posts, with a robot at 1, 2 that looks along y; and its row."""
    world = plane()
    for number, (x, y) in enumerate(places):
        spawn(world, f'post/{number}', Disc(radius=0.1), (x, y, 0.0), **properties)
    return world, add_robot(world, pose=(1.0, 2.0, math.pi / 2))


@pytest.mark.parametrize('sensor', [False, True])
def test_range_and_bearing_are_those_from_the_sensor(sensor):
    world, row = posts((1.0, 5.0), (0.0, 2.0), (2.0, 1.0), sensor=sensor)
    readings = read(world, row, Landmarks(bodies=NAMES))
    expected = [(3.0, 0.0), (1.0, math.pi / 2), (math.sqrt(2), -3 * math.pi / 4)]
    assert readings == pytest.approx(np.array(expected), abs=1e-12)
    moved = read(world, row, Landmarks(bodies=NAMES[:1], at=(1.0, 0.0, -math.pi / 2)))
    assert moved == pytest.approx(np.array([(2.0, math.pi / 2)]), abs=1e-12)


def test_what_is_hidden_far_off_aside_or_gone_is_nan():
    world, row = posts((1.0, 5.0), (0.0, 2.0), (1.0, 8.0))
    finder = Landmarks(bodies=(*NAMES, 'nobody/0', 'world'), range=(0.5, 4.0), angle=(-1.0, 1.0))
    # One is beside, one too far off and behind another, two are not there.
    assert np.isnan(read(world, row, finder)[:, 0]).tolist() == [False, True, True, True, True]
    far = Landmarks(bodies=NAMES)
    assert np.isnan(read(world, row, far)[:, 0]).tolist() == [False, False, True]
    spawn(world, 'wall/0', Box(width=2.0, height=0.1), (1.0, 4.0, 0.0))
    assert np.isnan(read(world, row, far)[:, 0]).tolist() == [True, False, True]


OFF_CENTRE = Polygon(outline=((-2.0, -0.1), (0.0, -0.1), (0.0, 0.1), (-2.0, 0.1)))


@pytest.mark.parametrize('shape', [Box(width=2.0, height=0.2), OFF_CENTRE])
def test_a_landmark_whose_end_is_seen_is_seen(shape):
    world = plane()
    # Its end is 1 or 2 m before its origin.
    spawn(world, 'post/0', shape, (5.0, 0.0, 0.0))
    row = add_robot(world)
    assert read(world, row, Landmarks(bodies=NAMES[:1]))[0].tolist() == [5.0, 0.0]


def test_noise_is_that_of_the_key_and_repeats():
    world, row = posts((1.0, 5.0), (0.0, 2.0), (2.0, 1.0))
    finder = Landmarks(bodies=NAMES, noise=(0.1, 0.02))
    exact = read(world, row, Landmarks(bodies=NAMES))
    errors = []
    for seed in range(300):
        readings = read(world, row, finder, seed)
        assert np.array_equal(readings, read(world, row, finder, seed))
        errors.append(readings - exact)
    # Four standard errors of a standard deviation of 900 numbers.
    deviations = np.std(np.concatenate(errors), axis=0)
    assert deviations == pytest.approx((0.1, 0.02), rel=4.0 / math.sqrt(1800))
    # What one landmark reads does not depend on the others.
    alone = read(world, row, Landmarks(bodies=(*NAMES[:2], 'nobody/0'), noise=(0.1, 0.02)))
    assert np.array_equal(alone[:2], read(world, row, finder)[:2])
