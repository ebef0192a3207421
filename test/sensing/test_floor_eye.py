# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A line follower's eye: the colours of sensors below its photodiodes."""

import math

import numpy as np
from physsim_ros.model.robots.sensors import FloorEye
from physsim_ros.model.shapes import Box, Chain, Disc
from physsim_ros.sensing.touch import read_floor
import pytest

from .worlds import add_robot, plane, seen
from ..building import INSIDE, SHAPES, spawn

BLACK, RED = (0.0, 0.0, 0.0, 1.0), (1.0, 0.0, 0.0, 1.0)
HALF_BLUE = (0.0, 0.0, 1.0, 0.5)
WHITE = [255, 255, 255]


def read(world, row, eye, seed=1):
    return read_floor(seen(world, seed), row, eye)


def test_a_line_under_the_row_is_seen_where_it_is():
    world = plane()
    line = Chain(points=((-5.0, 0.0), (5.0, 0.0)), thickness=0.05)
    spawn(world, 'line/0', line, color=BLACK, sensor=True)
    # The robot stands 2 cm left of the line: it is on the right.
    row = add_robot(world, pose=(0.0, 0.02, 0.0))

    pixels = read(world, row, FloorEye(pixels=5, width=0.08))

    assert pixels.dtype == np.uint8
    assert pixels.tolist() == [WHITE, WHITE, [0] * 3, [0] * 3, [0] * 3]


def test_left_is_first_when_the_robot_has_turned():
    world = plane()
    spawn(world, 'spot/0', Disc(radius=0.02), (-0.05, 0.0, 0.0), color=RED, sensor=True)
    row = add_robot(world, pose=(0.0, 0.0, math.pi / 2))

    pixels = read(world, row, FloorEye(pixels=3, width=0.1))

    assert pixels.tolist() == [[255, 0, 0], WHITE, WHITE]


def test_the_topmost_counts_and_what_is_not_opaque_is_mixed():
    world = plane()
    row = add_robot(world)
    for number, color in enumerate((RED, BLACK, HALF_BLUE)):
        spawn(world, f'spot/{number}', Disc(radius=0.2), color=color, sensor=True)

    assert read(world, row, FloorEye(pixels=1)).tolist() == [[0, 0, 128]]


def test_bodies_that_collide_do_not_lie_on_the_floor():
    world = plane()
    row = add_robot(world)
    spawn(world, 'box/0', Box(width=1.0, height=1.0), color=BLACK)

    assert read(world, row, FloorEye(pixels=2)).tolist() == [WHITE, WHITE]


@pytest.mark.parametrize('shape', SHAPES)
@pytest.mark.parametrize('yaw', [0.0, 2.0])
def test_every_shape_is_seen_inside_and_not_far_outside(shape, yaw):
    world = plane()
    spawn(world, 'mark/0', SHAPES[shape], (1.0, 2.0, yaw), color=BLACK, sensor=True)
    x, y = INSIDE[shape]
    cos, sin = math.cos(yaw), math.sin(yaw)
    row = add_robot(world, pose=(1.0 + cos * x - sin * y, 2.0 + sin * x + cos * y, 0.3))
    away = add_robot(world, 'away/0', pose=(4.5, 2.0, 0.3))

    assert read(world, row, FloorEye(pixels=1)).tolist() == [[0, 0, 0]]
    assert read(world, away, FloorEye(pixels=1)).tolist() == [WHITE]


def test_the_corner_of_a_concave_shape_is_bare():
    world = plane()
    spawn(world, 'mark/0', SHAPES['ell'], color=BLACK, sensor=True)

    row = add_robot(world, pose=(1.5, 1.5, 0.0))

    assert read(world, row, FloorEye(pixels=1)).tolist() == [WHITE]


def test_noise_is_that_of_the_seed_and_stays_a_colour():
    world = plane()
    spawn(world, 'mark/0', Box(width=1.0, height=1.0), color=(0.5, 0.5, 0.5, 1.0), sensor=True)
    row = add_robot(world)
    eye = FloorEye(pixels=1000, noise=0.1)

    pixels = read(world, row, eye)

    assert pixels.tobytes() == read(world, row, eye).tobytes()
    assert pixels.tobytes() != read(world, row, eye, 2).tobytes()
    assert np.std(pixels / 255) == pytest.approx(0.1, rel=0.1)
