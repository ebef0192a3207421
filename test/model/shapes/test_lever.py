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


@pytest.mark.parametrize(
    ('shape', 'exact'),
    [
        (Disc(radius=0.3), 0.2),
        (Box(width=1.0, height=1.0), (math.sqrt(2.0) + math.asinh(1.0)) / 6.0),
    ],
)
def test_of_a_disc_and_a_square_it_is_that_of_the_formula(shape, exact):
    assert lever_of(shape.form) == pytest.approx(exact, rel=1e-12)


ELL = ((0.0, 0.0), (2.0, 0.0), (2.0, 0.5), (0.5, 0.5), (0.5, 2.0), (0.0, 2.0))
DISCS = Compound(element=Disc(radius=0.2), centers=((-0.5, 0.0), (0.5, 0.1)))


@pytest.mark.parametrize(
    ('shape', 'inside'),
    [
        (
            Polygon(outline=ELL),
            lambda x, y: (
                (np.minimum(x, y) >= 0) & (np.maximum(x, y) <= 2) & (np.minimum(x, y) <= 0.5)
            ),
        ),
        (DISCS, lambda x, y: (np.hypot(x + 0.5, y) <= 0.2) | (np.hypot(x - 0.5, y - 0.1) <= 0.2)),
        (
            Chain(points=((0.0, 0.0), (1.0, 0.0)), thickness=0.4),
            lambda x, y: np.hypot(x - np.clip(x, 0.0, 1.0), y) <= 0.2,
        ),
    ],
    ids=['concave', 'discs beside the centroid', 'segment with round ends'],
)
def test_of_other_shapes_it_is_that_of_their_points(shape, inside):
    assert lever_of(shape.form) == pytest.approx(_by_points(shape, inside), rel=5e-3)
