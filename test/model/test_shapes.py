# Copyright 2026 physsim_ros maintainers
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""Shapes weigh what they enclose, come apart into convex pieces, and none breaks the engine."""

from itertools import pairwise
import math
import random

from hypothesis import assume, given, settings
from hypothesis import strategies as st
import numpy as np
from numpy.typing import NDArray
from physsim_ros.model.errors import BadOutline, BadSize, Malformed, Refusal
from physsim_ros.model.settings import WorldSettings
from physsim_ros.model.shapes import (
    Box,
    Capsule,
    Chain,
    Circle,
    Compound,
    Convex,
    Disc,
    LARGEST,
    MOST_POINTS,
    Piece,
    Polygon,
    Shape,
    SMALLEST,
    Triangles,
)
from physsim_ros.simulation.world import World
import pytest

from ..building import ELL, SHAPES, spawn

Points = list[tuple[float, float]]
# Sums of a few products in float64, relative.
ROUNDING = 1e-12


def area_of(points: Points | tuple[tuple[float, float], ...]) -> float:
    """Return the signed area of an outline by the shoelace formula [m²]."""
    vertices = np.array(points) - points[0]
    following = np.roll(vertices, -1, axis=0)
    return float((vertices[:, 0] * following[:, 1] - vertices[:, 1] * following[:, 0]).sum() / 2)


def turned(points: Points, yaw: float) -> Points:
    cos, sin = math.cos(yaw), math.sin(yaw)
    return [(cos * x - sin * y, sin * x + cos * y) for x, y in points]


# Area, centroid, gyration, outer and inner


def test_a_disc_is_weighed_by_its_formulas() -> None:
    form = Disc(radius=0.3).form

    assert form.area == pytest.approx(math.pi * 0.09, rel=ROUNDING)
    assert form.centroid == (0.0, 0.0)
    assert form.gyration == pytest.approx(0.09 / 2, rel=ROUNDING)
    assert form.outer == form.inner == 0.3
    assert form.pieces == (Circle((0.0, 0.0), 0.3),)


def test_a_box_is_weighed_by_its_formulas() -> None:
    form = Box(width=3.0, height=0.4).form

    assert form.area == pytest.approx(1.2, rel=ROUNDING)
    assert form.centroid == (0.0, 0.0)
    assert form.gyration == pytest.approx((3.0**2 + 0.4**2) / 12, rel=ROUNDING)
    assert form.outer == pytest.approx(math.hypot(1.5, 0.2), rel=ROUNDING)
    assert form.inner == pytest.approx(0.2, rel=ROUNDING)


def test_a_right_triangle_is_weighed_by_its_formulas() -> None:
    form = Polygon(outline=((1.0, 1.0), (4.0, 1.0), (1.0, 5.0))).form

    assert form.area == pytest.approx(6.0, rel=ROUNDING)
    assert form.centroid == pytest.approx((2.0, 1.0 + 4.0 / 3.0), rel=ROUNDING)
    # Of a triangle about its centroid: the sum of its squared sides by 36.
    assert form.gyration == pytest.approx((9.0 + 16.0 + 25.0) / 36.0, rel=ROUNDING)
    # The far corner is that of the longer leg.
    assert form.outer == pytest.approx(math.hypot(1.0, 4.0 * 2.0 / 3.0), rel=ROUNDING)
    # Half of its height over the longest side, 3 · 4 / 5.
    assert form.inner == pytest.approx(1.2, rel=ROUNDING)


def test_a_capsule_is_weighed_as_a_bar_with_two_half_discs() -> None:
    length, radius = 2.0, 0.25

    form = Chain(points=((0.0, 1.0), (length, 1.0)), thickness=2 * radius).form

    bar, caps = 2 * radius * length, math.pi * radius**2
    # https://en.wikipedia.org/wiki/List_of_second_moments_of_area: a half disc about its own
    # centroid, 4r/3π from its base, and from there to the middle of the bar.
    reach = 4 * radius / (3 * math.pi)
    own = radius**2 / 2 - reach**2
    moment = bar * (length**2 + 4 * radius**2) / 12 + caps * (own + (length / 2 + reach) ** 2)
    assert form.area == pytest.approx(bar + caps, rel=ROUNDING)
    assert form.centroid == pytest.approx((1.0, 1.0), rel=ROUNDING)
    assert form.gyration == pytest.approx(moment / (bar + caps), rel=ROUNDING)
    assert form.outer == pytest.approx(length / 2 + radius, rel=ROUNDING)
    assert form.inner == radius


def test_a_chain_is_the_sum_of_its_capsules() -> None:
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
    assert form.area == pytest.approx(area, rel=ROUNDING)
    assert form.centroid == pytest.approx((x, y), rel=ROUNDING)
    assert form.gyration == pytest.approx(moment / area, rel=ROUNDING)
    assert len(form.pieces) == 3


@pytest.mark.parametrize('step', [1, -1], ids=['counter-clockwise', 'clockwise'])
@pytest.mark.parametrize('first', range(6))
def test_an_ell_is_two_boxes_by_parallel_axes(step: int, first: int) -> None:
    outline = (ELL.outline[first:] + ELL.outline[:first])[::step]

    form = Polygon(outline=outline).form

    # A box of 2 by 1 about (1, 0.5), and one of 1 by 1 about (0.5, 1.5).
    center = 5.0 / 6.0
    moment = 2.0 * (5.0 / 12.0 + (1.0 - center) ** 2 + (0.5 - center) ** 2)
    moment += 1.0 * (2.0 / 12.0 + (0.5 - center) ** 2 + (1.5 - center) ** 2)
    assert form.area == pytest.approx(3.0, rel=ROUNDING)
    assert form.centroid == pytest.approx((center, center), rel=ROUNDING)
    assert form.gyration == pytest.approx(moment / 3.0, rel=ROUNDING)
    assert form.outer == pytest.approx(math.hypot(2.0 - center, center), rel=ROUNDING)
    assert len(form.pieces) == 2
    assert_cover(form.pieces, 3.0)


@pytest.mark.parametrize('element', [Disc(radius=0.5), Box(width=1.0, height=0.5)])
def test_a_compound_is_its_elements_by_parallel_axes(element: Disc | Box) -> None:
    form = Compound(element=element, centers=((0.0, 0.0), (3.0, 0.0), (0.0, 6.0))).form

    assert form.area == pytest.approx(3 * element.form.area, rel=ROUNDING)
    assert form.centroid == pytest.approx((1.0, 2.0), rel=ROUNDING)
    shifts = (1.0 + 4.0) + (4.0 + 4.0) + (1.0 + 16.0)
    assert form.gyration == pytest.approx(element.form.gyration + shifts / 3, rel=ROUNDING)
    assert form.inner == element.form.inner


def test_triangles_are_summed_and_may_be_given_either_way_round() -> None:
    square = Triangles(
        vertices=((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 0.0), (0.0, 1.0), (1.0, 1.0))
    )

    assert square.form.area == pytest.approx(1.0, rel=ROUNDING)
    assert square.form.centroid == pytest.approx((0.5, 0.5), rel=ROUNDING)
    assert square.form.gyration == pytest.approx(1.0 / 6.0, rel=ROUNDING)
    assert_cover(square.form.pieces, 1.0)


def test_a_small_shape_far_from_its_origin_loses_no_digits() -> None:
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


def test_a_symmetric_shape_is_balanced_about_its_origin_to_the_bit() -> None:
    angles = [2 * math.pi * k / 10 for k in range(10)]
    star = [
        ((1.0, 0.4)[k % 2] * math.cos(a), (1.0, 0.4)[k % 2] * math.sin(a))
        for k, a in enumerate(angles)
    ]

    assert Polygon(outline=tuple(star)).form.centroid == (0.0, 0.0)


def test_whole_numbers_make_the_same_shape_as_fractions() -> None:
    assert repr(Disc(radius=1)) == repr(Disc(radius=1.0))
    assert repr(Box(width=2, height=1)) == repr(Box(width=2.0, height=1.0))
    assert repr(Chain(points=((0, 0), (1, 0)), thickness=1)) == repr(
        Chain(points=((0.0, 0.0), (1.0, 0.0)), thickness=1.0)
    )
    assert repr(Polygon(outline=((0, 0), (1, 0), (0, 1)))) == repr(
        Polygon(outline=((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)))
    )


@pytest.mark.parametrize('shape', SHAPES.values(), ids=SHAPES.keys())
def test_equal_shapes_are_equal_and_hash_alike(shape: Shape) -> None:
    twin = eval(repr(shape))  # noqa: S307 - the repr of a value of our own

    assert twin == shape
    assert hash(twin) == hash(shape)


# Pieces


def assert_cover(pieces: tuple[Piece, ...], area: float, *, share: float = 1e-9) -> None:
    """Assert that pieces are convex, counter-clockwise, and together of that area [m²]."""
    total = 0.0
    for piece in pieces:
        assert isinstance(piece, Convex)
        vertices = np.array(piece.vertices)
        edges = np.roll(vertices, -1, axis=0) - vertices
        before = np.roll(edges, 1, axis=0)
        turns = before[:, 0] * edges[:, 1] - before[:, 1] * edges[:, 0]
        chords = np.hypot(*(before + edges).T)
        # 1 µm and its rounding: what bends inwards by less counts as straight.
        assert (turns >= -1.001e-6 * chords).all()
        # Once around, and no more: all bends to the left together are 2π.
        angles = np.arctan2(turns, (before * edges).sum(axis=1))
        assert angles.sum() == pytest.approx(2 * math.pi, abs=1e-6)
        total += area_of(piece.vertices)
    assert total == pytest.approx(area, rel=share)


def assert_apart(pieces: tuple[Piece, ...]) -> None:
    """Assert that no piece holds the middle of another."""
    convex = [np.array(piece.vertices) for piece in pieces if isinstance(piece, Convex)]
    for at, vertices in enumerate(convex):
        middle = vertices.mean(axis=0)
        for other in (each for number, each in enumerate(convex) if number != at):
            edges = np.roll(other, -1, axis=0) - other
            to_middle = middle - other
            sides = edges[:, 0] * to_middle[:, 1] - edges[:, 1] * to_middle[:, 0]
            assert (sides < 0).any()


def assert_solid(points: Points) -> None:
    """Assert that an outline becomes a solid of its area, either way round."""
    area = abs(area_of(points))
    perimeter = sum(map(math.dist, points, points[1:] + points[:1]))
    for outline in (points, points[::-1]):
        try:
            form = Polygon(outline=tuple(outline)).form
        except BadSize:
            # It has parts of less than a millimetre; whether, a test of its own asks.
            continue
        assert form.area == pytest.approx(area, rel=1e-9)
        # A thousandth may lie in slivers; 1 µm along the outline may be straightened.
        assert_cover(form.pieces, area, share=1.1e-3 + 1e-6 * perimeter / area)
        assert_apart(form.pieces)


@st.composite
def stars(draw: st.DrawFn) -> Points:
    """Corners around a centre, at any distances: always simple."""
    count = draw(st.integers(3, 40))
    distances = st.floats(0.2, 3.0)
    shift = draw(st.floats(0.0, 0.7))
    return [
        (radius * math.cos(angle), radius * math.sin(angle))
        for radius, angle in (
            (draw(distances), 2 * math.pi * (k + shift) / count) for k in range(count)
        )
    ]


@st.composite
def combs(draw: st.DrawFn) -> Points:
    """Draw a back with teeth of any lengths, turned."""
    teeth = draw(st.lists(st.floats(0.01, 4.0), min_size=1, max_size=20))
    points = [(0.0, 0.0)]
    for number, length in enumerate(teeth):
        points += [(number + 0.5, 0.0), (number + 0.75, -length), (number + 1.0, 0.0)]
    points += [(float(len(teeth)), 0.5), (0.0, 0.5)]
    return turned(points, draw(st.floats(0.0, 7.0)))


@st.composite
def polyominoes(draw: st.DrawFn) -> Points:
    """Squares side by side, turned: many corners on one line, and many ways to cut."""
    cells = {(0, 0)}
    for direction in draw(
        st.lists(st.sampled_from([(1, 0), (-1, 0), (0, 1), (0, -1)]), min_size=1, max_size=20)
    ):
        x, y = draw(st.sampled_from(sorted(cells)))
        cells.add((x + direction[0], y + direction[1]))
    following: dict[tuple[int, int], tuple[int, int]] = {}
    for x, y in sorted(cells):
        for start, end, beyond in (
            ((x, y), (x + 1, y), (x, y - 1)),
            ((x + 1, y), (x + 1, y + 1), (x + 1, y)),
            ((x + 1, y + 1), (x, y + 1), (x, y + 1)),
            ((x, y + 1), (x, y), (x - 1, y)),
        ):
            if beyond not in cells:
                # Two squares that meet in a corner only make no simple outline.
                assume(start not in following)
                following[start] = end
    first = min(following)
    points, at = [first], following[first]
    while at != first:
        points.append(at)
        at = following[at]
    assume(len(points) == len(following))
    return turned([(float(x), float(y)) for x, y in points], draw(st.floats(0.0, 7.0)))


@st.composite
def drawn_boxes(draw: st.DrawFn) -> Points:
    """Draw a box as a hand does: many points a side, each a bit off."""
    count, off = draw(st.integers(2, 15)), draw(st.sampled_from([1e-12, 1e-7, 1e-4, 1e-2]))
    seed = draw(st.integers(0, 2**32))
    rng = random.Random(seed)
    sides = (
        lambda share: (share, 0.0),
        lambda share: (1.0, share),
        lambda share: (1.0 - share, 1.0),
        lambda share: (0.0, 1.0 - share),
    )
    points = [side(k / count) for side in sides for k in range(count)]
    return [(x + rng.uniform(-off, off), y + rng.uniform(-off, off)) for x, y in points]


@settings(deadline=None, max_examples=60)
@given(points=stars())
def test_any_star_shaped_outline_is_a_solid_of_its_area(points: Points) -> None:
    assert_solid(points)


@settings(deadline=None, max_examples=40)
@given(points=combs())
def test_any_comb_is_a_solid_of_its_area(points: Points) -> None:
    assert_solid(points)


@settings(deadline=None, max_examples=80)
@given(points=polyominoes())
def test_squares_side_by_side_at_any_angle_are_a_solid_of_their_area(points: Points) -> None:
    assert_solid(points)


@settings(deadline=None, max_examples=60)
@given(points=drawn_boxes())
def test_a_box_as_a_hand_draws_it_is_a_solid_of_its_area(points: Points) -> None:
    assert_solid(points)


@pytest.mark.parametrize('yaw', [0.0, 0.17, 0.7, 1.3])
@pytest.mark.parametrize('size', [0.1, 22.6, 1000.0])
def test_a_plus_sign_at_any_angle_is_split(yaw: float, size: float) -> None:
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
def test_a_corner_that_is_there_twice_counts_once(gap: float) -> None:
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


def test_corners_that_repeat_are_dropped_and_the_rest_is_kept() -> None:
    square = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0))
    doubled = tuple(point for point in square for _ in range(3))

    assert Polygon(outline=doubled) == Polygon(outline=square)
    assert Polygon(outline=(*square, square[0])) == Polygon(outline=square)
    assert Polygon(outline=square).outline == square


def test_corners_on_a_straight_side_change_nothing() -> None:
    square = Polygon(outline=((0.0, 0.0), (0.5, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)))

    assert len(square.form.pieces) == 1
    assert square.form.area == pytest.approx(1.0, rel=ROUNDING)


def test_the_most_corners_that_an_outline_may_have_are_split() -> None:
    points = [
        (radius * math.cos(angle), radius * math.sin(angle))
        for radius, angle in (
            ((1.0, 1.1)[k % 2], 2 * math.pi * k / MOST_POINTS) for k in range(MOST_POINTS)
        )
    ]

    form = Polygon(outline=tuple(points)).form

    assert_cover(form.pieces, area_of(points), share=1.1e-3)


def test_a_chain_has_a_capsule_for_every_link() -> None:
    chain = Chain(points=((0.0, 0.0), (1.0, 0.0), (1.0, 0.0), (1.0, 2.0)), thickness=0.1)

    assert chain.form.pieces == (
        Capsule((0.0, 0.0), (1.0, 0.0), 0.05),
        Capsule((1.0, 0.0), (1.0, 2.0), 0.05),
    )


def test_a_chain_may_be_closed_and_may_cross_itself() -> None:
    square = Chain(
        points=((0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0), (0.0, 0.0)), thickness=0.1
    )

    assert len(square.form.pieces) == 4


# Refusals

LENGTHS = {
    'nan': (math.nan, Malformed),
    'infinite': (math.inf, Malformed),
    'minus infinite': (-math.inf, Malformed),
    'zero': (0.0, BadSize),
    'negative': (-1.0, BadSize),
    'tiny': (math.nextafter(SMALLEST, 0.0), BadSize),
    'huge': (math.nextafter(LARGEST, math.inf), BadSize),
}


@pytest.mark.parametrize(('value', 'error'), LENGTHS.values(), ids=LENGTHS.keys())
def test_a_length_out_of_range_is_refused_and_named(value: float, error: type[Refusal]) -> None:
    segment = ((0.0, 0.0), (1.0, 0.0))
    for field, make in (
        ('radius', lambda: Disc(radius=value)),
        ('width', lambda: Box(width=value, height=1.0)),
        ('height', lambda: Box(width=1.0, height=value)),
        ('thickness', lambda: Chain(points=segment, thickness=value)),
    ):
        with pytest.raises(error) as refused:
            make()
        assert refused.value.field == field


@pytest.mark.parametrize('length', [SMALLEST, 1.0, LARGEST])
def test_a_length_at_the_end_of_its_range_is_taken(length: float) -> None:
    assert Disc(radius=length).form.inner == length
    assert Box(width=length, height=length).form.inner == length / 2


@pytest.mark.parametrize('value', [math.nan, math.inf, -math.inf])
def test_a_coordinate_that_is_not_finite_is_malformed(value: float) -> None:
    for make in (
        lambda: Polygon(outline=((0.0, 0.0), (1.0, value), (0.0, 1.0))),
        lambda: Chain(points=((0.0, 0.0), (value, 0.0)), thickness=0.1),
        lambda: Triangles(vertices=((0.0, 0.0), (1.0, value), (0.0, 1.0))),
        lambda: Compound(element=Disc(radius=1.0), centers=((value, 0.0),)),
    ):
        with pytest.raises(Malformed):
            make()


@pytest.mark.parametrize(
    'points',
    [((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)), ((0.0,), (1.0,)),
     (0.0, 1.0, 2.0, 3.0), (('a', 'b'), ('c', 'd'), ('e', 'f')), ((None, 0.0),) * 3],
)  # fmt: skip
def test_what_are_no_pairs_of_numbers_is_malformed(points: object) -> None:
    for make in (
        lambda: Polygon(outline=points),
        lambda: Chain(points=points, thickness=0.1),
        lambda: Triangles(vertices=points),
        lambda: Compound(element=Disc(radius=1.0), centers=points),
    ):
        with pytest.raises(Malformed):
            make()


def test_a_coordinate_beyond_the_largest_is_a_bad_size() -> None:
    far = math.nextafter(LARGEST, math.inf)
    for make in (
        lambda: Polygon(outline=((0.0, 0.0), (far, 0.0), (0.0, 1.0))),
        lambda: Chain(points=((0.0, 0.0), (far, 0.0)), thickness=0.1),
        lambda: Triangles(vertices=((0.0, 0.0), (far, 0.0), (0.0, 1.0))),
        lambda: Compound(element=Disc(radius=1.0), centers=((0.0, -far),)),
    ):
        with pytest.raises(BadSize):
            make()


OUTLINES = {
    'no point': (),
    'one point': ((0.0, 0.0),),
    'two points': ((0.0, 0.0), (1.0, 0.0)),
    'one point thrice': ((1.0, 1.0),) * 3,
    'two points twice': ((0.0, 0.0), (0.0, 0.0), (1.0, 0.0), (1.0, 0.0)),
    'on a line': ((0.0, 0.0), (1.0, 1.0), (2.0, 2.0)),
    'on a slanted line': ((0.0, 0.0), (0.1, 0.3), (0.2, 0.6), (0.7, 2.1)),
    'there and back': ((0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (1.0, 0.0)),
    'bow tie': ((0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)),
    'lopsided bow tie': ((0.0, 0.0), (4.0, 4.0), (4.0, 0.0), (0.0, 1.0)),
    'pentagram': tuple((math.cos(0.8 * math.pi * k), math.sin(0.8 * math.pi * k))
                       for k in range(5)),
    'twice around': tuple((math.cos(math.pi * k / 2), math.sin(math.pi * k / 2))
                          for k in range(8)),
    'corner on a side': ((0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (1.0, 0.0), (0.0, 2.0)),
    'corner on a corner': ((0.0, 0.0), (1.0, 1.0), (2.0, 0.0), (2.0, 2.0), (1.0, 1.0),
                           (0.0, 2.0)),
    'side on a side': ((0.0, 0.0), (4.0, 0.0), (4.0, 2.0), (3.0, 2.0), (3.0, 0.0), (1.0, 0.0),
                       (1.0, 2.0), (0.0, 2.0)),
    'spike outwards': ((0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (2.0, 3.0), (2.0, 1.0), (0.0, 1.0)),
    'spike inwards': ((0.0, 0.0), (1.0, 0.0), (1.0, 0.5), (1.0, 0.0), (2.0, 0.0), (2.0, 1.0),
                      (0.0, 1.0)),
    'spike along a side': ((0.0, 0.0), (3.0, 0.0), (2.0, 0.0), (2.0, 1.0), (0.0, 1.0)),
    'too many corners': tuple((math.cos(0.006 * k), math.sin(0.006 * k))
                              for k in range(MOST_POINTS + 1)),
}  # fmt: skip


@pytest.mark.parametrize('outline', OUTLINES.values(), ids=OUTLINES.keys())
@pytest.mark.parametrize('step', [1, -1], ids=['as is', 'reversed'])
@pytest.mark.parametrize('shift', [0.0, 5e4], ids=['here', 'far'])
def test_an_outline_that_is_none_is_refused(
    outline: tuple[tuple[float, float], ...], step: int, shift: float
) -> None:
    # A power of two apart from what is not representable: lines stay lines after a shift.
    moved = tuple((x + shift, y) for x, y in outline[::step])

    with pytest.raises(BadOutline):
        Polygon(outline=moved)


@pytest.mark.parametrize(
    ('name', 'reason'),
    [
        ('on a slanted line', 'the outline encloses no area'),
        ('there and back', 'the outline encloses no area'),
        ('bow tie', 'the outline crosses or touches itself'),
        ('lopsided bow tie', 'the outline crosses or touches itself'),
        ('pentagram', 'the outline crosses or touches itself'),
    ],
)
def test_an_outline_that_crosses_itself_is_told_from_one_without_area(
    name: str, reason: str
) -> None:
    with pytest.raises(BadOutline) as refused:
        Polygon(outline=OUTLINES[name])
    assert str(refused.value) == reason


@pytest.mark.parametrize('height', [1e-4, 5e-4, 9.9e-4])
def test_a_solid_that_is_too_thin_is_a_bad_size(height: float) -> None:
    for outline in (
        ((0.0, 0.0), (1.0, 0.0), (1.0, height), (0.0, height)),
        ((0.0, 0.0), (1.0, 0.0), (0.5, height)),
        # A fat solid with a thin leg, a five-hundredth of it.
        ((0.0, 0.0), (1.0, 0.0), (1.0, height), (0.2, height), (0.2, 0.2), (0.0, 0.2)),
    ):
        with pytest.raises(BadSize):
            Polygon(outline=outline)
    with pytest.raises(BadSize):
        Triangles(vertices=((0.0, 0.0), (1.0, 0.0), (0.5, height)))


def test_a_solid_just_thick_enough_is_taken() -> None:
    height = 1.01 * SMALLEST

    for outline in (
        ((0.0, 0.0), (1.0, 0.0), (1.0, height), (0.0, height)),
        ((0.0, 0.0), (1.0, 0.0), (0.5, height)),
    ):
        assert Polygon(outline=outline).form.inner == pytest.approx(height / 2, rel=1e-9)


def test_a_sliver_is_left_out_of_the_pieces_but_weighed() -> None:
    # A box with a dent of a tenth of a millimetre beside a corner: one of its parts is thin.
    outline = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.5, 1.0 - 1e-4), (0.0, 1.0))

    form = Polygon(outline=outline).form

    assert form.area == pytest.approx(1.0 - 0.5e-4, rel=1e-9)
    assert_cover(form.pieces, form.area, share=1e-3)
    assert form.inner >= SMALLEST / 2


@pytest.mark.parametrize(
    'points', [(), ((0.0, 0.0),), ((1.0, 2.0),) * 5, ((0.0, 0.0), (1e-7, 0.0))]
)
def test_a_chain_without_two_different_points_is_refused(
    points: tuple[tuple[float, float], ...],
) -> None:
    with pytest.raises(BadOutline) as refused:
        Chain(points=points, thickness=0.1)
    assert refused.value.field == 'points'


@pytest.mark.parametrize('count', [0, 1, 2, 4, 5, 7])
def test_triangles_take_three_points_each(count: int) -> None:
    corners = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))

    with pytest.raises(BadOutline) as refused:
        Triangles(vertices=tuple(corners[k % 3] for k in range(count)))
    assert refused.value.field == 'vertices'


@pytest.mark.parametrize(
    'flat',
    [((0.0, 0.0),) * 3, ((0.0, 0.0), (1.0, 0.0), (2.0, 0.0)),
     ((0.0, 0.0), (1.0, 1.0), (1.0, 1.0)), ((0.0, 0.0), (1.0, 1.0), (3.0, 3.0))],
)  # fmt: skip
def test_a_flat_triangle_is_refused_among_others(flat: tuple[tuple[float, float], ...]) -> None:
    with pytest.raises(BadOutline):
        Triangles(vertices=((0.0, 0.0), (1.0, 0.0), (0.0, 1.0), *flat))


def test_a_compound_needs_an_element() -> None:
    with pytest.raises(BadOutline) as refused:
        Compound(element=Disc(radius=1.0), centers=())
    assert refused.value.field == 'centers'


def test_as_many_points_as_may_be_are_taken_and_one_more_is_refused() -> None:
    row = tuple((float(k), 0.0) for k in range(MOST_POINTS + 1))

    assert len(Chain(points=row[:-1], thickness=0.1).form.pieces) == MOST_POINTS - 1
    assert len(Compound(element=Disc(radius=0.1), centers=row[:-1]).form.pieces) == MOST_POINTS
    for make in (
        lambda: Chain(points=row, thickness=0.1),
        lambda: Compound(element=Disc(radius=0.1), centers=row),
        lambda: Triangles(vertices=row * 3),
    ):
        with pytest.raises(BadOutline):
            make()


# The engine takes all that was accepted


def assert_it_can_be_simulated(shape: Shape, *, haste: float = 1.0) -> None:
    """Step a shape among neighbours of its own size: falling, standing, struck, turning."""
    form = shape.form
    size = form.outer
    x, y = form.centroid
    wall = 8 * size
    bounds = (-wall, -wall, wall, wall) if wall <= LARGEST else None
    world = World(settings=WorldSettings(bounds=bounds))
    spawn(world, 'a/0', shape, (-x, -y, 0.0))
    spawn(world, 'a/1', shape, (-x, -5 * size - y, 0.4), anchored=True)
    down, left, right = -30 * size * haste, -300 * size * haste, 100 * size * haste
    spawn(world, 'a/2', shape, (-x, 2 * size - y, 1.1), velocity=(0.0, down), spin=2.0)
    spawn(world, 'a/3', shape, (4 * size - x, -y, -0.9), velocity=(left, 0.0))
    block = Box(width=2 * size, height=2 * size)
    spawn(world, 'a/4', block, (-4 * size, 0.0, 0.3), velocity=(right, 0.0))
    spawn(world, 'a/5', Disc(radius=max(size, SMALLEST)), (size, 0.0, 0.0))

    lost = world.step(60)

    snapshot = world.snapshot()
    assert lost == ()
    assert np.isfinite(snapshot.poses).all()
    assert np.isfinite(snapshot.twists).all()


@settings(deadline=None, max_examples=25)
@given(
    shape=st.one_of(
        st.floats(0.01, 100.0).map(lambda radius: Disc(radius=radius)),
        st.builds(lambda w, h: Box(width=w, height=h), st.floats(0.01, 9.0), st.floats(0.01, 9.0)),
        st.one_of(stars(), combs(), polyominoes(), drawn_boxes()).map(
            lambda points: Polygon(outline=tuple(points))
        ),
        st.lists(st.tuples(st.floats(-2.0, 2.0), st.floats(-2.0, 2.0)), min_size=3, max_size=9)
        .filter(lambda points: math.dist(points[0], points[1]) > 1e-5)
        .map(lambda points: Chain(points=tuple(points), thickness=0.1)),
    )
)
def test_what_was_accepted_can_be_simulated(shape: Shape) -> None:
    assert_it_can_be_simulated(shape, haste=0.01)


EXTREMES: dict[str, Shape] = {
    'smallest disc': Disc(radius=SMALLEST),
    'smallest box': Box(width=SMALLEST, height=SMALLEST),
    'longest needle': Box(width=100.0, height=SMALLEST),
    'thinnest polygon': Polygon(outline=((0.0, 0.0), (5.0, 0.0), (5.0, 1.01e-3), (0.0, 1.01e-3))),
    'flattest triangle': Polygon(outline=((0.0, 0.0), (9.0, 0.0), (4.0, 1.01e-3))),
    'points on a line': Chain(points=((0.0, 0.0), (1.0, 0.0), (2.0, 0.0)), thickness=SMALLEST),
    'fold': Chain(points=((0.0, 0.0), (1.0, 0.0), (0.0, 0.0)), thickness=0.1),
    'shortest chain': Chain(points=((0.0, 0.0), (1.1e-6, 0.0)), thickness=0.5),
    'one disc often': Compound(element=Disc(radius=0.2), centers=((0.0, 0.0),) * 9),
    'far from its origin': Polygon(
        outline=((9e4, 9e4), (9e4 + 1, 9e4), (9e4 + 1, 9e4 + 1), (9e4, 9e4 + 1))
    ),
    'nearly double corner': Polygon(
        outline=((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (1.1e-6, 1.0), (0.0, 1.0))
    ),
    'disc of 10 km': Disc(radius=LARGEST / 10),
}


@pytest.mark.parametrize('shape', EXTREMES.values(), ids=EXTREMES.keys())
def test_the_most_extreme_shapes_can_be_simulated(shape: Shape) -> None:
    # Not so fast that most of the time goes into sweeping needles.
    assert_it_can_be_simulated(shape, haste=0.01)


@pytest.mark.parametrize('shape', SHAPES.values(), ids=SHAPES.keys())
def test_every_kind_of_shape_can_be_simulated(shape: Shape) -> None:
    assert_it_can_be_simulated(shape, haste=0.3)


def corners_of(form_pieces: tuple[Piece, ...]) -> NDArray[np.float64]:
    return np.concatenate(
        [np.array(piece.vertices) for piece in form_pieces if isinstance(piece, Convex)]
    )


@settings(deadline=None, max_examples=40)
@given(points=st.one_of(stars(), polyominoes()))
def test_pieces_have_no_corners_but_the_outlines(points: Points) -> None:
    try:
        polygon = Polygon(outline=tuple(points))
    except BadSize:
        assume(False)

    outline = {(round(x, 9), round(y, 9)) for x, y in polygon.outline}
    pieces = {(round(x, 9), round(y, 9)) for x, y in corners_of(polygon.form.pieces).tolist()}
    assert pieces <= outline
