# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""The mean distance of the points of a shape from its centroid."""

import math

import numpy as np
from physsim_ros.model.shapes import Box, Chain, Compound, Disc, lever_of, Polygon
import pytest


def _by_points(shape, inside):
    """Return the mean distance of points of a grid that lie in a shape [m]."""
    form = shape.form
    span = np.linspace(-form.outer, form.outer, 1201)
    x, y = np.meshgrid(span + form.centroid[0], span + form.centroid[1])
    within = inside(x, y)
    return np.hypot(x - form.centroid[0], y - form.centroid[1])[within].mean()


def test_of_a_disc_it_is_two_thirds_of_the_radius():
    assert lever_of(Disc(radius=0.3).form) == pytest.approx(0.2, rel=1e-12)


def test_of_a_square_it_is_that_of_the_formula():
    exact = (math.sqrt(2.0) + math.asinh(1.0)) / 6.0

    assert lever_of(Box(width=1.0, height=1.0).form) == pytest.approx(exact, rel=1e-12)


def test_of_a_concave_polygon_it_is_that_of_its_points():
    outline = ((0.0, 0.0), (2.0, 0.0), (2.0, 0.5), (0.5, 0.5), (0.5, 2.0), (0.0, 2.0))
    shape = Polygon(outline=outline)

    def inside(x, y):
        return ((x >= 0) & (y >= 0) & (x <= 2) & (y <= 0.5)) | (
            (x >= 0) & (y >= 0) & (x <= 0.5) & (y <= 2)
        )

    assert lever_of(shape.form) == pytest.approx(_by_points(shape, inside), rel=5e-3)


def test_of_discs_beside_the_centroid_it_is_that_of_their_points():
    shape = Compound(element=Disc(radius=0.2), centers=((-0.5, 0.0), (0.5, 0.1)))

    def inside(x, y):
        return (np.hypot(x + 0.5, y) <= 0.2) | (np.hypot(x - 0.5, y - 0.1) <= 0.2)

    assert lever_of(shape.form) == pytest.approx(_by_points(shape, inside), rel=2e-3)


def test_of_a_segment_with_round_ends_it_is_that_of_its_points():
    shape = Chain(points=((0.0, 0.0), (1.0, 0.0)), thickness=0.4)

    def inside(x, y):
        return np.hypot(x - np.clip(x, 0.0, 1.0), y) <= 0.2

    assert lever_of(shape.form) == pytest.approx(_by_points(shape, inside), rel=2e-3)
