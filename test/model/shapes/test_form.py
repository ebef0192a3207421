# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""
Shapes weigh what they enclose: area, centroid, gyration, extent and lever by their formulas.

Equal shapes share a form, which goes with the last of them.
"""

import gc
from itertools import pairwise
import math
from weakref import ref

import numpy as np
from physsim_ros.model.shapes import (
    Box,
    Chain,
    Circle,
    Compound,
    Disc,
    lever_of,
    Polygon,
    Triangles,
)
from physsim_ros.model.shapes.form import MOST_KEPT
import pytest

from .polygons import assert_cover, ROUNDING
from ...building import ELL, SHAPES

CORNERS = ((0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 4.0), (0.0, 4.0))


def assert_weighs(form, area, centroid, gyration):
    assert form.area == pytest.approx(area, rel=ROUNDING)
    assert form.centroid == pytest.approx(centroid, rel=ROUNDING)
    assert form.gyration == pytest.approx(gyration, rel=ROUNDING)


def test_a_disc_is_weighed_by_its_formulas():
    form = Disc(radius=0.3).form

    assert form.area == pytest.approx(math.pi * 0.09, rel=ROUNDING)
    assert form.centroid == (0.0, 0.0)
    assert form.gyration == pytest.approx(0.09 / 2, rel=ROUNDING)
    assert form.outer == form.inner == 0.3
    assert form.pieces == (Circle((0.0, 0.0), 0.3),)


def test_a_box_is_weighed_by_its_formulas():
    form = Box(width=3.0, height=0.4).form

    assert form.area == pytest.approx(1.2, rel=ROUNDING)
    assert form.centroid == (0.0, 0.0)
    assert form.gyration == pytest.approx((3.0**2 + 0.4**2) / 12, rel=ROUNDING)
    assert form.outer == pytest.approx(math.hypot(1.5, 0.2), rel=ROUNDING)
    assert form.inner == pytest.approx(0.2, rel=ROUNDING)


def test_a_right_triangle_is_weighed_by_its_formulas():
    form = Polygon(outline=((1.0, 1.0), (4.0, 1.0), (1.0, 5.0))).form

    # Of a triangle about its centroid: the sum of its squared sides by 36.
    assert_weighs(form, 6.0, (2.0, 1.0 + 4.0 / 3.0), (9.0 + 16.0 + 25.0) / 36.0)
    # The far corner is that of the longer leg.
    assert form.outer == pytest.approx(math.hypot(1.0, 4.0 * 2.0 / 3.0), rel=ROUNDING)
    # Half of its height over the longest side, 3 · 4 / 5.
    assert form.inner == pytest.approx(1.2, rel=ROUNDING)


def test_a_capsule_is_weighed_as_a_bar_with_two_half_discs():
    length, radius = 2.0, 0.25

    form = Chain(points=((0.0, 1.0), (length, 1.0)), thickness=2 * radius).form

    bar, caps = 2 * radius * length, math.pi * radius**2
    # https://en.wikipedia.org/wiki/List_of_second_moments_of_area: a half disc about its own
    # centroid, 4r/3π from its base, and from there to the middle of the bar.
    reach = 4 * radius / (3 * math.pi)
    own = radius**2 / 2 - reach**2
    moment = bar * (length**2 + 4 * radius**2) / 12 + caps * (own + (length / 2 + reach) ** 2)
    assert_weighs(form, bar + caps, (1.0, 1.0), moment / (bar + caps))
    assert form.outer == pytest.approx(length / 2 + radius, rel=ROUNDING)
    assert form.inner == radius


def test_a_chain_is_the_sum_of_its_capsules():
    points = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (3.0, 1.0))
    links = [Chain(points=pair, thickness=0.2).form for pair in pairwise(points)]

    form = Chain(points=points, thickness=0.2).form

    area = sum(link.area for link in links)
    x = sum(link.area * link.centroid[0] for link in links) / area
    y = sum(link.area * link.centroid[1] for link in links) / area
    moment = sum(
        link.area * (link.gyration + (link.centroid[0] - x) ** 2 + (link.centroid[1] - y) ** 2)
        for link in links
    )
    assert_weighs(form, area, (x, y), moment / area)
    assert len(form.pieces) == 3


@pytest.mark.parametrize('step', [1, -1], ids=['counter-clockwise', 'clockwise'])
@pytest.mark.parametrize('first', range(6))
def test_an_ell_is_two_boxes_by_parallel_axes(step, first):
    outline = (ELL.outline[first:] + ELL.outline[:first])[::step]

    form = Polygon(outline=outline).form

    # A box of 2 by 1 about (1, 0.5), and one of 1 by 1 about (0.5, 1.5).
    center = 5.0 / 6.0
    moment = 2.0 * (5.0 / 12.0 + (1.0 - center) ** 2 + (0.5 - center) ** 2)
    moment += 1.0 * (2.0 / 12.0 + (0.5 - center) ** 2 + (1.5 - center) ** 2)
    assert_weighs(form, 3.0, (center, center), moment / 3.0)
    assert form.outer == pytest.approx(math.hypot(2.0 - center, center), rel=ROUNDING)
    assert len(form.pieces) == 2
    assert_cover(form.pieces, 3.0)


@pytest.mark.parametrize('element', [Disc(radius=0.5), Box(width=1.0, height=0.5)])
def test_a_compound_is_its_elements_by_parallel_axes(element):
    form = Compound(element=element, centers=((0.0, 0.0), (3.0, 0.0), (0.0, 6.0))).form

    shifts = (1.0 + 4.0) + (4.0 + 4.0) + (1.0 + 16.0)
    assert_weighs(form, 3 * element.form.area, (1.0, 2.0), element.form.gyration + shifts / 3)
    assert form.inner == element.form.inner


def test_triangles_are_summed_and_may_be_given_either_way_round():
    square = Triangles(
        vertices=((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 0.0), (0.0, 1.0), (1.0, 1.0))
    )

    assert_weighs(square.form, 1.0, (0.5, 0.5), 1.0 / 6.0)
    assert_cover(square.form.pieces, 1.0)


def test_a_small_shape_far_from_its_origin_loses_no_digits():
    far, side = 9e4, 0.01
    near_corner = [(0.0, 0.0), (side, 0.0), (side, side / 2), (side / 2, side / 2), (0.0, side)]

    form = Polygon(outline=tuple((far + x, far + y) for x, y in near_corner)).form

    exact = Polygon(outline=tuple(near_corner)).form
    # Coordinates of 90 km resolve 15 pm, a 1e-9th of the side.
    assert form.area == pytest.approx(exact.area, rel=1e-8)
    assert form.gyration == pytest.approx(exact.gyration, rel=1e-7)
    assert form.centroid == pytest.approx(
        (far + exact.centroid[0], far + exact.centroid[1]), abs=1e-10
    )


def test_a_symmetric_shape_is_balanced_about_its_origin_to_the_bit():
    angles = [2 * math.pi * k / 10 for k in range(10)]
    star = [
        ((1.0, 0.4)[k % 2] * math.cos(a), (1.0, 0.4)[k % 2] * math.sin(a))
        for k, a in enumerate(angles)
    ]

    assert Polygon(outline=tuple(star)).form.centroid == (0.0, 0.0)


def test_whole_numbers_make_the_same_shape_as_fractions():
    assert repr(Disc(radius=1)) == repr(Disc(radius=1.0))
    assert repr(Box(width=2, height=1)) == repr(Box(width=2.0, height=1.0))
    assert repr(Chain(points=((0, 0), (1, 0)), thickness=1)) == repr(
        Chain(points=((0.0, 0.0), (1.0, 0.0)), thickness=1.0)
    )
    assert repr(Polygon(outline=((0, 0), (1, 0), (0, 1)))) == repr(
        Polygon(outline=((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)))
    )


@pytest.mark.parametrize('shape', SHAPES.values(), ids=SHAPES.keys())
def test_equal_shapes_are_equal_and_hash_alike(shape):
    twin = eval(repr(shape))  # noqa: S307 - the repr of a value of our own

    assert twin == shape
    assert hash(twin) == hash(shape)


@pytest.mark.parametrize('zero', [0.0, -0.0])
def test_equal_shapes_share_a_form_whatever_the_sign_of_their_zeros(zero):
    outline = ((zero, zero), (7.0, zero), (zero, 3.0))

    polygon = Polygon(outline=outline)

    assert polygon.form is Polygon(outline=((0.0, 0.0), (7.0, 0.0), (0.0, 3.0))).form
    assert '-0.0' not in repr((polygon.outline, polygon.form.pieces))


def test_equal_shapes_share_a_form_as_long_as_one_of_them_is_there():
    first, second = Polygon(outline=CORNERS), Polygon(outline=CORNERS)
    assert first.form is second.form
    form = first.form
    del first
    for number in range(3 * MOST_KEPT):
        Polygon(outline=tuple((x + number + 1.0, y) for x, y in CORNERS))

    assert Polygon(outline=CORNERS).form is form


def test_of_shapes_that_are_gone_the_last_forms_are_kept_and_no_others():
    forms = [ref(Box(width=0.0917, height=1.0 + 0.1 * number).form) for number in range(100)]
    forms += [ref(Disc(radius=0.0917 + number).form) for number in range(100)]
    gc.collect()

    alive = [form() is not None for form in forms]
    assert sum(alive) <= MOST_KEPT
    assert all(alive[-MOST_KEPT:])


# The lever


def _by_points(shape, inside):
    """Return the mean distance from the centroid of points of a grid that lie in a shape [m]."""
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
def test_the_lever_of_a_disc_and_a_square_is_that_of_the_formula(shape, exact):
    assert lever_of(shape.form) == pytest.approx(exact, rel=1e-12)


THIN_ELL = ((0.0, 0.0), (2.0, 0.0), (2.0, 0.5), (0.5, 0.5), (0.5, 2.0), (0.0, 2.0))
DISCS = Compound(element=Disc(radius=0.2), centers=((-0.5, 0.0), (0.5, 0.1)))


@pytest.mark.parametrize(
    ('shape', 'inside'),
    [
        (
            Polygon(outline=THIN_ELL),
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
def test_the_lever_of_other_shapes_is_that_of_their_points(shape, inside):
    assert lever_of(shape.form) == pytest.approx(_by_points(shape, inside), rel=5e-3)
