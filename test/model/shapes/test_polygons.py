# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Outlines come apart into convex pieces that cover them and do not overlap."""

import math

from hypothesis import assume, given, settings
from hypothesis import strategies as st
import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.errors import BadSize
from physsim_ros.model.shapes import Capsule, Chain, Convex, MOST_POINTS, Piece, Polygon
import pytest

from .polygons import (
    area_of,
    assert_apart,
    assert_cover,
    assert_solid,
    combs,
    drawn_boxes,
    polyominoes,
    ROUNDING,
    stars,
    turned,
)


@pytest.mark.parametrize(
    ('outlines', 'count'), [(stars, 60), (combs, 40), (polyominoes, 80), (drawn_boxes, 60)]
)
def test_any_outline_is_a_solid_of_its_area(outlines, count):
    @settings(deadline=None, max_examples=count)
    @given(points=outlines())
    def check(points):
        assert_solid(points)

    check()


@pytest.mark.parametrize('yaw', [0.0, 0.17, 0.7, 1.3])
@pytest.mark.parametrize('size', [0.1, 22.6, 1000.0])
def test_a_plus_sign_at_any_angle_is_split(yaw, size):
    # The engine's own split recursed on it until the interpreter crashed.
    arm = [(size, -size), (3.0 * size, -size), (3.0 * size, size)]
    points = [point for k in range(4) for point in turned(arm, math.pi / 2 * k)]

    form = Polygon(outline=tuple(turned(points, yaw))).form

    area = abs(area_of(points))
    assert area == pytest.approx(20.0 * size**2, rel=ROUNDING)
    assert 3 <= len(form.pieces) <= 5
    assert_cover(form.pieces, area)
    assert_apart(form.pieces)


@pytest.mark.parametrize('gap', [1e-7, 1e-12, 1e-160, 5e-324])
def test_a_corner_that_is_there_twice_counts_once(gap):
    # The engine's own split took the interpreter down at some of these.
    outline = (
        (-1.0, -1.0),
        (1.0, -1.0),
        (1.0, 1.0),
        (gap, 1.0),
        (0.0, 1.0),
        (0.0, 0.0),
        (gap, -gap),
        (-1.0, 0.0),
    )

    polygon = Polygon(outline=outline)

    assert len(polygon.outline) == 6
    assert polygon.form.area == pytest.approx(3.0, rel=1e-6)


def test_corners_that_repeat_are_dropped_and_the_rest_is_kept():
    square = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
    doubled = tuple(point for point in square for _ in range(3))

    assert Polygon(outline=doubled) == Polygon(outline=square)
    assert Polygon(outline=(*square, square[0])) == Polygon(outline=square)
    assert Polygon(outline=square).outline == square


def test_corners_on_a_straight_side_change_nothing():
    square = Polygon(outline=((0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)))

    assert len(square.form.pieces) == 1
    assert square.form.area == pytest.approx(1.0, rel=ROUNDING)


def test_the_most_corners_that_an_outline_may_have_are_split():
    points = [
        (radius * math.cos(angle), radius * math.sin(angle))
        for radius, angle in (
            ((1.0, 1.1)[k % 2], 2 * math.pi * k / MOST_POINTS) for k in range(MOST_POINTS)
        )
    ]

    form = Polygon(outline=tuple(points)).form

    assert_cover(form.pieces, area_of(points), share=1.1e-3)


def test_a_chain_has_a_capsule_for_every_link():
    chain = Chain(points=((0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (1.0, 2.0)), thickness=0.1)

    assert chain.form.pieces == (
        Capsule((0.0, 0.0), (1.0, 0.0), 0.05),
        Capsule((1.0, 0.0), (1.0, 2.0), 0.05),
    )


def test_a_chain_may_be_closed_and_may_cross_itself():
    square = Chain(
        points=((0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0), (0.0, 0.0)), thickness=0.1
    )

    assert len(square.form.pieces) == 4


def corners_of(form_pieces: tuple[Piece, ...]) -> NDArray[np.float64]:
    return np.concatenate(
        [np.array(piece.vertices) for piece in form_pieces if isinstance(piece, Convex)]
    )


@settings(deadline=None, max_examples=40)
@given(points=st.one_of(stars(), polyominoes()))
def test_pieces_have_no_corners_but_the_outlines(points):
    try:
        polygon = Polygon(outline=tuple(points))
    except BadSize:
        assume(False)

    outline = {(round(x, 9), round(y, 9)) for x, y in polygon.outline}
    pieces = {(round(x, 9), round(y, 9)) for x, y in corners_of(polygon.form.pieces).tolist()}
    assert pieces <= outline
