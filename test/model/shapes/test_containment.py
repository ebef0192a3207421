# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""A point lies in a shape up to its edge, and within a slack beyond it."""

import math

import numpy as np
from physsim_ros.model.shapes import (
    Box,
    Chain,
    contain_each,
    contains,
    contains_each,
    distances_from_outlines,
)
from physsim_ros.model.transform import Point
import pytest

from ...building import INSIDE, SHAPES

# Just inside and just outside of an edge [m].
JUST = 1e-9
# Of shapes points on their edge, each with the way out.
EDGES: dict[str, list[tuple[Point, Point]]] = {
    'disc': [((0.5 * math.cos(a), 0.5 * math.sin(a)), (math.cos(a), math.sin(a))) for a in (0, 2)],
    'box': [
        ((0.5, 0.1), (1, 0)),
        ((-0.5, 0), (-1, 0)),
        ((0, 0.25), (0, 1)),
        ((0, -0.25), (0, -1)),
    ],
    'triangle': [((1.5, 1.0), (2, 3)), ((1.0, 0.0), (0, -1))],
    # The inner corner, and beside it.
    'ell': [((1.0, 1.0), (1, 1)), ((1.0, 1.5), (1, 0)), ((0.0, 0.5), (-1, 0))],
    # A side of the first capsule, and both ends.
    'chain': [((1.05, 0.0), (1, 0)), ((-1.05, 0.0), (-1, 0)), ((0.0, 0.25), (0, 1))],
    'triangles': [((0.5, 0.0), (0, -1)), ((1.0, 0.5), (1, 0))],
    'discs': [((-0.55, 0.0), (-1, 0)), ((0.0, 0.65), (0, 1))],
    'boxes': [((0.2, 0.0), (1, 0)), ((0.8, 0.0), (-1, 0))],
}


@pytest.mark.parametrize('kind', SHAPES)
def test_a_shape_ends_at_its_edge_or_a_slack_beyond(kind):
    pieces = SHAPES[kind].form.pieces
    assert contains(pieces, *INSIDE[kind])
    for (x, y), way in EDGES[kind]:
        length = math.hypot(*way)
        out_x, out_y = way[0] / length, way[1] / length
        for slack in (0.0, 0.01):
            near, far = slack - JUST, slack + JUST
            assert contains(pieces, x + near * out_x, y + near * out_y, slack)
            if (x, y) == (1.0, 1.0) and slack:
                # Out of the inner corner, both sides are near.
                far *= math.sqrt(2.0)
            assert not contains(pieces, x + far * out_x, y + far * out_y, slack)


def test_a_point_on_the_seam_of_two_pieces_is_inside():
    # The diagonal of two triangles, and any way from the inner corner of an ell to its outer ones.
    shares = np.linspace(0.01, 0.99, 21)
    assert contains(SHAPES['triangles'].form.pieces, shares, 1.0 - shares).all()
    for x, y in ((0.0, 0.0), (2.0, 0.0), (0.0, 2.0), (1.0, 0.0), (0.0, 1.0)):
        ways = 1.0 + shares * (x - 1.0), 1.0 + shares * (y - 1.0)
        assert contains(SHAPES['ell'].form.pieces, *ways).all()


def test_beyond_a_corner_the_slack_is_round():
    pieces = Box(width=2.0, height=2.0).form.pieces
    assert contains(pieces, 1.0 + 0.7 * 0.1, 1.0 + 0.7 * 0.1, 0.1)
    assert not contains(pieces, 1.0 + 0.71 * 0.1, 1.0 + 0.71 * 0.1, 0.1)


@pytest.mark.parametrize('slack', [0.0, 0.05])
@pytest.mark.parametrize('kind', SHAPES)
def test_arrays_have_the_points_that_numbers_have(kind, slack):
    pieces = SHAPES[kind].form.pieces
    points = np.random.default_rng(3).uniform(-1.5, 2.5, (500, 2))
    one_by_one = [contains(pieces, *point, slack) for point in points.tolist()]
    assert contains(pieces, *points.T, slack).tolist() == one_by_one
    assert any(one_by_one)


@pytest.mark.parametrize('slack', [0.0, 0.05])
def test_many_forms_have_the_points_that_each_of_them_has(slack):
    long = Chain(
        points=tuple((0.01 * each, 0.1 * (each % 2)) for each in range(200)), thickness=0.02
    )
    forms = [shape.form for shape in (*SHAPES.values(), long)] * 40
    points = np.random.default_rng(3).uniform(-1.5, 2.5, (len(forms), 2))
    one_by_one = [
        contains(form.pieces, *point, slack)
        for form, point in zip(forms, points.tolist(), strict=True)
    ]
    assert contain_each(forms, *points.T, slack).tolist() == one_by_one
    assert any(one_by_one)
    assert contain_each([], np.empty(0), np.empty(0)).tolist() == []


def test_a_form_contains_a_point_outside_it_with_a_slack_of_its_distance():
    forms = [shape.form for shape in SHAPES.values()] * 40
    points = np.random.default_rng(4).uniform(-1.5, 2.5, (len(forms), 2))
    distances = distances_from_outlines(forms, *points.T)
    for form, point, distance in zip(forms, points.tolist(), distances.tolist(), strict=True):
        if not contains(form.pieces, *point):
            assert not contains(form.pieces, *point, distance - 1e-9)
            assert contains(form.pieces, *point, distance + 1e-9)
    assert (distances > 0.0).any()


@pytest.mark.parametrize('kind', SHAPES)
def test_a_form_has_the_points_that_its_pieces_have(kind):
    form = SHAPES[kind].form
    points = np.random.default_rng(3).uniform(-1.5, 2.5, (500, 2))
    assert contains_each(form, *points.T).tolist() == contains(form.pieces, *points.T).tolist()
