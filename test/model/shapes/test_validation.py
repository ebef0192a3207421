# Copyright 2026 physsim_ros maintainers
# SPDX-License-Identifier: Apache-2.0

"""Shapes that cannot be simulated are refused, and the field is named."""

import math

from physsim_ros.model.errors import BadOutline, BadSize, Malformed
from physsim_ros.model.shapes import (
    Box,
    Chain,
    Compound,
    Disc,
    LARGEST,
    MOST_POINTS,
    Polygon,
    SMALLEST,
    Triangles,
)
import pytest

from .polygons import assert_cover
from ...building import refusal

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
def test_a_length_out_of_range_is_refused_and_named(value, error):
    segment = ((0.0, 0.0), (1.0, 0.0))
    for field, make in (
        ('radius', lambda: Disc(radius=value)),
        ('width', lambda: Box(width=value, height=1.0)),
        ('height', lambda: Box(width=1.0, height=value)),
        ('thickness', lambda: Chain(points=segment, thickness=value)),
    ):
        assert refusal(make) == (error, field)


@pytest.mark.parametrize('length', [SMALLEST, 1.0, LARGEST])
def test_a_length_at_the_end_of_its_range_is_taken(length):
    assert Disc(radius=length).form.inner == length
    assert Box(width=length, height=length).form.inner == length / 2


FAR = math.nextafter(LARGEST, math.inf)


@pytest.mark.parametrize('kind', [Polygon, Chain, Triangles, Compound])
@pytest.mark.parametrize(
    ('points', 'error'),
    [*((((0.0, 0.0), (1.0, value), (0.0, 1.0)), Malformed)
       for value in (math.nan, math.inf, -math.inf)),
     (((0.0, 0.0), (FAR, 0.0), (0.0, 1.0)), BadSize),
     (((0.0, 0.0), (0.0, -FAR), (1.0, 1.0)), BadSize),
     (((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0)), Malformed),
     (((0.0,), (1.0,)), Malformed),
     ((0.0, 1.0, 2.0, 3.0), Malformed), ((('a', 'b'), ('c', 'd'), ('e', 'f')), Malformed),
     (((None, 0.0),) * 3, Malformed), (7, Malformed)],
)  # fmt: skip
def test_points_are_pairs_of_finite_numbers_that_are_not_too_large(kind, points, error):
    others = {Chain: {'thickness': 0.1}, Compound: {'element': Disc(radius=1.0)}}.get(kind, {})
    named = {Polygon: 'outline', Triangles: 'vertices', Compound: 'centers'}.get(kind, 'points')
    assert refusal(kind, **{named: points}, **others) == (error, named)


OUTLINES = {
    'no point': (),
    'one point': ((0.0, 0.0),),
    'two points': ((0.0, 0.0), (1.0, 0.0)),
    'one point thrice': ((1.0, 1.0),) * 3,
    'two points twice': ((0.0, 0.0), (0.0, 0.0), (1.0, 0.0), (1.0, 0.0)),
    'on a line': ((0.0, 0.0), (1.0, 1.0), (2.0, 2.0)),
    'on a slanted line': ((0.0, 0.0), (0.1, 0.3), (0.2, 0.6), (0.7, 2.1)),
    'there and back': ((0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (1.0, 0.0)),
    'micrometres wide': ((0.0, 0.0), (1e-5, 1.9e-5), (2e-5, 0.0), (1e-5, 2e-5)),
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
def test_an_outline_that_is_none_is_refused(outline, step, shift):
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
        ('micrometres wide', 'the outline cannot be split into convex parts'),
    ],
)
def test_the_refusal_of_an_outline_has_the_reason(name, reason):
    with pytest.raises(BadOutline) as refused:
        Polygon(outline=OUTLINES[name])
    assert str(refused.value) == reason


@pytest.mark.parametrize('height', [1e-4, 5e-4, 9.9e-4])
def test_a_solid_that_is_too_thin_is_a_bad_size(height):
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


def test_a_solid_just_thick_enough_is_taken():
    height = 1.01 * SMALLEST

    for outline in (
        ((0.0, 0.0), (1.0, 0.0), (1.0, height), (0.0, height)),
        ((0.0, 0.0), (1.0, 0.0), (0.5, height)),
    ):
        assert Polygon(outline=outline).form.inner == pytest.approx(height / 2, rel=1e-9)


def test_a_sliver_is_left_out_of_the_pieces_but_weighed():
    # A box with a dent of a tenth of a millimetre beside a corner: one of its parts is thin.
    outline = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.5, 1.0 - 1e-4), (0.0, 1.0))

    form = Polygon(outline=outline).form

    assert form.area == pytest.approx(1.0 - 0.5e-4, rel=1e-9)
    assert_cover(form.pieces, form.area, share=1e-3)
    assert form.inner >= SMALLEST / 2


@pytest.mark.parametrize(
    'points', [(), ((0.0, 0.0),), ((1.0, 2.0),) * 5, ((0.0, 0.0), (1e-7, 0.0))]
)
def test_a_chain_without_two_different_points_is_refused(points):
    assert refusal(Chain, points=points, thickness=0.1) == (BadOutline, 'points')


@pytest.mark.parametrize('count', [0, 1, 2, 4, 5, 7])
def test_triangles_take_three_points_each(count):
    corners = ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))

    with pytest.raises(BadOutline) as refused:
        Triangles(vertices=tuple(corners[k % 3] for k in range(count)))
    assert refused.value.field == 'vertices'


@pytest.mark.parametrize(
    'flat',
    [((0.0, 0.0),) * 3, ((0.0, 0.0), (1.0, 0.0), (2.0, 0.0)),
     ((0.0, 0.0), (1.0, 1.0), (1.0, 1.0)), ((0.0, 0.0), (1.0, 1.0), (3.0, 3.0))],
)  # fmt: skip
def test_a_flat_triangle_is_refused_among_others(flat):
    with pytest.raises(BadOutline):
        Triangles(vertices=((0.0, 0.0), (1.0, 0.0), (0.0, 1.0), *flat))


def test_a_compound_needs_an_element():
    assert refusal(Compound, element=Disc(radius=1.0), centers=()) == (BadOutline, 'centers')


def test_as_many_points_as_may_be_are_taken_and_one_more_is_refused():
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
